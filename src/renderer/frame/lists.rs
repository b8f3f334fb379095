//! Lists of the patches that can be seen, made by compute: pipelines, memory, dispatches. See [`super::cull`].

use crate::constants::{ID_COPIES, REGION};
use crate::gpu::{
    Buffer, BufferDesc, DescriptorSet, DeviceContext, GpuError, MAX_OFFSET_ALIGNMENT, MemoryLocation, Specialization,
};
use crate::renderer::evaluate::path;
use crate::renderer::options::Error;
use crate::renderer::pipelines::ComputePipelines;
use crate::renderer::shader::{Cut, DrawConstants, ItemRecord, PatchStages, SetLayouts, ShaderCode, ViewData};
use crate::table::TEXEL_BYTES;
use ash::vk;
use bytemuck::{Pod, Zeroable};
use rustc_hash::FxHashMap;
use std::ops::Range;
use std::sync::Arc;

/// Bytes of a patch's place on a list.
const PLACE_BYTES: u64 = 4;
/// The most bytes of a list.
const MAX_BYTES: u64 = 1 << 20;
/// The most bytes of the lists of a frame: their offsets are of 32 bits.
const MAX_LISTS: u64 = 1 << 31;
/// The most records of a frame: likewise.
const MAX_RECORDS: u64 = MAX_LISTS / ItemRecord::STRIDE;

/// A capacity with room for `needed`, of at most `max`: at least twice what there was, so that growing is rare.
fn grown(needed: u64, capacity: u64, max: u64) -> Option<u64> {
    (needed <= max).then(|| needed.max(2 * capacity).next_power_of_two().min(max))
}

/// Layout of a list: places of patches, then the indirect draws, then copies. Each workgroup lists the patches of a region, and
/// writes its draws.
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

    /// Regions of `patches` patches.
    pub(crate) fn regions(patches: u32) -> u32 {
        patches.div_ceil(REGION)
    }

    /// Bytes before the draws, in a list of `patches` patches.
    pub(crate) fn commands_start(patches: u32) -> u64 {
        PLACE_BYTES * u64::from(patches)
    }

    /// Bytes before the copies.
    pub(crate) fn copies_start(self, patches: u32) -> u64 {
        let commands = self.command_bytes * u64::from(Self::regions(patches));
        (Self::commands_start(patches) + commands).next_multiple_of(TEXEL_BYTES)
    }

    /// Bytes from a list of `patches` patches to the next.
    pub(crate) fn bytes(self, patches: u32) -> u64 {
        (self.copies_start(patches) + self.copied * u64::from(patches)).next_multiple_of(MAX_OFFSET_ALIGNMENT)
    }
}

/// What a list and its indirect draws are made of: push constants. GLSL twin: `Draw` in `glsl/lib/draw/draw.glsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct ListConstants {
    /// Constants of the draws; patches per instance are 0 for indexed draws, where each patch has an instance.
    pub of_draw: DrawConstants,
    /// Of the patches.
    pub count: u32,
    /// Vertices of a patch in a draw: the points of its corners, or the indices of a uniform grid.
    pub vertices: u32,
    /// Of a uniform grid.
    pub first_index: u32,
    /// The word of the list where the copies start.
    pub copies: u32,
}

const _: () = assert!(std::mem::offset_of!(ListConstants, count) == 28);
const _: () = assert!(size_of::<ListConstants>() == 44);

/// The lists of a frame, the records of its items, and set 0 with them.
pub(crate) struct FrameLists {
    pub set: DescriptorSet,
    /// The buffers of set 0, and the sets with instances in their place.
    parts: [vk::DescriptorBufferInfo; 4],
    sets: FxHashMap<(vk::Buffer, u64, u64), DescriptorSet>,
    pub records: Records,
    buffer: Option<Buffer>,
    /// Bytes that lists may take.
    pub capacity: u64,
    used: u64,
}

