//! Evaluation on a uniform grid: its indices; by compute, pipelines, vertices and dispatches.

use super::indices::{IndexCache, PatchIndices, SharedIndices, UniformGridShape};
use super::recorder::Recorder;
use crate::constants::{GROUP_VERTICES, ID_HAS_TEXCOORDS};
use crate::gpu::Specialization;
use crate::gpu::{Buffer, DescriptorSet, DeviceContext, GpuError, MAX_WORKGROUPS};
use crate::renderer::options::{EVALUATED_VERTICES, Error, MemoryUsage, ModelId};
use crate::renderer::pipelines::{ComputePipelines, vertex_bytes};
use crate::renderer::shader::{Cut, Output, PatchStages, SetLayouts, ShaderCode, Source};
use crate::table::{Evaluation, Sharing};
use crate::table::{PatchGroup, PatchPlan, uniform_grid_vertices};
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;

/// About as many evaluated vertices are drawn with the same indices, of one patch at least.
const BLOCK_VERTICES: u64 = 65_536;

/// The push constants of a dispatch. GLSL twin: `Patches` in `glsl/evaluate/uniform_grid.comp`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Dispatch {
    first_patch: u32,
    first_corner: u32,
    first_vertex: u32,
    segments: u32,
    vertices: u32,
}

/// Pipelines by what they evaluate.
pub(crate) struct UniformGridPipelines {
    sets: Arc<SetLayouts>,
    texcoords: bool,
    indices: IndexCache,
    pipelines: ComputePipelines<PatchStages, Dispatch>,
}

impl UniformGridPipelines {
    /// With the set layouts of the draws. Lines show the triangles that join the rows of strips, and not as those of others:
    /// with `wireframe` there are none.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        sets: &Arc<SetLayouts>,
        cache: vk::PipelineCache,
        texcoords: bool,
        wireframe: bool,
    ) -> Result<Self, GpuError> {
        let layouts = [sets.view.raw(), sets.model.raw(), sets.vertices.raw()];
        let pipelines = ComputePipelines::new(context, "subdiv evaluation", &layouts, cache)?;
        let indices = IndexCache::new(if wireframe { u32::MAX } else { context.properties().indices_at_once });
        Ok(Self { sets: sets.clone(), texcoords, indices, pipelines })
    }

    /// Makes what patches need.
    pub(crate) fn make(&mut self, stages: PatchStages, code: &ShaderCode) -> Result<(), GpuError> {
        let constants = stages.specialization(Cut::default(), self.pipelines.context().properties());
        let texcoords = Specialization::bool(ID_HAS_TEXCOORDS, self.texcoords);
        let constants: Vec<_> = constants.into_iter().chain([texcoords]).collect();
        self.pipelines.make(stages, stages.shader(Source::UniformGridComp, Output::Surface), code, &constants)
    }
}

/// How the patches of a model are drawn with as many segments along every side.
pub(crate) struct UniformGrid {
    pub segments: u32,
    /// Those that compute evaluates.
    pub vertices: Option<UniformGridVertices>,
    pub indices: Arc<SharedIndices>,
    /// In the order of the plan.
    groups: Vec<UniformGridGroup>,
    /// Whether a frame was prepared with it.
    pub prepared: bool,
}

/// What uniform grids have bound in a command buffer since something else was.
#[derive(Default)]
pub(crate) struct BoundUniformGrid {
    indices: vk::Buffer,
    /// And from where on.
    vertices: (vk::Buffer, u64),
    topology: Option<vk::PrimitiveTopology>,
}

impl BoundUniformGrid {
    /// Binds vertices, or attributes of instances, from an offset on, unless they are bound.
    ///
    /// # Safety
    /// `cmd` is being recorded, and has this bound; the buffer is live.
    pub(crate) unsafe fn cmd_bind_vertices(
        &mut self,
        device: &ash::Device,
        cmd: vk::CommandBuffer,
        buffer: vk::Buffer,
        offset: u64,
    ) {
        if self.vertices != (buffer, offset) {
            self.vertices = (buffer, offset);
            // SAFETY: as the caller promises.
            unsafe { device.cmd_bind_vertex_buffers(cmd, 0, &[buffer], &[offset]) };
        }
    }
}

