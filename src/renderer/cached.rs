//! What a frame makes before its draws: the control points of the cached construction, by compute, and what follows from them.

use super::Renderer;
use super::model::Model;
use super::stages::PatchStages;
use crate::gpu::{
    ComputePipelineDesc, DeviceContext, GpuError, Owned, Shader, Specialization, pipeline_layout, shaders,
};
use crate::table::{PatchGroup, PatchPlan};
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::collections::HashMap;
use std::sync::Arc;

/// Invocations in a workgroup of `glsl/compute/control_points.comp`.
const GROUP: u32 = 64;
/// Every Vulkan device has as many workgroups along an axis.
const MAX_GROUPS: u32 = 65_535;

/// The corners of the patches of a group, as push constants. GLSL twin: `Patches` in `glsl/lib/control_points.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Corners {
    first_patch: u32,
    first_corner: u32,
    corners: u32,
    pub invocations: u32,
}

impl Corners {
    pub(super) fn new(group: &PatchGroup) -> Self {
        let corners = group.kind.corners() as u32;
        Self {
            first_patch: group.patches.start as u32,
            first_corner: group.first_corner as u32,
            corners,
            invocations: group.patches.len() as u32 * corners,
        }
    }
}

/// Pipelines by [`PatchStages::cached_key`].
pub(super) struct CachedPipelines {
    context: Arc<DeviceContext>,
    layout: Owned<vk::PipelineLayout>,
    cache: vk::PipelineCache,
    made: HashMap<[u32; 2], Owned<vk::Pipeline>>,
}

impl CachedPipelines {
    /// With the set layouts of the draws.
    pub(super) fn new(
        context: &Arc<DeviceContext>,
        sets: [vk::DescriptorSetLayout; 2],
        cache: vk::PipelineCache,
    ) -> Result<Self, GpuError> {
        let size = size_of::<Corners>() as u32;
        let constants = [vk::PushConstantRange { stage_flags: vk::ShaderStageFlags::COMPUTE, offset: 0, size }];
        // SAFETY: the set layouts are of this device.
        let layout = unsafe { pipeline_layout(context, "subdiv control points", &sets, &constants)? };
        Ok(Self { context: context.clone(), layout, cache, made: HashMap::new() })
    }

    /// Makes what patches need.
    pub(super) fn make(&mut self, stages: PatchStages) -> Result<(), GpuError> {
        let key = stages.cached_key();
        if self.made.contains_key(&key) {
            return Ok(());
        }
        let [owned, stride] = key;
        let name = format!("COMPUTE_CONTROL_POINTS_COMP_OWNED_{owned}");
        let stride = [Specialization::uint(3, stride)];
        let desc = ComputePipelineDesc {
            name: &format!("subdiv control points, {owned} a corner"),
            layout: self.layout.raw(),
            shader: Shader::compute(shaders::named(&name)?).specialized(&stride),
            cache: self.cache,
        };
        // SAFETY: the shader is ours and matches the layout.
        let pipeline = unsafe { desc.create(&self.context)? };
        self.made.insert(key, pipeline);
        Ok(())
    }

    /// Records the dispatches for all patches of a model, whose set this is.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering; the pipelines of `stages` were made.
    pub(super) unsafe fn cmd_compute(
        &self,
        cmd: vk::CommandBuffer,
        set: vk::DescriptorSet,
        stages: &[PatchStages],
        plan: &PatchPlan,
    ) {
        let (device, layout) = (self.context.device(), self.layout.raw());
        let point = vk::PipelineBindPoint::COMPUTE;
        // SAFETY: as the caller promises.
        unsafe { device.cmd_bind_descriptor_sets(cmd, point, layout, 1, &[set], &[]) };
        for (&stages, group) in stages.iter().zip(plan.groups()) {
            let Some(pipeline) = self.made.get(&stages.cached_key()) else { continue };
            let corners = Corners::new(group);
            let groups = corners.invocations.div_ceil(GROUP);
            let rows = groups.div_ceil(MAX_GROUPS);
            // SAFETY: as the caller promises.
            unsafe {
                device.cmd_bind_pipeline(cmd, point, pipeline.raw());
                let stage = vk::ShaderStageFlags::COMPUTE;
                device.cmd_push_constants(cmd, layout, stage, 0, bytemuck::bytes_of(&corners));
                device.cmd_dispatch(cmd, groups.div_ceil(rows), rows, 1);
            }
        }
    }
}

impl Renderer {
    /// Records what makes control points, and vertices where they are evaluated by compute, for draws to read them.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering, after the copies and the barrier that follows them. That and the one
    /// before the copies have the computation wait for what read the points before.
    pub(super) unsafe fn cmd_compute(&mut self, cmd: vk::CommandBuffer) {
        let readers = self.shader_readers();
        let Self { models, pipelines, context, .. } = self;
        if !models.values().any(Model::is_stale) {
            return;
        }
        for model in models.values_mut().filter(|model| model.is_stale()) {
            // SAFETY: as the caller promises; every pipeline of a model's kinds was made when it was added.
            unsafe { model.cmd_construct(pipelines, cmd) };
        }
        use vk::PipelineStageFlags as Stage;
        let makers = readers & (Stage::COMPUTE_SHADER | Stage::GEOMETRY_SHADER);
        let written = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(vk::AccessFlags::SHADER_READ)];
        let none = vk::DependencyFlags::empty();
        let device = context.device();
        // SAFETY: as the caller promises.
        unsafe { device.cmd_pipeline_barrier(cmd, makers, readers, none, &written, &[], &[]) };
        for model in models.values_mut().filter(|model| model.is_stale()) {
            // SAFETY: as above, after the control points.
            unsafe { model.cmd_evaluate(&pipelines.lattice, cmd) };
        }
        let evaluated = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(vk::AccessFlags::VERTEX_ATTRIBUTE_READ)];
        // SAFETY: as the caller promises.
        unsafe {
            device.cmd_pipeline_barrier(cmd, makers, Stage::VERTEX_INPUT, none, &evaluated, &[], &[]);
        }
    }

    /// Has a model's control points and vertices made anew in the next frame: the bench times them.
    #[cfg(all(feature = "measure", feature = "headless"))]
    pub(crate) fn forget_control_points(&mut self, id: super::ModelId) -> Result<(), super::Error> {
        self.models.get_mut(&id).ok_or(super::Error::NoSuchModel { id })?.forget_points();
        Ok(())
    }
}
