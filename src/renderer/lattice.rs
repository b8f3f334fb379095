//! Evaluation on a lattice: its indices; by compute, pipelines, vertices and dispatches.

use super::computing::ComputePipelines;
use super::error::EVALUATED_VERTICES;
use super::factor::Cut;
use super::model::{device_buffer, upload_buffer};
use super::pipelines::ShaderCode;
use super::stages::{PatchStages, Sharing};
use super::vertex_input::vertex_bytes;
use super::{Capture, Error, Evaluation, MemoryUsage, ModelId};
use crate::gpu::{Buffer, DescriptorSet, DeviceContext, GpuError, MAX_WORKGROUPS, Owned, descriptor_set_layout};
use crate::table::{LatticeIndices, PatchPlan, lattice_vertices};
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;

/// Vertices of a patch that a workgroup takes. GLSL twin: `GROUP_VERTICES` in `glsl/evaluate/lattice.comp`.
const GROUP_VERTICES: u32 = 256;
/// About as many evaluated vertices are drawn with the same indices, of one patch at least.
const BLOCK_VERTICES: u64 = 65_536;

/// The push constants of a dispatch. GLSL twin: `Patches` in `glsl/evaluate/lattice.comp`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Dispatch {
    first_corner: u32,
    first_vertex: u32,
    segments: u32,
    vertices: u32,
}

/// Pipelines by what they evaluate.
pub(super) struct LatticePipelines {
    set_layout: Owned<vk::DescriptorSetLayout>,
    texcoords: bool,
    /// As of the device, if strips may be drawn.
    indices_at_once: u32,
    pipelines: ComputePipelines<PatchStages, Dispatch>,
}

impl LatticePipelines {
    /// With the set layouts of the draws. Lines show the triangles that join the rows of strips, and not as those of others:
    /// with `wireframe` there are none.
    pub(super) fn new(
        context: &Arc<DeviceContext>,
        [view, model]: [vk::DescriptorSetLayout; 2],
        cache: vk::PipelineCache,
        texcoords: bool,
        wireframe: bool,
    ) -> Result<Self, GpuError> {
        let vertices = (vk::DescriptorType::STORAGE_BUFFER, vk::ShaderStageFlags::COMPUTE);
        let set_layout = descriptor_set_layout(context, "subdiv vertices", &[vertices])?;
        let sets = [view, model, set_layout.raw()];
        let pipelines = ComputePipelines::new(context, "subdiv evaluation", &sets, cache)?;
        let indices_at_once = if wireframe { u32::MAX } else { context.properties().indices_at_once };
        Ok(Self { set_layout, texcoords, indices_at_once, pipelines })
    }

    /// Makes what patches need.
    pub(super) fn make(&mut self, stages: PatchStages, code: &ShaderCode) -> Result<(), GpuError> {
        let constants = stages.specialization(Cut::default(), self.pipelines.context().properties());
        self.pipelines.make(stages, &stages.evaluation(Capture::Off, self.texcoords), code, &constants)
    }
}

/// How the patches of a model are drawn with as many segments along every side.
pub(super) struct Lattice {
    pub segments: u32,
    /// Those that compute evaluates.
    pub vertices: Option<LatticeVertices>,
    indices: Buffer,
    /// What indices are of.
    topology: vk::PrimitiveTopology,
    /// In the order of the plan.
    groups: Vec<LatticeGroup>,
    staged: Option<Buffer>,
}

/// What lattices have bound in a command buffer since something else was.
#[derive(Default)]
pub(super) struct BoundLattice {
    /// With the vertices that go with them, if they are evaluated.
    indices: vk::Buffer,
    topology: Option<vk::PrimitiveTopology>,
}

/// Evaluated vertices, group by group.
pub(super) struct LatticeVertices {
    pub buffer: Buffer,
    set: DescriptorSet,
}

/// Patches of one kind.
#[derive(Clone, Copy)]
struct LatticeGroup {
    patches: u32,
    /// Vertices of a patch, and the first of all.
    vertices: u32,
    first_vertex: u32,
    /// Indices of a patch, those that join it to the one before in its block, and the first.
    indices: u32,
    joint: u32,
    first_index: u32,
    /// Patches that there are indices for.
    block: u32,
}

