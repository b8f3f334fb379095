//! A model on the GPU.

use super::cached::CachedPipelines;
use super::pipelines::{MODEL_BINDINGS, Pipelines};
use super::stages::PatchStages;
use super::{Construction, Error, Geometry, MemoryUsage, ModelId, ModelOptions, ModelTables, Options};
use crate::gpu::{Buffer, BufferDesc, DeviceContext, GpuError, MemoryLocation, Owned, VkResultExt};
use crate::topology::PatchKind;
use ash::vk;
use std::sync::Arc;

/// The binding of the control points that the cached construction keeps.
const CONTROL_POINTS: usize = 4;
/// The largest `minStorageBufferOffsetAlignment` that Vulkan allows.
const ALIGNMENT: u64 = 256;

pub(super) struct Model {
    pub id: ModelId,
    pub tables: ModelTables,
    /// How each kind of patch that the model has is drawn.
    pub stages: Vec<PatchStages>,
    pub set: vk::DescriptorSet,
    _pool: Owned<vk::DescriptorPool>,
    /// All tables of the construction and the texture coordinates, one after the other.
    table_buffer: Buffer,
    positions: Buffer,
    /// What the cached construction keeps.
    control_points: Option<Buffer>,
    /// Whether it is out of date.
    stale: bool,
    /// A copy of the positions for each frame that may be on the device.
    staged_positions: Buffer,
    /// Frames whose staged positions are new since they were last copied.
    dirty: Vec<bool>,
    /// Edges, then faces of the control mesh, if a style draws them.
    pub control: Option<ControlIndices>,
    /// What was not copied to the device yet.
    uploads: Vec<(Buffer, vk::Buffer)>,
    pub prepared: bool,
}

pub(super) struct ControlIndices {
    pub buffer: Buffer,
    pub edges: u32,
    pub faces: u32,
    pub vertex_offset: i32,
}

impl Model {
    pub(super) fn new(
        context: &Arc<DeviceContext>,
        pipelines: &Pipelines,
        options: &Options,
        id: ModelId,
        model_options: &ModelOptions,
        tables: ModelTables,
        control: &[[f32; 3]],
    ) -> Result<Self, Error> {
        let name = if model_options.name.is_empty() { "model" } else { &model_options.name };
        let max = context.properties().max_storage_buffer_range;
        let check = |table: &'static str, bytes: u64| {
            if bytes > max { Err(Error::TableTooLarge { id, table, bytes, max }) } else { Ok(()) }
        };

