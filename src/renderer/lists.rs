//! Lists of the patches that can be seen, made by compute: pipelines, memory, dispatches. See [`super::visible`].

use super::factor::Cut;
use super::gpu_data::{DrawConstants, ViewData};
use super::model::device_buffer;
use super::pipelines::ShaderCode;
use super::stages::PatchStages;
use super::tables::TEXEL_BYTES;
use crate::gpu::{
    Buffer, ComputePipelineDesc, DescriptorSet, DeviceContext, GpuError, MAX_OFFSET_ALIGNMENT, Owned, Shader,
    descriptor_set_layout, pipeline_layout,
};
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::collections::HashMap;
use std::sync::Arc;

/// The most patches of a list. Each workgroup that makes it looks at all before its own.
const MAX_PATCHES: u64 = 2048;
/// Bytes of a list before its patches. GLSL twin: `Visible` in `glsl/lib/visible.glsl`.
const HEADER_BYTES: u64 = 4 * 8;
/// Bytes of a list for each of its patches: its place on the list, and whether it can be seen.
const PATCH_BYTES: u64 = 4 * 2;
/// The most bytes of a list.
const MAX_BYTES: u64 = 1 << 20;
/// Invocations in a workgroup of `glsl/compute/cull.comp` and `compact.comp`.
const GROUP: u32 = 64;

/// From one command of a list to the next.
pub(super) const COMMAND_BYTES: u32 = size_of::<vk::DrawIndirectCommand>() as u32;

/// How large a list is, and what is in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct ListLayout {
    /// Bytes of a patch that are copied behind the list, for instances to have them as attributes; else 0.
    copied: u64,
}

impl ListLayout {
    pub(super) fn new(stages: PatchStages) -> Self {
        Self { copied: if stages.attributes { stages.patch_bytes().into() } else { 0 } }
    }

    /// The most patches of a list.
    pub(super) fn max_patches(self) -> u32 {
        let most = (MAX_BYTES - HEADER_BYTES - TEXEL_BYTES) / (PATCH_BYTES + self.copied);
        most.min(MAX_PATCHES) as u32
    }

    /// Bytes of a list of so many patches before the copies.
    pub(super) fn copies_start(patches: u32) -> u64 {
        (HEADER_BYTES + PATCH_BYTES * u64::from(patches)).next_multiple_of(TEXEL_BYTES)
    }

    /// The same as a word after the header.
    pub(super) fn copies_word(patches: u32) -> u32 {
        ((Self::copies_start(patches) - HEADER_BYTES) / 4) as u32
    }

    /// Bytes of a list of so many patches, up to the next.
    pub(super) fn bytes(self, patches: u32) -> u64 {
        (Self::copies_start(patches) + self.copied * u64::from(patches)).next_multiple_of(MAX_OFFSET_ALIGNMENT)
    }
}

/// What a list and its indirect draws are made of: push constants. GLSL twin: `Compact` in `glsl/compute/compact.comp`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct Compact {
    /// Of all patches.
    pub count: u32,
    /// Vertices of a patch in a draw: the points of its corners, or the indices of a lattice.
    pub vertices: u32,
    /// Of a lattice.
    pub first_index: u32,
    /// 0 for indexed draws with an instance for each patch.
    pub patches_per_instance: u32,
    pub first_corner: u32,
    /// The word of the list after its header where the copies start.
    pub copies: u32,
}

/// The layout of set 0: what draws know of their view, and the list of what can be seen in it.
pub(super) fn view_layout(context: &Arc<DeviceContext>) -> Result<Owned<vk::DescriptorSetLayout>, GpuError> {
    let stages = super::pipelines::STAGES | vk::ShaderStageFlags::COMPUTE;
    let bindings =
        [(vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC, stages), (vk::DescriptorType::STORAGE_BUFFER_DYNAMIC, stages)];
    descriptor_set_layout(context, "subdiv view", &bindings)
}

/// The lists of a frame, and set 0 with them.
pub(super) struct FrameLists {
    pub set: DescriptorSet,
    buffer: Option<Buffer>,
    /// Bytes that lists may take.
    pub capacity: u64,
    used: u64,
}

impl FrameLists {
    /// With room for lists of so many bytes.
    pub(super) fn new(
        context: &Arc<DeviceContext>,
        layout: vk::DescriptorSetLayout,
        views: &Buffer,
        bytes: u64,
    ) -> Result<Self, GpuError> {
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::INDIRECT_BUFFER | Usage::VERTEX_BUFFER;
        // What shaders see from the start of a list on: also of the last.
        let range = bytes.min(MAX_BYTES);
        let make = || device_buffer(context, "subdiv lists of patches", bytes + range, usage);
        let buffer = (bytes > 0).then(make).transpose()?;
        // Every descriptor has to be written; without lists no draw reads any.
        let (lists, range) = buffer.as_ref().map_or((views, 4), |lists| (lists, range));
        let part = |buffer: &Buffer, range| vk::DescriptorBufferInfo { buffer: buffer.raw(), offset: 0, range };
        let parts = [
            (vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC, part(views, size_of::<ViewData>() as u64)),
            (vk::DescriptorType::STORAGE_BUFFER_DYNAMIC, part(lists, range)),
        ];
        // SAFETY: the layout is of this device, with these; the lists go with the set, and the views with the renderer.
        let set = unsafe { DescriptorSet::of_buffers(context, layout, "subdiv view", &parts)? };
        Ok(Self { set, buffer, capacity: bytes, used: 0 })
    }

    /// Forgets the lists that there are.
    pub(super) fn clear(&mut self) {
        self.used = 0;
    }

    pub(super) fn has_room(&self, bytes: u64) -> bool {
        self.used + bytes <= self.capacity
    }

