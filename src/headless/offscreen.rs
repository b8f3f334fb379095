//! An image to draw into, and to read back.

use ash::vk;

use super::Headless;
#[cfg(feature = "png")]
use super::HeadlessError;
use crate::gpu::{Buffer, BufferDesc, GpuError, Image, ImageDesc, MemoryLocation, RenderTarget};

/// Description of an [`Offscreen`].
#[derive(Debug, Clone, Copy)]
pub struct OffscreenDesc {
    /// Pixels.
    pub extent: vk::Extent2D,
    /// Samples a pixel; resolved to one when drawing ends.
    pub samples: vk::SampleCountFlags,
    /// Colour format of four bytes a pixel: `R8G8B8A8_SRGB` or `R8G8B8A8_UNORM`.
    pub color: vk::Format,
    /// The format of the depth image.
    pub depth: vk::Format,
}

impl OffscreenDesc {
    /// One sample, `R8G8B8A8_SRGB` and `D32_SFLOAT`.
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            extent: vk::Extent2D { width, height },
            samples: vk::SampleCountFlags::TYPE_1,
            color: vk::Format::R8G8B8A8_SRGB,
            depth: vk::Format::D32_SFLOAT,
        }
    }
}

/// Colour and depth images to draw into, and a buffer that takes the pixels back.
pub struct Offscreen {
    desc: OffscreenDesc,
    color: Image,
    /// Image that is drawn into if there are several samples.
    multisampled: Option<Image>,
    depth: Image,
    pixels: Buffer,
    device: ash::Device,
}

impl Offscreen {
    /// Makes the images and the buffer.
    ///
    /// # Errors
    /// Colour formats of other than four bytes, sizes and sample counts the device does not have, no memory.
    pub fn new(headless: &Headless, desc: &OffscreenDesc) -> Result<Self, GpuError> {
        use vk::ImageUsageFlags as Usage;
        let context = headless.context();
        let OffscreenDesc { extent, samples, color: format, depth } = *desc;
        if ![vk::Format::R8G8B8A8_SRGB, vk::Format::R8G8B8A8_UNORM].contains(&format) {
            let why = format!("{format:?}: offscreen colour is R8G8B8A8_SRGB or R8G8B8A8_UNORM");
            return Err(GpuError::Unsupported { object: "offscreen colour".into(), why });
        }
        let image = |name, format, usage, samples| {
            Image::new(context, &ImageDesc { samples, ..ImageDesc::new(name, extent, format, usage) })
        };
        let one = vk::SampleCountFlags::TYPE_1;
        let color = image("offscreen colour", format, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC, one)?;
        let multisampled = (samples != one)
            .then(|| image("offscreen samples", format, Usage::COLOR_ATTACHMENT, samples))
            .transpose()?;
        let depth = image("offscreen depth", depth, Usage::DEPTH_STENCIL_ATTACHMENT, samples)?;
        let pixels = Buffer::new(
            context,
            &BufferDesc {
                name: "offscreen pixels",
                size: 4 * u64::from(extent.width) * u64::from(extent.height),
                usage: vk::BufferUsageFlags::TRANSFER_DST,
                location: MemoryLocation::Readback,
            },
        )?;
        Ok(Self { desc: *desc, color, multisampled, depth, pixels, device: context.device().clone() })
    }

    /// Description it was made from.
    pub fn desc(&self) -> &OffscreenDesc {
        &self.desc
    }

    /// Pixels.
    pub fn extent(&self) -> vk::Extent2D {
        self.desc.extent
    }

