//! The descriptor sets that shaders read: set 0 of a view, set 1 of a model, set 2 of vertices that compute evaluates.

use crate::gpu::{DescriptorPool, DeviceContext, GpuError, SetLayout, descriptor_set_layout};
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

/// The layouts of a renderer's descriptor sets, and the pool of all of them.
pub(crate) struct SetLayouts {
    pub view: SetLayout,
    pub model: SetLayout,
    pub vertices: SetLayout,
    pub pool: Arc<DescriptorPool>,
}

impl SetLayouts {
    pub(crate) fn new(context: &Arc<DeviceContext>) -> Result<Arc<Self>, GpuError> {
        let [view, model, vertices] = [view_layout(context)?, model_layout(context)?, vertices_layout(context)?];
        let pool = DescriptorPool::new(context, "subdiv sets", &[&view, &model, &vertices]);
        Ok(Arc::new(Self { view, model, vertices, pool }))
    }

    /// Those of views and of models, which all pipelines have.
    pub(crate) fn shared(&self) -> [vk::DescriptorSetLayout; 2] {
        [self.view.raw(), self.model.raw()]
    }
}

/// The layout of set 0: what draws know of their view, and the list of what can be seen in it, the record of an item, and
/// its instances.
fn view_layout(context: &Arc<DeviceContext>) -> Result<SetLayout, GpuError> {
    let stages = STAGES | vk::ShaderStageFlags::COMPUTE;
    descriptor_set_layout(context, "subdiv view", &VIEW_BINDINGS.map(|ty| (ty, stages)))
}

/// The storage buffers of a model: positions, tables, frames, factors of edges, control points. Then come a uniform block that says
/// where each table starts, the displacement map, and texel buffers: of the positions, of [`TABLE_TEXELS`], of the frames, of the
/// control points. GLSL twins: `glsl/lib/draw/positions.glsl`, `glsl/lib/draw/tables.glsl`, `glsl/lib/construct/kept_frames.glsl`,
/// `glsl/lib/edges/factors.glsl`, `glsl/lib/construct/cached.glsl`, `glsl/lib/displace/displacement_map.glsl`.
pub(crate) const MODEL_BUFFERS: usize = 5;

/// Texels of four numbers, such as positions.
pub(crate) const VECTOR_TEXEL: (vk::Format, u64) = (vk::Format::R32G32B32A32_SFLOAT, 16);

/// The tables that shaders may see as texel buffers, the first of all: format and bytes of a texel of the headers of rings, their
/// entries, their types and the corners of patches; quadtrees of faces, and their leaves; and of what only compute reads, blocks of
/// vertices, the vertices that they read, and the weights of masks. GLSL twins: `glsl/lib/construct/rings.glsl`,
/// `glsl/lib/evaluate/leaves.glsl`, `glsl/compute/refine.comp`.
pub(crate) const TABLE_TEXELS: [(vk::Format, u64); 9] = [
    (vk::Format::R32G32B32A32_UINT, 16),
    (vk::Format::R32_UINT, 4),
    VECTOR_TEXEL,
    (vk::Format::R32G32_UINT, 8),
    (vk::Format::R32_UINT, 4),
    (vk::Format::R32G32B32A32_UINT, 16),
    (vk::Format::R32G32_UINT, 8),
    (vk::Format::R32G32B32A32_UINT, 16),
    VECTOR_TEXEL,
];

/// The first of [`TABLE_TEXELS`] that draws do not read.
const FIRST_OF_COMPUTE: usize = 6;

/// Texel buffers of a model.
pub(crate) const MODEL_TEXELS: usize = 3 + TABLE_TEXELS.len();

// The bindings are in this order.
const _: () = {
    use crate::constants as glsl;
    assert!(glsl::BINDING_CONTROL_POINTS as usize == MODEL_BUFFERS - 1);
    assert!(glsl::BINDING_TABLE_STARTS as usize == MODEL_BUFFERS);
    assert!(glsl::BINDING_DISPLACEMENT_MAP as usize == MODEL_BUFFERS + 1);
    assert!(glsl::BINDING_POSITION_TEXELS as usize == MODEL_BUFFERS + 2);
    assert!(glsl::BINDING_TABLE_TEXELS as usize == MODEL_BUFFERS + 3);
    assert!(glsl::BINDING_FRAME_TEXELS as usize == MODEL_BUFFERS + 3 + TABLE_TEXELS.len());
    assert!(glsl::BINDING_CONTROL_POINT_TEXELS as usize == MODEL_BUFFERS + MODEL_TEXELS + 1);
};

/// What set 0 has, by binding.
const VIEW_BINDINGS: [vk::DescriptorType; 4] = [
    vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC,
    vk::DescriptorType::STORAGE_BUFFER_DYNAMIC,
    vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC,
    vk::DescriptorType::STORAGE_BUFFER,
];

/// What set 1 has, by binding.
fn model_bindings() -> Vec<vk::DescriptorType> {
    use vk::DescriptorType as Type;
    let mut bindings = vec![Type::STORAGE_BUFFER; MODEL_BUFFERS];
    bindings.extend([Type::UNIFORM_BUFFER, Type::COMBINED_IMAGE_SAMPLER]);
    bindings.extend([Type::UNIFORM_TEXEL_BUFFER; MODEL_TEXELS]);
    bindings
}

/// What set 2 has where compute evaluates, by binding.
const VERTICES_BINDINGS: [vk::DescriptorType; 1] = [vk::DescriptorType::STORAGE_BUFFER];

/// Whether set 0 or set 1 has a descriptor of one of these types at a binding.
pub(crate) fn has_binding(set: u32, binding: u32, types: &[vk::DescriptorType]) -> bool {
    let all = if set == 0 { VIEW_BINDINGS.to_vec() } else { model_bindings() };
    all.get(binding as usize).is_some_and(|ty| types.contains(ty))
}

/// Storage buffers that a device must have for a shader stage: of all sets, in evaluation by compute.
pub(crate) fn stage_storage_buffers() -> u32 {
    let all = VIEW_BINDINGS.into_iter().chain(model_bindings()).chain(VERTICES_BINDINGS);
    all.filter(|&ty| is_storage_buffer(ty)).count() as u32
}

fn is_storage_buffer(ty: vk::DescriptorType) -> bool {
    matches!(ty, vk::DescriptorType::STORAGE_BUFFER | vk::DescriptorType::STORAGE_BUFFER_DYNAMIC)
}

/// The layout of set 1.
fn model_layout(context: &Arc<DeviceContext>) -> Result<SetLayout, GpuError> {
    let compute = vk::ShaderStageFlags::COMPUTE;
    // Of what each stage of a draw may see, which devices limit, the caller's own sets leave room for no more than is read.
    let first = crate::constants::BINDING_TABLE_TEXELS as usize;
    let is_of_compute = |binding| (first + FIRST_OF_COMPUTE..first + TABLE_TEXELS.len()).contains(&binding);
    let stages = |binding| if is_of_compute(binding) { compute } else { STAGES | compute };
    let bindings: Vec<_> = model_bindings().into_iter().enumerate().map(|(i, ty)| (ty, stages(i))).collect();
    descriptor_set_layout(context, "subdiv model", &bindings)
}

/// The layout of set 2 where compute evaluates: the vertices.
fn vertices_layout(context: &Arc<DeviceContext>) -> Result<SetLayout, GpuError> {
    let bindings = VERTICES_BINDINGS.map(|ty| (ty, vk::ShaderStageFlags::COMPUTE));
    descriptor_set_layout(context, "subdiv vertices", &bindings)
}