impl Lattice {
    pub(super) fn new(
        pipelines: &LatticePipelines,
        id: ModelId,
        evaluation: Evaluation,
        sharing: Sharing,
        plan: &PatchPlan,
        segments: u32,
    ) -> Result<Self, Error> {
        let context = pipelines.pipelines.context();
        let computed = evaluation == Evaluation::Compute;
        let max = context.properties().max_storage_buffer_range;
        let counts = plan.groups().iter().map(|g| g.patches.len() as u64 * lattice_vertices(g.kind, segments));
        let bytes = counts.sum::<u64>() * u64::from(vertex_bytes(pipelines.texcoords, sharing));
        if computed && bytes > max {
            return Err(Error::TableTooLarge { id, table: EVALUATED_VERTICES, bytes, max });
        }
        let kinds = plan.groups().iter().map(|group| group.kind);
        let of_patches = LatticeIndices::new(kinds, segments, pipelines.indices_at_once);
        let (mut groups, mut indices) = (Vec::new(), Vec::new());
        let mut first_vertex = 0;
        let mut blocks: [Option<(u32, u32, u32)>; 2] = [None; 2];
        for group in plan.groups() {
            let (kind, patches) = (group.kind, group.patches.len() as u32);
            let vertices = lattice_vertices(kind, segments);
            let (first_index, of_patch, block) = *blocks[usize::from(kind.is_triangular())].get_or_insert_with(|| {
                let alike = plan.groups().iter().filter(|g| g.kind.is_triangular() == kind.is_triangular());
                let most = alike.map(|g| g.patches.len() as u64).max().unwrap_or(1);
                let block = if computed { (BLOCK_VERTICES / vertices).clamp(1, most) } else { 1 };
                let (first, of_patch) = (indices.len() as u32, of_patches.of(kind, segments));
                let mut of_block = Vec::new();
                (0..block).for_each(|patch| of_patches.append(&mut of_block, &of_patch, (patch * vertices) as u32));
                indices.extend(of_block);
                (first, of_patch.len() as u32, block as u32)
            });
            let vertices = vertices as u32;
            let joint = of_patches.joint(of_patch);
            groups.push(LatticeGroup { patches, vertices, first_vertex, indices: of_patch, joint, first_index, block });
            if computed {
                // What fits into the buffer can be counted by 32 bits.
                first_vertex += patches * vertices;
            }
        }
        let vertices = computed.then(|| LatticeVertices::new(pipelines, bytes)).transpose()?;
        // A buffer of no bytes is no buffer.
        let index_bytes = (4 * indices.len() as u64).max(4);
        let mut staged = upload_buffer(context, "subdiv indices to copy", index_bytes)?;
        staged.write(0, &indices)?;
        let indices = device_buffer(context, "subdiv indices", index_bytes, vk::BufferUsageFlags::INDEX_BUFFER)?;
        Ok(Self { segments, vertices, indices, topology: topology(of_patches), groups, staged: Some(staged) })
    }

    pub(super) fn needs_copies(&self) -> bool {
        self.staged.is_some()
    }

    /// Gives away what is to be copied to the device, and whereto.
    pub(super) fn take_upload(&mut self) -> Option<(Buffer, vk::Buffer)> {
        self.staged.take().map(|staged| (staged, self.indices.raw()))
    }

    pub(super) fn add_memory(&self, usage: &mut MemoryUsage) {
        usage.vertices += self.vertices.as_ref().map_or(0, |vertices| vertices.buffer.size());
        usage.indices += self.indices.size();
        usage.staging += self.staged.as_ref().map_or(0, Buffer::size);
    }

