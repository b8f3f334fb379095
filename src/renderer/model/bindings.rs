//! The descriptors of set 1: what the shaders of a model read.

use super::tables::Tables;
use crate::gpu::{Buffer, DescriptorSet, DeviceContext, GpuError, Owned};
use crate::renderer::options::DisplacementMap;
use crate::renderer::shader::{MODEL_BUFFERS, MODEL_TEXELS, SetLayouts, TABLE_TEXELS, VECTOR_TEXEL};
use ash::vk;
use std::sync::Arc;

/// A descriptor set, with the views that it shows.
pub(crate) struct ModelSet {
    pub raw: vk::DescriptorSet,
    _set: DescriptorSet,
    _texels: [Owned<vk::BufferView>; MODEL_TEXELS],
}

/// What a set shows. Buffers that a model does not have are as if they were its positions, for every descriptor has to be written.
pub(crate) struct ModelBuffers<'m> {
    pub positions: &'m Buffer,
    pub tables: &'m Tables,
    pub frames: Option<&'m Buffer>,
    pub edge_factors: Option<&'m Buffer>,
    pub control_points: Option<&'m Buffer>,
    pub map: DisplacementMap,
}

impl ModelSet {
    /// # Safety
    /// The buffers and the map live as long as the set is used.
    pub(crate) unsafe fn new(
        context: &Arc<DeviceContext>,
        layouts: &SetLayouts,
        name: &str,
        of: &ModelBuffers,
    ) -> Result<Self, GpuError> {
        let texels = texel_views(of)?;
        // SAFETY: the layout is among those of the pool; models are dropped when the device is done with them.
        let set = unsafe { DescriptorSet::new(&layouts.pool, &layouts.model, name)? };
        write_set(context, set.raw(), of, &texels);
        Ok(Self { raw: set.raw(), _set: set, _texels: texels })
    }
}

/// In the order of their bindings.
fn texel_views(of: &ModelBuffers) -> Result<[Owned<vk::BufferView>; MODEL_TEXELS], GpuError> {
    let whole = |buffer: Option<&Buffer>| {
        let buffer = buffer.unwrap_or(of.positions);
        buffer.texels(VECTOR_TEXEL.0, VECTOR_TEXEL.1, 0, buffer.size())
    };
    let table = |i: usize| {
        let ((format, texel), range) = (TABLE_TEXELS[i], &of.tables.texels[i]);
        of.tables.buffer.texels(format, texel, range.start, range.end - range.start)
    };
    let tables = (0..TABLE_TEXELS.len()).map(table);
    let views = std::iter::once(whole(None)).chain(tables).chain([whole(of.frames), whole(of.control_points)]);
    let views = views.collect::<Result<Vec<_>, _>>()?;
    Ok(views.try_into().unwrap_or_else(|_| unreachable!("as many as there are texel buffers")))
}

fn write_set(context: &DeviceContext, set: vk::DescriptorSet, of: &ModelBuffers, texels: &[Owned<vk::BufferView>]) {
    use vk::DescriptorType as Type;
    let write = |binding: usize, ty| {
        vk::WriteDescriptorSet::default().dst_set(set).dst_binding(binding as u32).descriptor_type(ty)
    };
    let whole = |buffer: Option<&Buffer>| [buffer.unwrap_or(of.positions).descriptor()];
    let part = |offset, range| [vk::DescriptorBufferInfo { buffer: of.tables.buffer.raw(), offset, range }];
    let starts = &of.tables.starts;
    let buffers: [_; MODEL_BUFFERS] =
        [whole(None), part(0, of.tables.storage), whole(of.frames), whole(of.edge_factors), whole(of.control_points)];
    let starts = part(starts.start, starts.end - starts.start);
    let map = of.map;
    let image = [vk::DescriptorImageInfo { sampler: map.sampler, image_view: map.view, image_layout: map.layout }];
    let views: Vec<_> = texels.iter().map(|view| [view.raw()]).collect();
    let mut writes: Vec<_> =
        (0..).zip(&buffers).map(|(binding, buffer)| write(binding, Type::STORAGE_BUFFER).buffer_info(buffer)).collect();
    writes.push(write(MODEL_BUFFERS, Type::UNIFORM_BUFFER).buffer_info(&starts));
    writes.push(write(MODEL_BUFFERS + 1, Type::COMBINED_IMAGE_SAMPLER).image_info(&image));
    let texels = (MODEL_BUFFERS + 2..).zip(&views);
    writes.extend(texels.map(|(binding, view)| write(binding, Type::UNIFORM_TEXEL_BUFFER).texel_buffer_view(view)));
    // SAFETY: the set is new, the buffers live as long as it, and the map as long as the renderer.
    unsafe { context.device().update_descriptor_sets(&writes, &[]) };
}
