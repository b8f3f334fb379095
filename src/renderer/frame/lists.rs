//! Lists of the patches that can be seen, made by compute: pipelines, memory, dispatches. See [`super::cull`].

use crate::constants::{ID_COPIES, REGION};
use crate::gpu::{Buffer, DescriptorSet, DeviceContext, GpuError, MAX_OFFSET_ALIGNMENT, Specialization};
use crate::renderer::evaluate::path;
use crate::renderer::pipelines::ComputePipelines;
use crate::renderer::shader::{Cut, PatchStages, SetLayouts, ShaderCode, ViewData};
use crate::table::TEXEL_BYTES;
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;

/// Bytes of a patch's place on a list.
const PLACE_BYTES: u64 = 4;
/// The most bytes of a list.
const MAX_BYTES: u64 = 1 << 20;

/// How large a list is, and what is in it: places of patches, then the indirect draws, then copies. Workgroups list the patches of
/// a region each, and write its draws.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ListLayout {
    /// Bytes of the commands of a region.
    command_bytes: u64,
    /// Bytes of a patch that are copied behind the list, for instances to have them as attributes; else 0.
    copied: u64,
}

impl ListLayout {
    pub(crate) fn new(stages: PatchStages) -> Self {
        let command_bytes = path(stages.evaluation).command_bytes();
        let copied = if stages.attributes { stages.patch_bytes().into() } else { 0 };
        Self { command_bytes: command_bytes as u64, copied }
    }

    /// The most patches of a list.
    pub(crate) fn max_patches(self) -> u32 {
        let of_region = u64::from(REGION) * (PLACE_BYTES + self.copied) + self.command_bytes;
        ((MAX_BYTES - TEXEL_BYTES) / of_region) as u32 * REGION
    }

    /// How many regions so many patches are.
    pub(crate) fn regions(patches: u32) -> u32 {
        patches.div_ceil(REGION)
    }

    /// Bytes of a list of so many patches before the draws.
    pub(crate) fn commands_start(patches: u32) -> u64 {
        PLACE_BYTES * u64::from(patches)
    }

    /// Bytes before the copies.
    pub(crate) fn copies_start(self, patches: u32) -> u64 {
        let commands = self.command_bytes * u64::from(Self::regions(patches));
        (Self::commands_start(patches) + commands).next_multiple_of(TEXEL_BYTES)
    }

    /// Bytes of a list of so many patches, up to the next.
    pub(crate) fn bytes(self, patches: u32) -> u64 {
        (self.copies_start(patches) + self.copied * u64::from(patches)).next_multiple_of(MAX_OFFSET_ALIGNMENT)
    }
}

/// What a list and its indirect draws are made of: push constants. GLSL twin: `Draw` in `glsl/lib/draw/draw.glsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct ListConstants {
    /// As of [`DrawConstants`](crate::renderer::gpu_data::DrawConstants).
    pub transform: [[f32; 4]; 3],
    pub factor: f32,
    pub flags: u32,
    pub first_corner: u32,
    pub first_patch: u32,
    /// Of the patches.
    pub count: u32,
    /// Vertices of a patch in a draw: the points of its corners, or the indices of a lattice.
    pub vertices: u32,
    /// Of a lattice.
    pub first_index: u32,
    /// 0 for indexed draws with an instance for each patch.
    pub patches_per_instance: u32,
    /// The word of the list where the copies start.
    pub copies: u32,
}

const _: () = assert!(std::mem::offset_of!(ListConstants, count) == 64);
const _: () = assert!(size_of::<ListConstants>() == 84);

/// The lists of a frame, and set 0 with them.
pub(crate) struct FrameLists {
    pub set: DescriptorSet,
    buffer: Option<Buffer>,
    /// Bytes that lists may take.
    pub capacity: u64,
    used: u64,
}

impl FrameLists {
    /// With room for lists of so many bytes.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        layouts: &SetLayouts,
        views: &Buffer,
        bytes: u64,
    ) -> Result<Self, GpuError> {
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::INDIRECT_BUFFER | Usage::VERTEX_BUFFER;
        // What shaders see from the start of a list on: also of the last.
        let range = bytes.min(MAX_BYTES);
        let make = || Buffer::device_local(context, "subdiv lists of patches", bytes + range, usage);
        let buffer = (bytes > 0).then(make).transpose()?;
        // Every descriptor has to be written; without lists no draw reads any.
        let (lists, range) = buffer.as_ref().map_or((views, 4), |lists| (lists, range));
        let part = |buffer: &Buffer, range| vk::DescriptorBufferInfo { buffer: buffer.raw(), offset: 0, range };
        let parts = [part(views, size_of::<ViewData>() as u64), part(lists, range)];
        // SAFETY: the layout is among those of the pool, with these; the lists go with the set, and the views with the renderer.
        let set = unsafe { DescriptorSet::of_buffers(&layouts.pool, &layouts.view, "subdiv view", &parts)? };
        Ok(Self { set, buffer, capacity: bytes, used: 0 })
    }

    /// Forgets the lists that there are.
    pub(crate) fn clear(&mut self) {
        self.used = 0;
    }

    pub(crate) fn has_room(&self, bytes: u64) -> bool {
        self.used + bytes <= self.capacity
    }

    /// Takes room of so many bytes for a list, which there must be: where it starts.
    pub(crate) fn take(&mut self, bytes: u64) -> u32 {
        let offset = self.used;
        self.used += bytes;
        offset as u32
    }

    /// The buffer with the lists; null if there is no room for any.
    pub(crate) fn raw(&self) -> vk::Buffer {
        self.buffer.as_ref().map_or(vk::Buffer::null(), Buffer::raw)
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.buffer.as_ref().map_or(0, Buffer::size)
    }
}

/// The pipelines that find which patches can be seen, and list them: by [`PatchStages::for_culling`].
pub(crate) struct ListPipelines(ComputePipelines<(PatchStages, Cut), ListConstants>);

impl ListPipelines {
    /// With the set layouts of the draws.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        sets: [vk::DescriptorSetLayout; 2],
        cache: vk::PipelineCache,
    ) -> Result<Self, GpuError> {
        ComputePipelines::new(context, "subdiv lists of patches", &sets, cache).map(Self)
    }

    /// Makes what patches need that are left out by these rules.
    pub(crate) fn make(&mut self, stages: PatchStages, cut: Cut, code: &ShaderCode) -> Result<(), GpuError> {
        let stages = stages.for_culling();
        let constants = stages.specialization(cut, self.0.context().properties());
        let constants: Vec<_> =
            constants.into_iter().chain([Specialization::bool(ID_COPIES, stages.attributes)]).collect();
        self.0.make((stages, cut), stages.culling(), code, &constants)
    }

    /// Records the dispatch that makes a list.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering; the pipeline was made; the sets and the offsets in set 0 (of the view, of the
    /// list) are valid, and the list has room.
    pub(crate) unsafe fn cmd_list(
        &self,
        cmd: vk::CommandBuffer,
        (stages, cut): (PatchStages, Cut),
        sets: [vk::DescriptorSet; 2],
        offsets: [u32; 2],
        constants: &ListConstants,
    ) {
        // SAFETY: as the caller promises.
        unsafe {
            self.0.cmd_bind(cmd, 0, &sets, &offsets);
            self.0.cmd_dispatch(
                cmd,
                &(stages.for_culling(), cut),
                constants,
                [ListLayout::regions(constants.count), 1],
            );
        }
    }
}
