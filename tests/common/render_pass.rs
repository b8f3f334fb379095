//! A picture drawn in a render pass of the caller's, as engines without dynamic rendering have it.

use ash::vk;
use ash_subdiv::gpu::{Buffer, BufferDesc, Image, ImageDesc, MemoryLocation};
use ash_subdiv::headless::Headless;
use ash_subdiv::renderer::Target;

pub struct RenderPassTarget<'h> {
    headless: &'h Headless,
    color: Image,
    // Only kept.
    _depth: Image,
    render_pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
    extent: vk::Extent2D,
}

impl<'h> RenderPassTarget<'h> {
    pub fn new(headless: &'h Headless, extent: vk::Extent2D) -> Self {
        use vk::{AccessFlags as Access, ImageLayout as Layout, PipelineStageFlags as Stage};
        let (context, device) = (headless.context(), headless.device());
        let [color_format, depth_format] = [vk::Format::R8G8B8A8_SRGB, vk::Format::D32_SFLOAT];
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        let color = Image::new(context, &ImageDesc::new("pass colour", extent, color_format, usage)).expect("an image");
        let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        let depth = Image::new(context, &ImageDesc::new("pass depth", extent, depth_format, usage)).expect("an image");
        let attachment = |format, last| {
            vk::AttachmentDescription::default()
                .format(format)
                .samples(vk::SampleCountFlags::TYPE_1)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .final_layout(last)
        };
        let attachments = [
            attachment(color_format, Layout::TRANSFER_SRC_OPTIMAL),
            attachment(depth_format, Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL),
        ];
        let color_reference = [vk::AttachmentReference { attachment: 0, layout: Layout::COLOR_ATTACHMENT_OPTIMAL }];
        let depth_reference =
            vk::AttachmentReference { attachment: 1, layout: Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL };
        let subpasses = [vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&color_reference)
            .depth_stencil_attachment(&depth_reference)];
        let dependencies = [vk::SubpassDependency::default()
            .src_subpass(0)
            .dst_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(Stage::COLOR_ATTACHMENT_OUTPUT)
            .src_access_mask(Access::COLOR_ATTACHMENT_WRITE)
            .dst_stage_mask(Stage::TRANSFER)
            .dst_access_mask(Access::TRANSFER_READ)];
        let info = vk::RenderPassCreateInfo::default()
            .attachments(&attachments)
            .subpasses(&subpasses)
            .dependencies(&dependencies);
        let views = [color.view(), depth.view()];
        // SAFETY: the handles are of this device and destroyed in `drop`, when it is idle.
        unsafe {
            let render_pass = device.create_render_pass(&info, None).expect("a render pass");
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(render_pass)
                .attachments(&views)
                .width(extent.width)
                .height(extent.height)
                .layers(1);
            let framebuffer = device.create_framebuffer(&info, None).expect("a framebuffer");
            Self { headless, color, _depth: depth, render_pass, framebuffer, extent }
        }
    }

    /// What a renderer has to be made for.
    pub fn target(&self) -> Target {
        Target::render_pass(self.render_pass, 0, vk::SampleCountFlags::TYPE_1)
    }

    /// Draws with `prepare` before the pass and `record` in it, and gives the pixels.
    pub fn draw(
        &self,
        clear: [f32; 4],
        mut record: impl FnMut(vk::CommandBuffer, Moment) -> Result<(), ash_subdiv::Error>,
    ) -> Vec<u8> {
        let device = self.headless.device();
        let size = 4 * u64::from(self.extent.width) * u64::from(self.extent.height);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let desc = BufferDesc { name: "pass pixels", size, usage, location: MemoryLocation::Readback };
        let pixels = Buffer::new(self.headless.context(), &desc).expect("a buffer");
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: self.extent };
        let clears = [
            vk::ClearValue { color: vk::ClearColorValue { float32: clear } },
            vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 1.0, stencil: 0 } },
        ];
        let begin = vk::RenderPassBeginInfo::default()
            .render_pass(self.render_pass)
            .framebuffer(self.framebuffer)
            .render_area(area)
            .clear_values(&clears);
        let [width, height] = [self.extent.width, self.extent.height].map(|side| side as f32);
        let viewport = vk::Viewport { x: 0.0, y: 0.0, width, height, min_depth: 0.0, max_depth: 1.0 };
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
        let copy = vk::BufferImageCopy::default().image_subresource(layers).image_extent(self.extent.into());
        // SAFETY: the command buffer is being recorded; the pass is begun and ended in it.
        let recorded = self.headless.try_submit(|cmd| unsafe {
            record(cmd, Moment::Before)?;
            device.cmd_begin_render_pass(cmd, &begin, vk::SubpassContents::INLINE);
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[area]);
            record(cmd, Moment::Inside)?;
            device.cmd_end_render_pass(cmd);
            let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            device.cmd_copy_image_to_buffer(cmd, self.color.raw(), layout, pixels.raw(), &[copy]);
            Ok::<(), ash_subdiv::Error>(())
        });
        recorded.expect("a picture");
        pixels.read(0, size as usize).expect("pixels")
    }
}

/// When something is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moment {
    Before,
    Inside,
}

impl Drop for RenderPassTarget<'_> {
    fn drop(&mut self) {
        // SAFETY: every submission was waited for.
        unsafe {
            self.headless.device().destroy_framebuffer(self.framebuffer, None);
            self.headless.device().destroy_render_pass(self.render_pass, None);
        }
    }
}