/// Evaluated vertices, group by group.
pub(crate) struct UniformGridVertices {
    pub buffer: Buffer,
    set: DescriptorSet,
}

/// Patches of one kind.
#[derive(Clone, Copy)]
struct UniformGridGroup {
    patches: u32,
    /// Vertices of a patch, and the first of all.
    vertices: u32,
    first_vertex: u32,
    indices: PatchIndices,
}

impl UniformGrid {
    pub(crate) fn new(
        pipelines: &mut UniformGridPipelines,
        id: ModelId,
        evaluation: Evaluation,
        sharing: Sharing,
        plan: &PatchPlan,
        segments: u32,
    ) -> Result<Self, Error> {
        let context = pipelines.pipelines.context();
        let computed = evaluation == Evaluation::Compute;
        let max = context.properties().max_storage_buffer_range;
        let counts = plan.groups().iter().map(|g| g.patches.len() as u64 * uniform_grid_vertices(g.kind, segments));
        let bytes = counts.sum::<u64>() * u64::from(vertex_bytes(pipelines.texcoords, sharing));
        if computed && bytes > max {
            return Err(Error::TableTooLarge { id, table: EVALUATED_VERTICES, bytes, max });
        }
        let mut shape = UniformGridShape { segments, blocks: [0; 2] };
        for group in plan.groups() {
            let most = if computed { group.patches.len() as u64 } else { 1 };
            let block = (BLOCK_VERTICES / uniform_grid_vertices(group.kind, segments)).clamp(1, most.max(1)) as u32;
            let of_kind = &mut shape.blocks[UniformGridShape::place(group.kind)];
            *of_kind = block.max(*of_kind);
        }
        let indices = pipelines.indices.get(context, shape)?;
        let mut first_vertex = 0;
        let group = |group: &PatchGroup| {
            let (kind, patches) = (group.kind, group.patches.len() as u32);
            let vertices = uniform_grid_vertices(kind, segments) as u32;
            let uniform_grid = UniformGridGroup { patches, vertices, first_vertex, indices: indices.of_patch(kind) };
            if computed {
                // What fits into the buffer can be counted by 32 bits.
                first_vertex += patches * vertices;
            }
            uniform_grid
        };
        let groups = plan.groups().iter().map(group).collect();
        let vertices = computed.then(|| UniformGridVertices::new(pipelines, bytes)).transpose()?;
        Ok(Self { segments, vertices, indices, groups, prepared: false })
    }

    /// Gives away what is to be copied to the device, with the indices that it is of, unless another model's uniform grid did; prepared by
    /// that.
    pub(crate) fn take_upload(&mut self) -> Option<(Buffer, Arc<SharedIndices>)> {
        self.prepared = true;
        self.indices.take_upload().map(|staged| (staged, self.indices.clone()))
    }

    /// Without indices.
    pub(crate) fn add_memory(&self, usage: &mut MemoryUsage) {
        usage.vertices += self.vertices.as_ref().map_or(0, |vertices| vertices.buffer.size());
    }

    /// Records the dispatches for all patches of a model, whose set and stages these are.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering, after what makes the control points; the pipelines of `stages` were
    /// made.
    pub(crate) unsafe fn cmd_evaluate(
        &self,
        pipelines: &UniformGridPipelines,
        cmd: vk::CommandBuffer,
        model: vk::DescriptorSet,
        stages: &[PatchStages],
        plan: &PatchPlan,
    ) {
        let Some(vertices) = &self.vertices else { return };
        let pipelines = &pipelines.pipelines;
        // SAFETY: as the caller promises.
        unsafe { pipelines.cmd_bind(cmd, 1, &[model, vertices.set.raw()], &[]) };
        for ((stages, group), uniform_grid) in stages.iter().zip(plan.groups()).zip(&self.groups) {
            let corners = group.kind.corners() as u32;
            for patch in (0..uniform_grid.patches).step_by(MAX_WORKGROUPS as usize) {
                let dispatch = Dispatch {
                    first_patch: group.patches.start as u32 + patch,
                    first_corner: group.first_corner as u32 + patch * corners,
                    first_vertex: uniform_grid.first_vertex + patch * uniform_grid.vertices,
                    segments: self.segments,
                    vertices: uniform_grid.vertices,
                };
                let patches = MAX_WORKGROUPS.min(uniform_grid.patches - patch);
                let groups = [patches, uniform_grid.vertices.div_ceil(GROUP_VERTICES)];
                // SAFETY: as the caller promises.
                unsafe { pipelines.cmd_dispatch(cmd, stages, &dispatch, groups) };
            }
        }
    }