    /// Takes room of so many bytes for a list, which there must be: where it starts.
    pub(super) fn take(&mut self, bytes: u64) -> u32 {
        let offset = self.used;
        self.used += bytes;
        offset as u32
    }

    /// The buffer with the lists; null if there is no room for any.
    pub(super) fn raw(&self) -> vk::Buffer {
        self.buffer.as_ref().map_or(vk::Buffer::null(), Buffer::raw)
    }

    pub(super) fn bytes(&self) -> u64 {
        self.buffer.as_ref().map_or(0, Buffer::size)
    }
}

/// The pipelines that find which patches can be seen, and list them.
pub(super) struct ListPipelines {
    context: Arc<DeviceContext>,
    layout: Owned<vk::PipelineLayout>,
    cache: vk::PipelineCache,
    /// By [`PatchStages::for_culling`].
    culling: HashMap<(PatchStages, Cut), Owned<vk::Pipeline>>,
    /// By [`copying`].
    compacting: HashMap<Option<PatchStages>, Owned<vk::Pipeline>>,
}

/// What tells apart the pipelines that make lists: what is copied, if anything is.
fn copying(stages: PatchStages) -> Option<PatchStages> {
    stages.attributes.then(|| stages.for_culling())
}

impl ListPipelines {
    /// With the set layouts of the draws.
    pub(super) fn new(
        context: &Arc<DeviceContext>,
        sets: [vk::DescriptorSetLayout; 2],
        cache: vk::PipelineCache,
    ) -> Result<Self, GpuError> {
        let size = size_of::<DrawConstants>() as u32;
        let constants = [vk::PushConstantRange { stage_flags: vk::ShaderStageFlags::COMPUTE, offset: 0, size }];
        // SAFETY: the set layouts are of this device.
        let layout = unsafe { pipeline_layout(context, "subdiv lists of patches", &sets, &constants)? };
        Ok(Self { context: context.clone(), layout, cache, culling: HashMap::new(), compacting: HashMap::new() })
    }

    /// Makes what patches need that are left out by these rules.
    pub(super) fn make(&mut self, stages: PatchStages, cut: Cut, code: &ShaderCode) -> Result<(), GpuError> {
        let constants = stages.specialization(cut, self.context.properties());
        let key = copying(stages);
        if !self.compacting.contains_key(&key) {
            let name = if key.is_some() { "COMPUTE_COMPACT_COMP_COPIES" } else { "COMPUTE_COMPACT_COMP" };
            let pipeline = self.create(name, Shader::compute(code.find(name)?).specialized(&constants))?;
            self.compacting.insert(key, pipeline);
        }
        let stages = stages.for_culling();
        if !self.culling.contains_key(&(stages, cut)) {
            let name = stages.culling();
            let pipeline = self.create(&name, Shader::compute(code.find(&name)?).specialized(&constants))?;
            self.culling.insert((stages, cut), pipeline);
        }
        Ok(())
    }

    fn create(&self, name: &str, shader: Shader) -> Result<Owned<vk::Pipeline>, GpuError> {
        let name = &format!("subdiv {name}");
        let desc = ComputePipelineDesc { name, layout: self.layout.raw(), shader, cache: self.cache };
        // SAFETY: the shader is ours and matches the layout.
        unsafe { desc.create(&self.context) }
    }

    /// Records the dispatch that finds which patches can be seen of as many as
    /// [`patches_per_instance`](DrawConstants::patches_per_instance) says.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering; the pipeline was made; the sets and the offsets in set 0 (of the view, of the
    /// list) are valid, and the list has room.
    pub(super) unsafe fn cmd_cull(
        &self,
        cmd: vk::CommandBuffer,
        (stages, cut): (PatchStages, Cut),
        sets: [vk::DescriptorSet; 2],
        offsets: [u32; 2],
        constants: &DrawConstants,
    ) {
        let Some(pipeline) = self.culling.get(&(stages.for_culling(), cut)) else { return };
        let groups = constants.patches_per_instance.div_ceil(GROUP);
        // SAFETY: as the caller promises.
        unsafe { self.cmd_dispatch(cmd, pipeline, sets, offsets, bytemuck::bytes_of(constants), groups) };
    }

    /// Records the dispatch that makes a list of what was found, and its draws.
    ///
    /// # Safety
    /// As [`ListPipelines::cmd_cull`], which went before, with a barrier in between.
    pub(super) unsafe fn cmd_compact(
        &self,
        cmd: vk::CommandBuffer,
        stages: PatchStages,
        sets: [vk::DescriptorSet; 2],
        offsets: [u32; 2],
        compact: &Compact,
    ) {
        let Some(pipeline) = self.compacting.get(&copying(stages)) else { return };
        let groups = compact.count.div_ceil(GROUP);
        // SAFETY: as the caller promises.
        unsafe { self.cmd_dispatch(cmd, pipeline, sets, offsets, bytemuck::bytes_of(compact), groups) };
    }

    unsafe fn cmd_dispatch(
        &self,
        cmd: vk::CommandBuffer,
        pipeline: &Owned<vk::Pipeline>,
        sets: [vk::DescriptorSet; 2],
        offsets: [u32; 2],
        constants: &[u8],
        groups: u32,
    ) {
        let (device, layout, point) = (self.context.device(), self.layout.raw(), vk::PipelineBindPoint::COMPUTE);
        // SAFETY: as the caller promises.
        unsafe {
            device.cmd_bind_pipeline(cmd, point, pipeline.raw());
            device.cmd_bind_descriptor_sets(cmd, point, layout, 0, &sets, &offsets);
            device.cmd_push_constants(cmd, layout, vk::ShaderStageFlags::COMPUTE, 0, constants);
            device.cmd_dispatch(cmd, groups, 1, 1);
        }
    }
}