    /// Target of pipelines that draw here; their sample count is [`OffscreenDesc::samples`].
    pub fn target(&self) -> RenderTarget<'_> {
        RenderTarget::Dynamic {
            color: std::slice::from_ref(&self.desc.color),
            depth: self.desc.depth,
            stencil: vk::Format::UNDEFINED,
        }
    }

    /// Barriers after which the attachments are drawn into: what an earlier frame left is discarded, after its last use.
    fn discarding_barriers(&self) -> Vec<vk::ImageMemoryBarrier2<'static>> {
        use vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};
        let color_stage = Stage::COLOR_ATTACHMENT_OUTPUT;
        let depth_stage = Stage::EARLY_FRAGMENT_TESTS | Stage::LATE_FRAGMENT_TESTS;
        let color_barrier = |image: &Image, before: Stage| {
            image
                .barrier(Layout::UNDEFINED, Layout::COLOR_ATTACHMENT_OPTIMAL)
                .src_stage_mask(before)
                .src_access_mask(Access::COLOR_ATTACHMENT_WRITE)
                .dst_stage_mask(color_stage)
                .dst_access_mask(Access::COLOR_ATTACHMENT_WRITE | Access::COLOR_ATTACHMENT_READ)
        };
        let mut barriers = vec![
            color_barrier(&self.color, color_stage | Stage::COPY),
            self.depth
                .barrier(Layout::UNDEFINED, Layout::DEPTH_ATTACHMENT_OPTIMAL)
                .src_stage_mask(depth_stage)
                .src_access_mask(Access::DEPTH_STENCIL_ATTACHMENT_WRITE)
                .dst_stage_mask(depth_stage)
                .dst_access_mask(Access::DEPTH_STENCIL_ATTACHMENT_WRITE | Access::DEPTH_STENCIL_ATTACHMENT_READ),
        ];
        barriers.extend(self.multisampled.as_ref().map(|image| color_barrier(image, color_stage)));
        barriers
    }

    /// Begins rendering to the whole image, cleared to `clear` and depth 1, with viewport and scissor set.
    ///
    /// # Safety
    ///
    /// `cmd` is a command buffer of this device that is being recorded, outside rendering.
    pub unsafe fn cmd_begin(&self, cmd: vk::CommandBuffer, clear: [f32; 4]) {
        use vk::ImageLayout as Layout;
        let barriers = self.discarding_barriers();
        let drawn = self.multisampled.as_ref().unwrap_or(&self.color);
        let mut color = vk::RenderingAttachmentInfo::default()
            .image_view(drawn.view())
            .image_layout(Layout::COLOR_ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(vk::ClearValue { color: vk::ClearColorValue { float32: clear } });
        if self.multisampled.is_some() {
            color = color
                .store_op(vk::AttachmentStoreOp::DONT_CARE)
                .resolve_mode(vk::ResolveModeFlags::AVERAGE)
                .resolve_image_view(self.color.view())
                .resolve_image_layout(Layout::COLOR_ATTACHMENT_OPTIMAL);
        }
        let depth = vk::RenderingAttachmentInfo::default()
            .image_view(self.depth.view())
            .image_layout(Layout::DEPTH_ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::DONT_CARE)
            .clear_value(vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 1.0, stencil: 0 } });
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: self.extent() };
        let colors = [color];
        let rendering = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colors)
            .depth_attachment(&depth);
        let viewport = vk::Viewport {
            x: 0.0,
            y: 0.0,
            width: area.extent.width as f32,
            height: area.extent.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: as the caller promises.
        unsafe {
            self.device.cmd_pipeline_barrier2(cmd, &vk::DependencyInfo::default().image_memory_barriers(&barriers));
            self.device.cmd_begin_rendering(cmd, &rendering);
            self.device.cmd_set_viewport(cmd, 0, &[viewport]);
            self.device.cmd_set_scissor(cmd, 0, &[area]);
        }
    }

    /// Ends rendering, and resolves the samples.
    ///
    /// # Safety
    ///
    /// Rendering was begun in `cmd` by [`Offscreen::cmd_begin`].
    pub unsafe fn cmd_end(&self, cmd: vk::CommandBuffer) {
        // SAFETY: as the caller promises.
        unsafe { self.device.cmd_end_rendering(cmd) };
    }

    /// Copies the pixels to where [`Offscreen::pixels`] finds them.
    ///
    /// # Safety
    ///
    /// `cmd` is being recorded, outside rendering, after [`Offscreen::cmd_end`] in it or in an earlier command buffer.
    pub unsafe fn cmd_read_back(&self, cmd: vk::CommandBuffer) {
        use vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};
        let to_source = [self
            .color
            .barrier(Layout::COLOR_ATTACHMENT_OPTIMAL, Layout::TRANSFER_SRC_OPTIMAL)
            .src_stage_mask(Stage::COLOR_ATTACHMENT_OUTPUT)
            .src_access_mask(Access::COLOR_ATTACHMENT_WRITE)
            .dst_stage_mask(Stage::COPY)
            .dst_access_mask(Access::TRANSFER_READ)];
        // So that the pixels can be read back again without drawing.
        let back = [self
            .color
            .barrier(Layout::TRANSFER_SRC_OPTIMAL, Layout::COLOR_ATTACHMENT_OPTIMAL)
            .src_stage_mask(Stage::COPY)
            .dst_stage_mask(Stage::COLOR_ATTACHMENT_OUTPUT)
            .dst_access_mask(Access::COLOR_ATTACHMENT_WRITE | Access::COLOR_ATTACHMENT_READ)];
        let written = [vk::MemoryBarrier2::default()
            .src_stage_mask(Stage::COPY)
            .src_access_mask(Access::TRANSFER_WRITE)
            .dst_stage_mask(Stage::COPY | Stage::HOST)
            .dst_access_mask(Access::TRANSFER_WRITE | Access::HOST_READ)];
        let region = vk::BufferImageCopy::default()
            .image_subresource(
                vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1),
            )
            .image_extent(self.extent().into());
        let (image, buffer) = (self.color.raw(), self.pixels.raw());
        let dependency = vk::DependencyInfo::default();
        // SAFETY: as the caller promises.
        unsafe {
            self.device.cmd_pipeline_barrier2(cmd, &dependency.image_memory_barriers(&to_source));
            self.device.cmd_copy_image_to_buffer(cmd, image, Layout::TRANSFER_SRC_OPTIMAL, buffer, &[region]);
            self.device.cmd_pipeline_barrier2(cmd, &dependency.image_memory_barriers(&back).memory_barriers(&written));
        }
    }

    /// The pixels that were read back: rows from the top, four bytes RGBA a pixel, encoded as the format says.
    pub fn pixels(&self) -> Result<Vec<u8>, GpuError> {
        self.pixels.read(0, 4 * self.extent().width as usize * self.extent().height as usize)
    }

    /// Draws with `record`, inside rendering, and returns the pixels.
    pub fn draw<E: From<GpuError>>(
        &self,
        headless: &Headless,
        clear: [f32; 4],
        record: impl FnOnce(vk::CommandBuffer) -> Result<(), E>,
    ) -> Result<Vec<u8>, E> {
        // SAFETY: the command buffer is being recorded, and rendering is begun and ended in it.
        headless.try_submit(|cmd| unsafe {
            self.cmd_begin(cmd, clear);
            record(cmd)?;
            self.cmd_end(cmd);
            self.cmd_read_back(cmd);
            Ok::<(), E>(())
        })?;
        Ok(self.pixels()?)
    }

    /// Writes the pixels that were read back to a PNG file.
    #[cfg(feature = "png")]
    pub fn save_png(&self, path: impl AsRef<std::path::Path>) -> Result<(), HeadlessError> {
        save_png(path, self.extent(), &self.pixels()?)
    }
}

/// Writes pixels (rows from the top, four bytes RGBA) to a PNG file; makes the folders it needs.
#[cfg(feature = "png")]
pub fn save_png(path: impl AsRef<std::path::Path>, extent: vk::Extent2D, rgba: &[u8]) -> Result<(), HeadlessError> {
    let path = path.as_ref();
    let error = |message: String| HeadlessError::Picture { path: path.to_owned(), message };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|e| error(e.to_string()))?;
    }
    if rgba.len() != 4 * extent.width as usize * extent.height as usize {
        return Err(error(format!("{} bytes are no {} x {} pixels", rgba.len(), extent.width, extent.height)));
    }
    let format = image::ImageFormat::Png;
    image::save_buffer_with_format(path, rgba, extent.width, extent.height, image::ColorType::Rgba8, format)
        .map_err(|e| error(e.to_string()))
}