    /// How many indices a patch of a group has, and the first.
    pub(crate) fn indices_of_patch(&self, group: usize) -> (u32, u32) {
        let PatchIndices { count, first, .. } = self.groups[group].indices;
        (count, first)
    }

    /// Binds what all groups are drawn from, unless it is bound.
    ///
    /// # Safety
    /// `cmd` is being recorded, and has this bound.
    pub(crate) unsafe fn cmd_bind(&self, device: &ash::Device, cmd: vk::CommandBuffer, bound: &mut BoundUniformGrid) {
        let (indices, topology) = (self.indices.buffer.raw(), self.indices.topology);
        // SAFETY: as the caller promises.
        unsafe {
            if bound.indices != indices {
                bound.indices = indices;
                device.cmd_bind_index_buffer(cmd, indices, 0, vk::IndexType::UINT32);
            }
            if let Some(vertices) = &self.vertices {
                bound.cmd_bind_vertices(device, cmd, vertices.buffer.raw(), 0);
            }
            // If nothing is drawn, the pipeline that is bound may not have it dynamic.
            if !self.groups.is_empty() && bound.topology != Some(topology) {
                bound.topology = Some(topology);
                device.cmd_set_primitive_topology(cmd, topology);
            }
        }
    }

    /// Pushes the constants, and records the draws of a group.
    ///
    /// # Safety
    /// `cmd` is being recorded, inside rendering, after [`UniformGrid::cmd_bind`], with a pipeline for it.
    pub(crate) unsafe fn cmd_draw(&self, recorder: &mut Recorder, group: usize) {
        let (device, cmd) = (recorder.device, recorder.cmd);
        let UniformGridGroup { patches, vertices, first_vertex, indices } = self.groups[group];
        let PatchIndices { count: indices, first: first_index, joint, block } = indices;
        if self.vertices.is_none() {
            // SAFETY: as the caller promises.
            recorder.cmd_draw_instances(patches, |recorder, instances| unsafe {
                recorder.push();
                device.cmd_draw_indexed(cmd, indices, instances * patches, first_index, 0, 0);
            });
            return;
        }
        recorder.cmd_draw_instances(1, |recorder, instances| {
            // SAFETY: as the caller promises.
            unsafe { recorder.push() };
            for patch in (0..patches).step_by(block as usize) {
                let count = (indices + joint) * block.min(patches - patch) - joint;
                let offset = (first_vertex + patch * vertices) as i32;
                // SAFETY: as the caller promises.
                unsafe { device.cmd_draw_indexed(cmd, count, instances, first_index, offset, 0) };
            }
        });
    }
}

impl UniformGridVertices {
    fn new(pipelines: &UniformGridPipelines, bytes: u64) -> Result<Self, GpuError> {
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::VERTEX_BUFFER | Usage::TRANSFER_SRC;
        let (context, sets) = (pipelines.pipelines.context(), &pipelines.sets);
        let buffer = Buffer::device_local(context, "subdiv vertices", bytes.max(4), usage)?;
        // SAFETY: the layout is among those of the pool, with this descriptor; the buffer goes with the set.
        let set = unsafe {
            DescriptorSet::of_buffers(&sets.pool, &sets.vertices, "subdiv vertices", &[buffer.descriptor()])?
        };
        Ok(Self { buffer, set })
    }
}
