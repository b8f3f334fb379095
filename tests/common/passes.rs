//! Pictures and depths drawn in passes of the caller's: in a render pass, as engines without dynamic rendering have it, or
//! without one.

use ash::vk;
use ash_subdiv::gpu::MemoryLocation;
use ash_subdiv::headless::Headless;
use ash_subdiv::headless::objects::{Buffer, BufferDesc, Image, ImageDesc};
use ash_subdiv::renderer::Target;

const COLOR: vk::Format = vk::Format::R8G8B8A8_SRGB;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
const ONE: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_1;

/// An image for depths, and as many for colours as are asked for.
pub struct PassTarget<'h> {
    headless: &'h Headless,
    colors: Vec<Image>,
    depth: Image,
    /// None with dynamic rendering.
    objects: Option<(vk::RenderPass, vk::Framebuffer)>,
    extent: vk::Extent2D,
}

impl<'h> PassTarget<'h> {
    /// With a render pass, and one image for colours.
    pub fn new(headless: &'h Headless, extent: vk::Extent2D) -> Self {
        Self::with(headless, extent, 1, false)
    }

    pub fn with(headless: &'h Headless, extent: vk::Extent2D, colors: usize, dynamic: bool) -> Self {
        use vk::ImageUsageFlags as Usage;
        let image = |name, format, usage| {
            let desc = ImageDesc::new(name, extent, format, usage | Usage::TRANSFER_SRC);
            Image::new(headless.context(), &desc).expect("an image")
        };
        let colors: Vec<_> = (0..colors).map(|_| image("pass colour", COLOR, Usage::COLOR_ATTACHMENT)).collect();
        let depth = image("pass depth", DEPTH, Usage::DEPTH_STENCIL_ATTACHMENT);
        let objects = (!dynamic).then(|| objects(headless, &colors, &depth, extent));
        Self { headless, colors, depth, objects, extent }
    }

    /// What a renderer, or a style, has to be made for.
    pub fn target(&self) -> Target {
        use ash_subdiv::renderer::Pass;
        let (color_attachments, color) = (self.colors.len() as u32, vec![COLOR; self.colors.len()]);
        match self.objects {
            Some((render_pass, _)) => {
                let pass = Pass::RenderPass { render_pass, subpass: 0, color_attachments };
                Target { pass, ..Target::render_pass(render_pass, 0, ONE) }
            }
            None if color.is_empty() => Target::depth_only(DEPTH, ONE),
            None => {
                let mut target = Target::dynamic(COLOR, DEPTH, ONE);
                if let Pass::Dynamic { color: formats, .. } = &mut target.pass {
                    *formats = color;
                }
                target
            }
        }
    }

    /// Draws with `prepare` before the pass and `record` in it, and gives the pixels.
    pub fn draw(
        &self,
        clear: [f32; 4],
        record: impl FnMut(vk::CommandBuffer, Moment) -> Result<(), ash_subdiv::Error>,
    ) -> Vec<u8> {
        self.draw_all(&[clear], record).0.remove(0)
    }

