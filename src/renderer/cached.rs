//! The cached construction: frames of rings, and from these control points, by compute.

use super::factor::Cut;
use super::pipelines::ShaderCode;
use super::stages::PatchStages;
use crate::gpu::{
    ComputePipelineDesc, DeviceContext, GpuError, MAX_WORKGROUPS, Owned, Shader, Specialization, pipeline_layout,
};
use crate::table::PatchPlan;
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::collections::HashMap;
use std::sync::Arc;

/// Invocations in a workgroup of `glsl/lib/invocation.glsl`.
const GROUP: u32 = 64;

/// Push constants. GLSL twin: `glsl/lib/invocation.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Invocations {
    count: u32,
    /// Of the patches.
    first_corner: u32,
}

/// What pipelines are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Step {
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
pub(super) struct CachedPipelines {
    context: Arc<DeviceContext>,
    layout: Owned<vk::PipelineLayout>,
    cache: vk::PipelineCache,
    made: HashMap<Step, Owned<vk::Pipeline>>,
}

impl CachedPipelines {
    /// With the set layouts of the draws.
    pub(super) fn new(
        context: &Arc<DeviceContext>,
        sets: [vk::DescriptorSetLayout; 2],
        cache: vk::PipelineCache,
    ) -> Result<Self, GpuError> {
        let size = size_of::<Invocations>() as u32;
        let constants = [vk::PushConstantRange { stage_flags: vk::ShaderStageFlags::COMPUTE, offset: 0, size }];
        // SAFETY: the set layouts are of this device.
        let layout = unsafe { pipeline_layout(context, "subdiv control points", &sets, &constants)? };
        Ok(Self { context: context.clone(), layout, cache, made: HashMap::new() })
    }

    /// Makes what patches need.
    pub(super) fn make(&mut self, stages: PatchStages, code: &ShaderCode) -> Result<(), GpuError> {
        let stages = stages.for_control_points();
        let constants = stages.specialization(Cut::default(), self.context.properties());
        self.make_one(Step::frames(stages), "COMPUTE_FRAMES_COMP", code, &constants)?;
        self.make_one(Step::Points(stages), &stages.control_points(), code, &constants)
    }

    fn make_one(
        &mut self,
        step: Step,
        shader: &str,
        code: &ShaderCode,
        constants: &[Specialization],
    ) -> Result<(), GpuError> {
        if self.made.contains_key(&step) {
            return Ok(());
        }
        let desc = ComputePipelineDesc {
            name: &format!("subdiv {shader}"),
            layout: self.layout.raw(),
            shader: Shader::compute(code.find(shader)?).specialized(constants),
            cache: self.cache,
        };
        // SAFETY: the shader is ours and matches the layout.
        let pipeline = unsafe { desc.create(&self.context)? };
        self.made.insert(step, pipeline);
        Ok(())
    }

    /// Records the dispatch for so many rings of a model, whose set this is.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering; the pipelines of `stages` were made.
    pub(super) unsafe fn cmd_frames(
        &self,
        cmd: vk::CommandBuffer,
        set: vk::DescriptorSet,
        stages: &[PatchStages],
        rings: u32,
    ) {
        let Some(&stages) = stages.first().filter(|_| rings > 0) else { return };
        // SAFETY: as the caller promises.
        unsafe {
            self.cmd_bind(cmd, set);
            self.cmd_dispatch(cmd, Step::frames(stages), Invocations { count: rings, first_corner: 0 });
        }
    }

    /// Records the dispatches for all patches of a model, whose set this is.
    ///
    /// # Safety
    /// As [`CachedPipelines::cmd_frames`]; the frames are there.
    pub(super) unsafe fn cmd_points(
        &self,
        cmd: vk::CommandBuffer,
        set: vk::DescriptorSet,
        stages: &[PatchStages],
        plan: &PatchPlan,
    ) {
        // SAFETY: as the caller promises.
        unsafe { self.cmd_bind(cmd, set) };
        for (&stages, group) in stages.iter().zip(plan.groups()) {
            let (count, first_corner) = (group.patches.len() as u32, group.first_corner as u32);
            // SAFETY: as the caller promises.
            unsafe {
                self.cmd_dispatch(cmd, Step::Points(stages.for_control_points()), Invocations { count, first_corner })
            };
        }
    }

    unsafe fn cmd_bind(&self, cmd: vk::CommandBuffer, set: vk::DescriptorSet) {
        let point = vk::PipelineBindPoint::COMPUTE;
        // SAFETY: as the caller promises.
        unsafe { self.context.device().cmd_bind_descriptor_sets(cmd, point, self.layout.raw(), 1, &[set], &[]) };
    }

    unsafe fn cmd_dispatch(&self, cmd: vk::CommandBuffer, step: Step, invocations: Invocations) {
        let Some(pipeline) = self.made.get(&step) else { return };
        let groups = invocations.count.div_ceil(GROUP);
        let rows = groups.div_ceil(MAX_WORKGROUPS);
        let device = self.context.device();
        // SAFETY: as the caller promises.
        unsafe {
            device.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::COMPUTE, pipeline.raw());
            let (stage, bytes) = (vk::ShaderStageFlags::COMPUTE, bytemuck::bytes_of(&invocations));
            device.cmd_push_constants(cmd, self.layout.raw(), stage, 0, bytes);
            device.cmd_dispatch(cmd, groups.div_ceil(rows), rows, 1);
        }
    }
}
