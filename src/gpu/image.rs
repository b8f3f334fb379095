use std::mem::ManuallyDrop;
use std::sync::Arc;

use ash::vk;

use super::buffer::wants_dedicated;
use super::{Allocation, AllocationRequest, Dedicated, DeviceContext, GpuError, MemoryLocation, Owned, VkResultExt};

/// Description of an [`Image`]: two-dimensional, with optimal tiling, in device memory.
#[derive(Debug, Clone, Copy)]
pub struct ImageDesc<'a> {
    /// The debug name.
    pub name: &'a str,
    /// Pixels.
    pub extent: vk::Extent2D,
    /// Format of a colour, depth or stencil image.
    pub format: vk::Format,
    /// Uses of the image.
    pub usage: vk::ImageUsageFlags,
    /// Samples a pixel.
    pub samples: vk::SampleCountFlags,
    /// Levels, the whole image included.
    pub mip_levels: u32,
}

impl<'a> ImageDesc<'a> {
    /// One sample and one level.
    pub fn new(name: &'a str, extent: vk::Extent2D, format: vk::Format, usage: vk::ImageUsageFlags) -> Self {
        Self { name, extent, format, usage, samples: vk::SampleCountFlags::TYPE_1, mip_levels: 1 }
    }

    /// Checks that the device has such images.
    fn check(&self, context: &DeviceContext) -> Result<(), GpuError> {
        let ImageDesc { name, extent, format, usage, samples, mip_levels } = *self;
        let properties = context.properties();
        let unsupported = |why: String| Err(GpuError::Unsupported { object: name.to_owned(), why });
        let (width, height, max) = (extent.width, extent.height, properties.max_image_size);
        if width == 0 || height == 0 || width > max || height > max {
            return unsupported(format!(
                "{width} x {height} pixels: the device has images of 1 to {max} pixels a side"
            ));
        }
        let most = width.max(height).ilog2() + 1;
        if !(1..=most).contains(&mip_levels) {
            return unsupported(format!("{mip_levels} mip levels: {width} x {height} pixels have 1 to {most}"));
        }
        use vk::ImageUsageFlags as Usage;
        let attached = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT | Usage::INPUT_ATTACHMENT;
        if !usage.intersects(attached | Usage::SAMPLED | Usage::STORAGE) {
            return unsupported("it is for no use of a view: to be sampled, stored to or attached".into());
        }
        if usage.contains(Usage::TRANSIENT_ATTACHMENT) && !(attached | Usage::TRANSIENT_ATTACHMENT).contains(usage) {
            return unsupported("a transient attachment can be attached only".into());
        }
        if samples.as_raw().count_ones() != 1 {
            return unsupported(format!("samples are {samples:?}: give one number, such as TYPE_1"));
        }
        if samples != vk::SampleCountFlags::TYPE_1 && mip_levels > 1 {
            return unsupported(format!("{mip_levels} mip levels with several samples a pixel: one is possible"));
        }
        if !properties.sample_counts.contains(samples) {
            let (asked, known) = (samples.as_raw(), properties.sample_counts());
            return unsupported(format!("{asked} samples a pixel: {} has {known:?}", properties.name));
        }
        let fits = |known: vk::ImageFormatProperties| {
            known.max_mip_levels >= mip_levels
                && known.sample_counts.contains(samples)
                && known.max_extent.width >= width
                && known.max_extent.height >= height
        };
        if !context.images(format, usage).is_some_and(fits) {
            let (name, count) = (&properties.name, samples.as_raw());
            return unsupported(format!(
                "{name} has no such images of the format {format:?} for {usage:?}: {width} x {height} pixels, {count} samples, {mip_levels} mip levels"
            ));
        }
        Ok(())
    }
}

/// An image with its memory and a view of all of it; they go when it is dropped.
#[derive(Debug)]
pub struct Image {
    name: String,
    extent: vk::Extent2D,
    format: vk::Format,
    samples: vk::SampleCountFlags,
    mip_levels: u32,
    context: Arc<DeviceContext>,
    // Dropped in this order: the view, the image, the memory.
    view: Option<Owned<vk::ImageView>>,
    raw: ManuallyDrop<Owned<vk::Image>>,
    allocation: ManuallyDrop<Allocation>,
}

