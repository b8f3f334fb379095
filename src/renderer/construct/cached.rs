//! The cached construction: frames of rings, and from these control points, by compute.

use crate::gpu::{DeviceContext, GpuError};
use crate::renderer::pipelines::{ComputePipelines, workgroups};
use crate::renderer::shader::{Cut, PatchStages, ShaderCode, reads_texels};
use crate::renderer::shader::{ShaderKey, Source};
use crate::table::{PatchPlan, Refinement, RefinementStep};
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;

/// Push constants. GLSL twin: `glsl/lib/draw/invocation.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Default, Pod, Zeroable)]
struct Invocations {
    count: u32,
    /// Of the corners of the patches, or of the rows.
    first: u32,
    /// The vertex that the first of all rows makes.
    first_vertex: u32,
    /// The block of the first row.
    first_block: u32,
    rows_of_block: u32,
}

/// What pipelines are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Step {
    /// Vertices of adaptive subdivision.
    Refine,
    Frames {
        /// Whether rings may have pentagons.
        pentagons: bool,
    },
    /// By [`PatchStages::for_control_points`].
    Points(PatchStages),
}

impl Step {
    fn frames(stages: PatchStages) -> Self {
        Self::Frames { pentagons: stages.scheme.has_pentagons() }
    }
}

/// The pipelines of the cached construction.
pub(crate) struct CachedPipelines(ComputePipelines<Step, Invocations>);

impl CachedPipelines {
    /// With the set layouts of the draws.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        sets: [vk::DescriptorSetLayout; 2],
        cache: vk::PipelineCache,
    ) -> Result<Self, GpuError> {
        ComputePipelines::new(context, "subdiv control points", &sets, cache).map(Self)
    }

    /// Makes what patches need.
    pub(crate) fn make(&mut self, stages: PatchStages, code: &ShaderCode) -> Result<(), GpuError> {
        let stages = stages.for_control_points();
        let constants = stages.specialization(Cut::default(), self.0.context().properties());
        self.0.make(Step::frames(stages), ShaderKey::of(Source::FramesComp), code, &constants)?;
        self.0.make(Step::Points(stages), stages.control_points(), code, &constants)
    }

    /// Makes what adaptive surfaces need.
    pub(crate) fn make_refinement(&mut self, code: &ShaderCode) -> Result<(), GpuError> {
        let constants = [reads_texels(self.0.context().properties())];
        self.0.make(Step::Refine, ShaderKey::of(Source::RefineComp), code, &constants)
    }

    /// Records the dispatches that make the vertices of adaptive subdivision, step by step; `set` is the model's.
    ///
    /// # Safety
    /// As [`CachedPipelines::cmd_frames`]; the control vertices are there.
    pub(crate) unsafe fn cmd_refine(&self, cmd: vk::CommandBuffer, set: vk::DescriptorSet, refinement: &Refinement) {
        let device = self.0.context().device();
        let made = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE)];
        let (stage, none) = (vk::PipelineStageFlags::COMPUTE_SHADER, vk::DependencyFlags::empty());
        // SAFETY: as the caller promises.
        unsafe {
            self.0.cmd_bind(cmd, 1, &[set], &[]);
            for RefinementStep { rows, first_block, rows_of_block } in refinement.steps.iter().cloned() {
                let (count, first) = (rows.len() as u32, rows.start);
                let first_vertex = refinement.first_vertex;
                let invocations = Invocations { count, first, first_vertex, first_block, rows_of_block };
                self.cmd_dispatch(cmd, Step::Refine, invocations);
                device.cmd_pipeline_barrier(cmd, stage, stage, none, &made, &[], &[]);
            }
        }
    }

    /// Records the dispatch for so many rings of a model, whose set this is.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering; the pipelines of `stages` were made.
    pub(crate) unsafe fn cmd_frames(
        &self,
        cmd: vk::CommandBuffer,
        set: vk::DescriptorSet,
        stages: &[PatchStages],
        rings: u32,
    ) {
        let Some(&stages) = stages.first().filter(|_| rings > 0) else { return };
        // SAFETY: as the caller promises.
        unsafe {
            self.0.cmd_bind(cmd, 1, &[set], &[]);
            self.cmd_dispatch(cmd, Step::frames(stages), Invocations { count: rings, ..Invocations::default() });
        }
    }

    /// Records the dispatches for all patches of a model, whose set this is.
    ///
    /// # Safety
    /// As [`CachedPipelines::cmd_frames`]; the frames are there.
    pub(crate) unsafe fn cmd_points(
        &self,
        cmd: vk::CommandBuffer,
        set: vk::DescriptorSet,
        stages: &[PatchStages],
        plan: &PatchPlan,
    ) {
        // SAFETY: as the caller promises.
        unsafe { self.0.cmd_bind(cmd, 1, &[set], &[]) };
        for (&stages, group) in stages.iter().zip(plan.groups()) {
            let invocations = Invocations {
                count: group.patches.len() as u32,
                first: group.first_corner as u32,
                ..Invocations::default()
            };
            // SAFETY: as the caller promises.
            unsafe { self.cmd_dispatch(cmd, Step::Points(stages.for_control_points()), invocations) };
        }
    }

    unsafe fn cmd_dispatch(&self, cmd: vk::CommandBuffer, step: Step, invocations: Invocations) {
        // SAFETY: as the caller promises.
        unsafe { self.0.cmd_dispatch(cmd, &step, &invocations, workgroups(invocations.count)) };
    }
}