    /// Records the dispatches for all patches of a model, whose set and stages these are.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering, after what makes the control points; the pipelines of `stages` were
    /// made.
    pub(super) unsafe fn cmd_evaluate(
        &self,
        pipelines: &LatticePipelines,
        cmd: vk::CommandBuffer,
        model: vk::DescriptorSet,
        stages: &[PatchStages],
        plan: &PatchPlan,
    ) {
        let Some(vertices) = &self.vertices else { return };
        let pipelines = &pipelines.pipelines;
        // SAFETY: as the caller promises.
        unsafe { pipelines.cmd_bind(cmd, 1, &[model, vertices.set.raw()], &[]) };
        for ((stages, group), lattice) in stages.iter().zip(plan.groups()).zip(&self.groups) {
            let corners = group.kind.corners() as u32;
            for patch in (0..lattice.patches).step_by(MAX_WORKGROUPS as usize) {
                let dispatch = Dispatch {
                    first_corner: group.first_corner as u32 + patch * corners,
                    first_vertex: lattice.first_vertex + patch * lattice.vertices,
                    segments: self.segments,
                    vertices: lattice.vertices,
                };
                let patches = MAX_WORKGROUPS.min(lattice.patches - patch);
                let groups = [patches, lattice.vertices.div_ceil(GROUP_VERTICES)];
                // SAFETY: as the caller promises.
                unsafe { pipelines.cmd_dispatch(cmd, stages, &dispatch, groups) };
            }
        }
    }

    /// How many indices a patch of a group has, and the first.
    pub(super) fn indices_of_patch(&self, group: usize) -> (u32, u32) {
        (self.groups[group].indices, self.groups[group].first_index)
    }

    /// Binds what all groups are drawn from, unless it is bound.
    ///
    /// # Safety
    /// `cmd` is being recorded, and has this bound.
    pub(super) unsafe fn cmd_bind(&self, device: &ash::Device, cmd: vk::CommandBuffer, bound: &mut BoundLattice) {
        // SAFETY: as the caller promises.
        unsafe {
            if bound.indices != self.indices.raw() {
                bound.indices = self.indices.raw();
                device.cmd_bind_index_buffer(cmd, self.indices.raw(), 0, vk::IndexType::UINT32);
                if let Some(vertices) = &self.vertices {
                    device.cmd_bind_vertex_buffers(cmd, 0, &[vertices.buffer.raw()], &[0]);
                }
            }
            // If nothing is drawn, the pipeline that is bound may not have it dynamic.
            if !self.groups.is_empty() && bound.topology != Some(self.topology) {
                bound.topology = Some(self.topology);
                device.cmd_set_primitive_topology(cmd, self.topology);
            }
        }
    }

    /// Records the draws of a group.
    ///
    /// # Safety
    /// `cmd` is being recorded, inside rendering, after [`Lattice::cmd_bind`], with a pipeline for it.
    pub(super) unsafe fn cmd_draw(&self, device: &ash::Device, cmd: vk::CommandBuffer, group: usize) {
        let LatticeGroup { patches, vertices, first_vertex, indices, joint, first_index, block } = self.groups[group];
        if self.vertices.is_none() {
            // SAFETY: as the caller promises.
            unsafe { device.cmd_draw_indexed(cmd, indices, patches, first_index, 0, 0) };
            return;
        }
        for patch in (0..patches).step_by(block as usize) {
            let count = (indices + joint) * block.min(patches - patch) - joint;
            let offset = (first_vertex + patch * vertices) as i32;
            // SAFETY: as the caller promises.
            unsafe { device.cmd_draw_indexed(cmd, count, 1, first_index, offset, 0) };
        }
    }
}

/// What indices are drawn as.
pub(crate) fn topology(of: LatticeIndices) -> vk::PrimitiveTopology {
    match of {
        LatticeIndices::List => vk::PrimitiveTopology::TRIANGLE_LIST,
        LatticeIndices::Strip => vk::PrimitiveTopology::TRIANGLE_STRIP,
    }
}

impl LatticeVertices {
    fn new(pipelines: &LatticePipelines, bytes: u64) -> Result<Self, GpuError> {
        use vk::BufferUsageFlags as Usage;
        let usage = Usage::STORAGE_BUFFER | Usage::VERTEX_BUFFER | Usage::TRANSFER_SRC;
        let (context, layout) = (pipelines.pipelines.context(), pipelines.set_layout.raw());
        let buffer = device_buffer(context, "subdiv vertices", bytes.max(4), usage)?;
        let parts = [(vk::DescriptorType::STORAGE_BUFFER, buffer.descriptor())];
        // SAFETY: the layout is of this device, with this descriptor; the buffer goes with the set.
        let set = unsafe { DescriptorSet::of_buffers(context, layout, "subdiv vertices", &parts)? };
        Ok(Self { buffer, set })
    }
}