impl Image {
    /// A new image, with memory, in the layout `UNDEFINED`.
    ///
    /// # Errors
    /// No memory; a size, sample count, number of mip levels, format or use the device does not have.
    pub fn new(context: &Arc<DeviceContext>, desc: &ImageDesc<'_>) -> Result<Self, GpuError> {
        desc.check(context)?;
        let ImageDesc { name, extent, format, usage, samples, mip_levels } = *desc;
        let device = context.device();
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(extent.into())
            .mip_levels(mip_levels)
            .array_layers(1)
            .samples(samples)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage)
            .initial_layout(vk::ImageLayout::UNDEFINED);
        // SAFETY: the device has such images, and the image is taken over by `Owned`.
        let raw = unsafe {
            let raw = device.create_image(&info, None).of("vkCreateImage", name)?;
            Owned::new(context, raw, name)
        };
        let mut dedicated = vk::MemoryDedicatedRequirements::default();
        let mut requirements = vk::MemoryRequirements2::default().push_next(&mut dedicated);
        let info = vk::ImageMemoryRequirementsInfo2::default().image(raw.raw());
        // SAFETY: the image is of this device.
        unsafe { device.get_image_memory_requirements2(&info, &mut requirements) };
        let requirements = requirements.memory_requirements;
        let allocation = context
            .allocator()
            .allocate(&AllocationRequest {
                name,
                requirements,
                location: MemoryLocation::DeviceLocal,
                linear: false,
                dedicated: wants_dedicated(&dedicated).then(|| Dedicated::Image(raw.raw())),
            })
            .map_err(|source| GpuError::Allocation { object: name.to_owned(), size: requirements.size, source })?;
        // From here on the drop of `image` frees everything.
        let mut image = Self {
            name: name.to_owned(),
            extent,
            format,
            samples,
            mip_levels,
            context: context.clone(),
            view: None,
            raw: ManuallyDrop::new(raw),
            allocation: ManuallyDrop::new(allocation),
        };
        // SAFETY: an allocation meets the requirements of its request (contract of `Allocator`).
        unsafe { device.bind_image_memory(image.raw(), image.allocation.memory, image.allocation.offset) }
            .of("vkBindImageMemory", name)?;
        image.view = Some(image.whole_view()?);
        Ok(image)
    }

    /// A view of all mip levels.
    fn whole_view(&self) -> Result<Owned<vk::ImageView>, GpuError> {
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw())
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(self.format)
            .subresource_range(self.whole());
        // SAFETY: the image has memory, and the view is taken over by `Owned`.
        unsafe {
            let view = self.context.device().create_image_view(&info, None).of("vkCreateImageView", &self.name)?;
            Ok(Owned::new(&self.context, view, &self.name))
        }
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::Image {
        self.raw.raw()
    }

    /// A view of the whole image.
    pub fn view(&self) -> vk::ImageView {
        self.view.as_ref().map_or(vk::ImageView::null(), Owned::raw)
    }

    /// The debug name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Pixels.
    pub fn extent(&self) -> vk::Extent2D {
        self.extent
    }

    /// The format.
    pub fn format(&self) -> vk::Format {
        self.format
    }

    /// Samples a pixel.
    pub fn samples(&self) -> vk::SampleCountFlags {
        self.samples
    }

    /// Every level, and every aspect that the format has.
    pub fn whole(&self) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange {
            aspect_mask: aspects(self.format),
            base_mip_level: 0,
            level_count: self.mip_levels,
            base_array_layer: 0,
            layer_count: 1,
        }
    }

    /// A change of layout of the whole image, with the accesses before and after it to be filled in.
    pub fn barrier(&self, from: vk::ImageLayout, to: vk::ImageLayout) -> vk::ImageMemoryBarrier2<'static> {
        vk::ImageMemoryBarrier2::default()
            .image(self.raw())
            .subresource_range(self.whole())
            .old_layout(from)
            .new_layout(to)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        self.view = None;
        // SAFETY: neither is used again; by the contract of `DeviceContext::new` the device is done with them.
        unsafe {
            ManuallyDrop::drop(&mut self.raw);
            self.context.allocator().free(ManuallyDrop::take(&mut self.allocation));
        }
    }
}

/// Aspects of a format: colour, depth, stencil, or the last two.
pub fn aspects(format: vk::Format) -> vk::ImageAspectFlags {
    use vk::ImageAspectFlags as A;
    match format {
        vk::Format::D16_UNORM | vk::Format::D32_SFLOAT | vk::Format::X8_D24_UNORM_PACK32 => A::DEPTH,
        vk::Format::D16_UNORM_S8_UINT | vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT => {
            A::DEPTH | A::STENCIL
        }
        vk::Format::S8_UINT => A::STENCIL,
        _ => A::COLOR,
    }
}
