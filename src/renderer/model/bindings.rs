//! The descriptors of set 1: what the shaders of a model read.

use crate::gpu::{Buffer, DescriptorSet, DeviceContext, GpuError, Owned};
use crate::renderer::options::DisplacementMap;
use crate::renderer::shader::{MODEL_BUFFERS, TEXELS};
use ash::vk;
use std::sync::Arc;

/// A descriptor set, with the views that it shows.
pub(crate) struct ModelSet {
    pub raw: vk::DescriptorSet,
    _set: DescriptorSet,
    _texels: Vec<Owned<vk::BufferView>>,
}

impl ModelSet {
    /// Of parts of buffers, from an offset on so many bytes each, by binding.
    ///
    /// # Safety
    /// The layout is [`model_layout`]'s; the buffers and the map live as long as the set is used.
    pub(crate) unsafe fn new(
        context: &Arc<DeviceContext>,
        layout: vk::DescriptorSetLayout,
        name: &str,
        parts: &[(&Buffer, u64, u64)],
        map: DisplacementMap,
    ) -> Result<Self, GpuError> {
        let texels = TEXELS.map(|(binding, format, texel)| {
            let (buffer, offset, bytes) = parts[binding];
            buffer.texels(format, texel, offset, bytes)
        });
        let texels = texels.into_iter().collect::<Result<Vec<_>, _>>()?;
        let descriptors = [
            (vk::DescriptorType::STORAGE_BUFFER, MODEL_BUFFERS as u32),
            (vk::DescriptorType::COMBINED_IMAGE_SAMPLER, 1),
            (vk::DescriptorType::UNIFORM_TEXEL_BUFFER, TEXELS.len() as u32),
        ];
        // SAFETY: the layout is of this device, and has these.
        let set = unsafe { DescriptorSet::new(context, layout, name, &descriptors)? };
        write_set(context, set.raw(), parts, map, &texels);
        Ok(Self { raw: set.raw(), _set: set, _texels: texels })
    }
}

fn write_set(
    context: &DeviceContext,
    set: vk::DescriptorSet,
    parts: &[(&Buffer, u64, u64)],
    map: DisplacementMap,
    texels: &[Owned<vk::BufferView>],
) {
    let info =
        |&(buffer, offset, range): &(&Buffer, _, _)| vk::DescriptorBufferInfo { buffer: buffer.raw(), offset, range };
    let buffers: Vec<_> = parts.iter().map(info).collect();
    let image = [vk::DescriptorImageInfo { sampler: map.sampler, image_view: map.view, image_layout: map.layout }];
    let sampler = vk::WriteDescriptorSet::default()
        .dst_set(set)
        .dst_binding(MODEL_BUFFERS as u32)
        .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
        .image_info(&image);
    let views: Vec<_> = texels.iter().map(Owned::raw).collect();
    let texels = (MODEL_BUFFERS as u32 + 1..).zip(views.chunks(1)).map(|(binding, view)| {
        vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(binding)
            .descriptor_type(vk::DescriptorType::UNIFORM_TEXEL_BUFFER)
            .texel_buffer_view(view)
    });
    let writes: Vec<_> = (0..)
        .zip(buffers.chunks(1))
        .map(|(binding, info)| {
            vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(binding)
                .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                .buffer_info(info)
        })
        .chain([sampler])
        .chain(texels)
        .collect();
    // SAFETY: the set is new, the buffers live as long as it, and the map as long as the renderer.
    unsafe { context.device().update_descriptor_sets(&writes, &[]) };
}
