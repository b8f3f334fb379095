//! Compute pipelines of one layout, made when they are needed.

use crate::constants::GROUP_INVOCATIONS;
use crate::gpu::{
    ComputePipelineDesc, DeviceContext, GpuError, MAX_WORKGROUPS, Owned, Shader, Specialization, pipeline_layout,
};
use crate::renderer::shader::ShaderCode;
use crate::renderer::shader::{ShaderId, ShaderKey};
use ash::vk;
use bytemuck::Pod;
use rustc_hash::FxHashMap;
use std::hash::Hash;
use std::marker::PhantomData;
use std::sync::Arc;

/// Workgroups for so many invocations, in rows. GLSL twin: `glsl/lib/draw/invocation.glsl`.
pub(crate) fn workgroups(invocations: u32) -> [u32; 2] {
    let groups = invocations.div_ceil(GROUP_INVOCATIONS);
    let rows = groups.div_ceil(MAX_WORKGROUPS).max(1);
    [groups.div_ceil(rows), rows]
}

/// Compute pipelines by what they are for, with push constants of type `P`.
pub(crate) struct ComputePipelines<K, P> {
    context: Arc<DeviceContext>,
    layout: Owned<vk::PipelineLayout>,
    cache: vk::PipelineCache,
    made: FxHashMap<K, Owned<vk::Pipeline>>,
    _constants: PhantomData<P>,
}

impl<K: Eq + Hash, P: Pod> ComputePipelines<K, P> {
    /// With these set layouts, which are of the device.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        name: &str,
        sets: &[vk::DescriptorSetLayout],
        cache: vk::PipelineCache,
    ) -> Result<Self, GpuError> {
        let size = size_of::<P>() as u32;
        let constants = [vk::PushConstantRange { stage_flags: vk::ShaderStageFlags::COMPUTE, offset: 0, size }];
        // SAFETY: as the caller promises.
        let layout = unsafe { pipeline_layout(context, name, sets, &constants)? };
        Ok(Self { context: context.clone(), layout, cache, made: FxHashMap::default(), _constants: PhantomData })
    }

    pub(crate) fn context(&self) -> &Arc<DeviceContext> {
        &self.context
    }

    /// Makes one of the shader of this name, if there is none yet.
    pub(crate) fn make(
        &mut self,
        key: K,
        shader: ShaderKey,
        code: &ShaderCode,
        constants: &[Specialization],
    ) -> Result<(), GpuError> {
        if self.made.contains_key(&key) {
            return Ok(());
        }
        let desc = ComputePipelineDesc {
            name: &format!("subdiv {}", shader.id().map_or("shader", ShaderId::name)),
            layout: self.layout.raw(),
            shader: Shader::compute(code.find(shader)?).specialized(constants),
            cache: self.cache,
        };
        // SAFETY: the shader is ours and matches the layout.
        let pipeline = unsafe { desc.create(&self.context)? };
        self.made.insert(key, pipeline);
        Ok(())
    }

    /// Binds descriptor sets from this one on.
    ///
    /// # Safety
    /// `cmd` is being recorded; the sets fit the layout, and the offsets the sets.
    pub(crate) unsafe fn cmd_bind(
        &self,
        cmd: vk::CommandBuffer,
        first: u32,
        sets: &[vk::DescriptorSet],
        offsets: &[u32],
    ) {
        let (point, layout) = (vk::PipelineBindPoint::COMPUTE, self.layout.raw());
        // SAFETY: as the caller promises.
        unsafe { self.context.device().cmd_bind_descriptor_sets(cmd, point, layout, first, sets, offsets) };
    }

    /// Records a dispatch of so many workgroups. Nothing if the pipeline was not made.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering, with the sets bound; the constants say nothing that the shader may not read
    /// or write.
    pub(crate) unsafe fn cmd_dispatch(&self, cmd: vk::CommandBuffer, key: &K, constants: &P, [x, y]: [u32; 2]) {
        let Some(pipeline) = self.made.get(key) else { return };
        let (device, stage) = (self.context.device(), vk::ShaderStageFlags::COMPUTE);
        // SAFETY: as the caller promises.
        unsafe {
            device.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::COMPUTE, pipeline.raw());
            device.cmd_push_constants(cmd, self.layout.raw(), stage, 0, bytemuck::bytes_of(constants));
            device.cmd_dispatch(cmd, x, y, 1);
        }
    }
}