impl FrameLists {
    /// Lists with room for `bytes` bytes, and `records` records.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        layouts: &SetLayouts,
        views: &Buffer,
        bytes: u64,
        records: u32,
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
        let records = Records::new(context, records)?;
        let of_items = part(records.buffer.as_ref().unwrap_or(views), size_of::<ItemRecord>() as u64);
        let parts = [part(views, size_of::<ViewData>() as u64), part(lists, range), of_items, part(views, 4)];
        // SAFETY: the layout is among those of the pool, with these; the lists go with the set, and the views with the renderer.
        let set = unsafe { DescriptorSet::of_buffers(&layouts.pool, &layouts.view, "subdiv view", &parts)? };
        Ok(Self { set, parts, sets: FxHashMap::default(), records, buffer, capacity: bytes, used: 0 })
    }

    /// Forgets the lists and records that there are.
    pub(crate) fn clear(&mut self) {
        self.used = 0;
        self.records.used = 0;
        self.sets.clear();
    }

    /// Set 0 with instances: those that start in some bytes of a buffer.
    pub(crate) fn set_of_instances(
        &mut self,
        layouts: &SetLayouts,
        buffer: vk::Buffer,
        seen: Range<u64>,
    ) -> Result<vk::DescriptorSet, GpuError> {
        let (offset, range) = (seen.start, seen.end - seen.start);
        let key = (buffer, offset, range);
        if let Some(set) = self.sets.get(&key) {
            return Ok(set.raw());
        }
        let [view, lists, items, _] = self.parts;
        let parts = [view, lists, items, vk::DescriptorBufferInfo { buffer, offset, range }];
        // SAFETY: as in `new`; the instances live as long as the frame.
        let set = unsafe { DescriptorSet::of_buffers(&layouts.pool, &layouts.view, "subdiv instances", &parts)? };
        let raw = set.raw();
        self.sets.insert(key, set);
        Ok(raw)
    }

    pub(crate) fn has_room(&self, bytes: u64) -> bool {
        self.used + bytes <= self.capacity
    }

    /// Bytes and records of larger ones, with room for `bytes` bytes of lists and for `records` records.
    pub(crate) fn grown(&self, bytes: u64, records: u64) -> Result<(u64, u32), Error> {
        let bytes = match self.has_room(bytes) {
            true => self.capacity,
            false => grown(bytes, self.capacity, MAX_LISTS).ok_or(Error::ListsTooLarge { bytes, max: MAX_LISTS })?,
        };
        let records = match self.records.has_room(records) {
            true => self.records.capacity.into(),
            false => grown(records, self.records.capacity.into(), MAX_RECORDS)
                .ok_or(Error::TooManyItems { given: records, max: MAX_RECORDS })?,
        };
        Ok((bytes, records as u32))
    }

    /// Takes room of `bytes` bytes for a list, which there must be: where it starts.
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

/// Records of items, for the host to write.
#[derive(Default)]
pub(crate) struct Records {
    buffer: Option<Buffer>,
    pub capacity: u32,
    used: u32,
}

impl Records {
    fn new(context: &Arc<DeviceContext>, capacity: u32) -> Result<Self, GpuError> {
        let desc = BufferDesc {
            name: "subdiv items",
            size: ItemRecord::STRIDE * u64::from(capacity),
            usage: vk::BufferUsageFlags::UNIFORM_BUFFER,
            location: MemoryLocation::Upload,
        };
        let buffer = (capacity > 0).then(|| Buffer::new(context, &desc)).transpose()?;
        Ok(Self { buffer, capacity, used: 0 })
    }

    /// Whether there is room for `more` records.
    pub(crate) fn has_room(&self, more: u64) -> bool {
        u64::from(self.used) + more <= u64::from(self.capacity)
    }

    /// Writes a record, for which there must be room: where it is in the buffer.
    pub(crate) fn push(&mut self, record: &ItemRecord) -> Result<u32, GpuError> {
        let offset = ItemRecord::STRIDE * u64::from(self.used);
        if let Some(buffer) = &mut self.buffer {
            buffer.write(offset, std::slice::from_ref(record))?;
        }
        self.used += 1;
        Ok(offset as u32)
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

    /// Makes what patches need that are culled by these rules.
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
    /// list, of the item's record) are valid, and the list has room.
    pub(crate) unsafe fn cmd_list(
        &self,
        cmd: vk::CommandBuffer,
        (stages, cut): (PatchStages, Cut),
        sets: [vk::DescriptorSet; 2],
        offsets: [u32; 3],
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