    /// As [`PassTarget::draw`], with a clear for each image for colours (more are left): the pixels of each, and the depths.
    pub fn draw_all(
        &self,
        clears: &[[f32; 4]],
        mut record: impl FnMut(vk::CommandBuffer, Moment) -> Result<(), ash_subdiv::Error>,
    ) -> (Vec<Vec<u8>>, Vec<f32>) {
        let device = self.headless.device();
        let pixels = u64::from(self.extent.width) * u64::from(self.extent.height);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let desc = BufferDesc { name: "pass pixels", size: 4 * pixels, usage, location: MemoryLocation::Readback };
        let images: Vec<_> = self.colors.iter().chain([&self.depth]).collect();
        let new_buffer = |_: &&Image| Buffer::new(self.headless.context(), &desc).expect("a buffer");
        let buffers: Vec<_> = images.iter().map(new_buffer).collect();
        let [width, height] = [self.extent.width, self.extent.height].map(|side| side as f32);
        let viewport = vk::Viewport { x: 0.0, y: 0.0, width, height, min_depth: 0.0, max_depth: 1.0 };
        // SAFETY: the command buffer is being recorded; the pass is begun and ended in it.
        let recorded = self.headless.try_submit(|cmd| unsafe {
            record(cmd, Moment::Before)?;
            self.cmd_begin(cmd, clears);
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[self.area()]);
            record(cmd, Moment::Inside)?;
            self.cmd_end(cmd);
            for (image, buffer) in images.iter().zip(&buffers) {
                let aspect = image.whole().aspect_mask;
                let layers = vk::ImageSubresourceLayers::default().aspect_mask(aspect).layer_count(1);
                let copy = vk::BufferImageCopy::default().image_subresource(layers).image_extent(self.extent.into());
                let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
                device.cmd_copy_image_to_buffer(cmd, image.raw(), layout, buffer.raw(), &[copy]);
            }
            Ok::<(), ash_subdiv::Error>(())
        });
        recorded.expect("a picture");
        let (depth, colors) = buffers.split_last().expect("the depths");
        let colors = colors.iter().map(|buffer| buffer.read(0, 4 * pixels as usize).expect("pixels"));
        (colors.collect(), depth.read(0, pixels as usize).expect("depths"))
    }

    fn area(&self) -> vk::Rect2D {
        vk::Rect2D { offset: vk::Offset2D::default(), extent: self.extent }
    }

    unsafe fn cmd_begin(&self, cmd: vk::CommandBuffer, clears: &[[f32; 4]]) {
        let device = self.headless.device();
        let color = |&float32| vk::ClearValue { color: vk::ClearColorValue { float32 } };
        let far = vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 1.0, stencil: 0 } };
        let clears: Vec<_> = clears.iter().take(self.colors.len()).map(color).chain([far]).collect();
        if let Some((render_pass, framebuffer)) = self.objects {
            let begin = vk::RenderPassBeginInfo::default()
                .render_pass(render_pass)
                .framebuffer(framebuffer)
                .render_area(self.area())
                .clear_values(&clears);
            // SAFETY: the command buffer is being recorded.
            return unsafe { device.cmd_begin_render_pass(cmd, &begin, vk::SubpassContents::INLINE) };
        }
        let attachment = |(image, &clear): (&Image, &vk::ClearValue)| {
            vk::RenderingAttachmentInfo::default()
                .image_view(image.view())
                .image_layout(vk::ImageLayout::GENERAL)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(clear)
        };
        let attachments: Vec<_> = self.colors.iter().chain([&self.depth]).zip(&clears).map(attachment).collect();
        let (depth, colors) = attachments.split_last().expect("the depths");
        let info = vk::RenderingInfo::default()
            .render_area(self.area())
            .layer_count(1)
            .color_attachments(colors)
            .depth_attachment(depth);
        // SAFETY: as above.
        unsafe {
            self.cmd_barriers(cmd, vk::ImageLayout::UNDEFINED, vk::ImageLayout::GENERAL);
            device.cmd_begin_rendering(cmd, &info);
        }
    }

    unsafe fn cmd_end(&self, cmd: vk::CommandBuffer) {
        let device = self.headless.device();
        // SAFETY: the pass is open in the command buffer.
        unsafe {
            if self.objects.is_some() {
                return device.cmd_end_render_pass(cmd);
            }
            device.cmd_end_rendering(cmd);
            self.cmd_barriers(cmd, vk::ImageLayout::GENERAL, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
        }
    }

    /// Has everything wait for everything, which is no matter here.
    unsafe fn cmd_barriers(&self, cmd: vk::CommandBuffer, from: vk::ImageLayout, to: vk::ImageLayout) {
        use vk::{AccessFlags2 as Access, PipelineStageFlags2 as Stage};
        let barrier = |image: &Image| {
            image
                .barrier(from, to)
                .src_stage_mask(Stage::ALL_COMMANDS)
                .src_access_mask(Access::MEMORY_WRITE)
                .dst_stage_mask(Stage::ALL_COMMANDS)
                .dst_access_mask(Access::MEMORY_READ | Access::MEMORY_WRITE)
        };
        let barriers: Vec<_> = self.colors.iter().chain([&self.depth]).map(barrier).collect();
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: the command buffer is being recorded, outside rendering.
        unsafe { self.headless.device().cmd_pipeline_barrier2(cmd, &info) };
    }
}

/// A render pass that leaves its images to be copied from, and a framebuffer with them.
fn objects(
    headless: &Headless,
    colors: &[Image],
    depth: &Image,
    extent: vk::Extent2D,
) -> (vk::RenderPass, vk::Framebuffer) {
    use vk::{AccessFlags as Access, ImageLayout as Layout, PipelineStageFlags as Stage};
    let device = headless.device();
    let attachment = |image: &Image| {
        vk::AttachmentDescription::default()
            .format(image.format())
            .samples(ONE)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .final_layout(Layout::TRANSFER_SRC_OPTIMAL)
    };
    let attachments: Vec<_> = colors.iter().chain([depth]).map(attachment).collect();
    let reference = |(number, layout)| vk::AttachmentReference { attachment: number, layout };
    let color_references: Vec<_> =
        (0..colors.len() as u32).map(|number| reference((number, Layout::COLOR_ATTACHMENT_OPTIMAL))).collect();
    let depth_reference = reference((colors.len() as u32, Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL));
    let subpasses = [vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&color_references)
        .depth_stencil_attachment(&depth_reference)];
    let dependencies = [vk::SubpassDependency::default()
        .src_subpass(0)
        .dst_subpass(vk::SUBPASS_EXTERNAL)
        .src_stage_mask(Stage::COLOR_ATTACHMENT_OUTPUT | Stage::LATE_FRAGMENT_TESTS)
        .src_access_mask(Access::COLOR_ATTACHMENT_WRITE | Access::DEPTH_STENCIL_ATTACHMENT_WRITE)
        .dst_stage_mask(Stage::TRANSFER)
        .dst_access_mask(Access::TRANSFER_READ)];
    let info =
        vk::RenderPassCreateInfo::default().attachments(&attachments).subpasses(&subpasses).dependencies(&dependencies);
    let views: Vec<_> = colors.iter().chain([depth]).map(Image::view).collect();
    // SAFETY: the handles are of this device and destroyed in `drop`, when it is idle.
    unsafe {
        let render_pass = device.create_render_pass(&info, None).expect("a render pass");
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(render_pass)
            .attachments(&views)
            .width(extent.width)
            .height(extent.height)
            .layers(1);
        (render_pass, device.create_framebuffer(&info, None).expect("a framebuffer"))
    }
}

/// When something is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moment {
    Before,
    Inside,
}

impl Drop for PassTarget<'_> {
    fn drop(&mut self) {
        let Some((render_pass, framebuffer)) = self.objects else { return };
        // SAFETY: every submission was waited for.
        unsafe {
            self.headless.device().destroy_framebuffer(framebuffer, None);
            self.headless.device().destroy_render_pass(render_pass, None);
        }
    }
}
