//! The descriptor sets that shaders read: set 0 of a view, set 1 of a model.

use crate::gpu::{DeviceContext, GpuError, Owned, descriptor_set_layout};
use ash::vk;
use std::sync::Arc;

/// The stages that read set 0, set 1 and the push constants.
pub(crate) const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::VERTEX.as_raw()
        | vk::ShaderStageFlags::TESSELLATION_CONTROL.as_raw()
        | vk::ShaderStageFlags::TESSELLATION_EVALUATION.as_raw()
        | vk::ShaderStageFlags::GEOMETRY.as_raw()
        | vk::ShaderStageFlags::FRAGMENT.as_raw(),
);

/// The layout of set 0: what draws know of their view, and the list of what can be seen in it.
pub(crate) fn view_layout(context: &Arc<DeviceContext>) -> Result<Owned<vk::DescriptorSetLayout>, GpuError> {
    let stages = STAGES | vk::ShaderStageFlags::COMPUTE;
    let bindings =
        [(vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC, stages), (vk::DescriptorType::STORAGE_BUFFER_DYNAMIC, stages)];
    descriptor_set_layout(context, "subdiv view", &bindings)
}

/// Storage buffers of a model: positions, [`ModelTables::bindings`](crate::renderer::ModelTables), factors of edges, cached control
/// points. The displacement map comes after them, and those in [`TEXELS`] once more as texel buffers.
pub(crate) const MODEL_BUFFERS: usize = 13;

/// Which storage buffers of set 1 shaders see as texel buffers, too, how, and the bytes of a texel: positions, rings, their
/// entries, their types, corners of patches, frames, control points. GLSL twins: `glsl/lib/draw/positions.glsl`, `glsl/lib/construct/rings.glsl`,
/// `glsl/lib/construct/kept_frames.glsl`, `glsl/lib/construct/cached.glsl`.
pub(crate) const TEXELS: [(usize, vk::Format, u64); 7] = [
    (0, vk::Format::R32G32B32A32_SFLOAT, 16),
    (1, vk::Format::R32G32B32A32_UINT, 16),
    (2, vk::Format::R32_UINT, 4),
    (3, vk::Format::R32G32B32A32_SFLOAT, 16),
    (4, vk::Format::R32G32_UINT, 8),
    (FRAMES_BINDING, vk::Format::R32G32B32A32_SFLOAT, 16),
    (POINTS_BINDING, vk::Format::R32G32B32A32_SFLOAT, 16),
];

/// Of set 1: frames are in the place of the stencil table, which the cached construction does without.
pub(crate) const FRAMES_BINDING: usize = 5;
/// Of set 1: control points that are kept.
pub(crate) const POINTS_BINDING: usize = 12;

/// The layout of a [`ModelSet`].
pub(crate) fn model_layout(context: &Arc<DeviceContext>) -> Result<Owned<vk::DescriptorSetLayout>, GpuError> {
    let stages = STAGES | vk::ShaderStageFlags::COMPUTE;
    let mut bindings = vec![(vk::DescriptorType::STORAGE_BUFFER, stages); MODEL_BUFFERS];
    bindings.push((vk::DescriptorType::COMBINED_IMAGE_SAMPLER, stages));
    bindings.extend([(vk::DescriptorType::UNIFORM_TEXEL_BUFFER, stages); TEXELS.len()]);
    descriptor_set_layout(context, "subdiv model", &bindings)
}