        let zeros;
        let texcoords: &[[f32; 2]] = match (&tables.texcoords, options.texcoords) {
            (_, false) => &[],
            (Some(texcoords), true) => texcoords,
            (None, true) => {
                zeros = vec![
                    [0.0; 2];
                    tables.plan.first_corner(PatchKind::Triangle) as usize
                        + 3 * tables.plan.count(PatchKind::Triangle) as usize
                ];
                &zeros
            }
        };
        let mut arrays: Vec<(&'static str, &[u8])> = tables.bindings().into();
        arrays.push(("texture coordinates", bytemuck::cast_slice(texcoords)));

        let mut offset = 0;
        let mut ranges = Vec::with_capacity(arrays.len());
        for (table, array) in &arrays {
            check(table, array.len() as u64)?;
            // An empty table still gets a range, so that every descriptor is written.
            let size = (array.len() as u64).max(4);
            ranges.push((offset, size));
            offset = (offset + size).next_multiple_of(ALIGNMENT);
        }
        let mut staged_tables = upload_buffer(context, &format!("{name}: tables to copy"), offset)?;
        for ((_, array), (offset, _)) in arrays.iter().zip(&ranges) {
            staged_tables.write(*offset, array)?;
        }
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let table_buffer = device_buffer(context, &format!("{name}: tables"), offset, storage)?;

        let position_bytes = 12 * tables.stored_vertices() as u64;
        check("positions", position_bytes)?;
        let positions = device_buffer(context, &format!("{name}: positions"), position_bytes, storage)?;
        let bytes = tables.control_point_bytes();
        check("control points", bytes)?;
        let control_points = match tables.construction() {
            Construction::Cached => Some(device_buffer(context, &format!("{name}: control points"), bytes, storage)?),
            _ => None,
        };
        let frames = u64::from(options.frames_in_flight);
        let staged_name = format!("{name}: positions to copy");
        let mut staged_positions = upload_buffer(context, &staged_name, position_bytes * frames)?;
        let stored = tables.stored_positions(control);
        for frame in 0..frames {
            staged_positions.write(frame * position_bytes, &stored)?;
        }
        drop(stored);

        let mut uploads = vec![(staged_tables, table_buffer.raw())];
        let control = if options.styles.iter().any(|s| s.geometry != Geometry::Surface) {
            let indices = [&tables.control_edges[..], &tables.control_faces[..]].concat();
            let bytes = 4 * indices.len() as u64;
            let mut staged = upload_buffer(context, &format!("{name}: control mesh to copy"), bytes)?;
            staged.write(0, &indices)?;
            let usage = vk::BufferUsageFlags::INDEX_BUFFER;
            let buffer = device_buffer(context, &format!("{name}: control mesh"), bytes, usage)?;
            uploads.push((staged, buffer.raw()));
            Some(ControlIndices {
                buffer,
                edges: tables.control_edges.len() as u32,
                faces: tables.control_faces.len() as u32,
                vertex_offset: tables.first_control_vertex() as i32,
            })
        } else {
            None
        };

        let (pool, set) = descriptor_set(context, pipelines.model_layout.raw(), name)?;
        write_set(context, set, &positions, &table_buffer, &ranges, control_points.as_ref());
        let ModelOptions { scheme, construction, spacing, .. } = *model_options;
        let stages = |kind| PatchStages { scheme, kind, construction, spacing };
        Ok(Self {
            id,
            stages: PatchKind::ALL.into_iter().filter(|&kind| tables.plan.count(kind) > 0).map(stages).collect(),
            tables,
            set,
            _pool: pool,
            table_buffer,
            positions,
            control_points,
            stale: false,
            staged_positions,
            dirty: vec![false; options.frames_in_flight as usize],
            control,
            uploads,
            prepared: false,
        })
    }

    pub(super) fn set_positions(&mut self, frame: u32, control: &[[f32; 3]]) -> Result<(), Error> {
        let needed = self.tables.control_vertices;
        if control.len() != needed {
            return Err(Error::PositionCount { id: self.id, given: control.len(), needed });
        }
        let stored = self.tables.stored_positions(control);
        self.staged_positions.write(u64::from(frame) * self.position_bytes(), &stored)?;
        self.dirty[frame as usize] = true;
        Ok(())
    }

    fn position_bytes(&self) -> u64 {
        12 * self.tables.stored_vertices() as u64
    }

    pub(super) fn needs_copies(&self, frame: u32) -> bool {
        self.dirty[frame as usize] || !self.prepared
    }

    /// Whether control points are to be computed in this frame.
    pub(super) fn needs_points(&self, frame: u32) -> bool {
        self.control_points.is_some() && (self.stale || self.needs_copies(frame))
    }

    /// Has the control points computed anew in the next frame, even though nothing moved.
    #[cfg(all(feature = "measure", feature = "headless"))]
    pub(super) fn forget_points(&mut self) {
        self.stale = true;
    }

    /// Records the computation of the control points.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering, after the copies; `pipelines` have those of the model's kinds.
    pub(super) unsafe fn cmd_compute(&mut self, pipelines: &CachedPipelines, cmd: vk::CommandBuffer) {
        self.stale = false;
        // SAFETY: as the caller promises.
        unsafe { pipelines.cmd_compute(cmd, self.set, &self.stages, &self.tables.plan) };
    }

    /// Records the copies that are due, and gives away the staging buffers to be kept until the frame is done.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering.
    pub(super) unsafe fn cmd_copy(&mut self, device: &ash::Device, cmd: vk::CommandBuffer, frame: u32) -> Vec<Buffer> {
        let copy = |from: vk::Buffer, src_offset: u64, to: vk::Buffer, size: u64| {
            let region = vk::BufferCopy { src_offset, dst_offset: 0, size };
            // SAFETY: as the caller promises; both buffers hold the range.
            unsafe { device.cmd_copy_buffer(cmd, from, to, &[region]) };
        };
        let bytes = self.position_bytes();
        // Before the first copy every frame's region holds the first positions, or newer ones.
        if std::mem::take(&mut self.dirty[frame as usize]) || !self.prepared {
            copy(self.staged_positions.raw(), u64::from(frame) * bytes, self.positions.raw(), bytes);
        }
        let uploads = std::mem::take(&mut self.uploads);
        for (staged, target) in &uploads {
            copy(staged.raw(), 0, *target, staged.size());
        }
        self.prepared = true;
        uploads.into_iter().map(|(staged, _)| staged).collect()
    }

    pub(super) fn add_memory(&self, usage: &mut MemoryUsage) {
        usage.tables += self.table_buffer.size();
        usage.control_points += self.control_points.as_ref().map_or(0, Buffer::size);
        usage.positions += self.positions.size();
        usage.control_meshes += self.control.as_ref().map_or(0, |c| c.buffer.size());
        let uploads: u64 = self.uploads.iter().map(|(buffer, _)| buffer.size()).sum();
        usage.staging += self.staged_positions.size() + uploads;
    }
}

fn upload_buffer(context: &Arc<DeviceContext>, name: &str, size: u64) -> Result<Buffer, GpuError> {
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    Buffer::new(context, &BufferDesc { name, size, usage, location: MemoryLocation::Upload })
}

fn device_buffer(
    context: &Arc<DeviceContext>,
    name: &str,
    size: u64,
    usage: vk::BufferUsageFlags,
) -> Result<Buffer, GpuError> {
    let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
    Buffer::new(context, &BufferDesc { name, size, usage, location: MemoryLocation::DeviceLocal })
}

fn descriptor_set(
    context: &Arc<DeviceContext>,
    layout: vk::DescriptorSetLayout,
    name: &str,
) -> Result<(Owned<vk::DescriptorPool>, vk::DescriptorSet), GpuError> {
    let sizes =
        [vk::DescriptorPoolSize { ty: vk::DescriptorType::STORAGE_BUFFER, descriptor_count: MODEL_BINDINGS as u32 }];
    let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
    let layouts = [layout];
    // SAFETY: the pool is taken over by `Owned` and has room for the set.
    unsafe {
        let pool = context.device().create_descriptor_pool(&info, None).of("vkCreateDescriptorPool", name)?;
        let pool = Owned::new(context, pool, name);
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool.raw()).set_layouts(&layouts);
        let sets = context.device().allocate_descriptor_sets(&info).of("vkAllocateDescriptorSets", name)?;
        context.set_name(sets[0], name);
        Ok((pool, sets[0]))
    }
}

fn write_set(
    context: &DeviceContext,
    set: vk::DescriptorSet,
    positions: &Buffer,
    tables: &Buffer,
    ranges: &[(u64, u64)],
    control_points: Option<&Buffer>,
) {
    let mut infos = vec![positions.descriptor()];
    infos.extend(ranges.iter().map(|&(offset, range)| vk::DescriptorBufferInfo {
        buffer: tables.raw(),
        offset,
        range,
    }));
    if let Some(control_points) = control_points {
        infos[CONTROL_POINTS] = control_points.descriptor();
    }
    let writes: Vec<_> = (0..)
        .zip(infos.chunks(1))
        .map(|(binding, info)| {
            vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(binding)
                .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                .buffer_info(info)
        })
        .collect();
    // SAFETY: the set is new, and the buffers live as long as it.
    unsafe { context.device().update_descriptor_sets(&writes, &[]) };
}
