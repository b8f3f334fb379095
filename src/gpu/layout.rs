use std::sync::Arc;

use ash::vk;

use super::{DeviceContext, GpuError, Owned, VkResultExt};

/// A descriptor set layout with one descriptor at each of the bindings 0, 1, ...
pub fn descriptor_set_layout(
    context: &Arc<DeviceContext>,
    name: &str,
    bindings: &[(vk::DescriptorType, vk::ShaderStageFlags)],
) -> Result<Owned<vk::DescriptorSetLayout>, GpuError> {
    let bindings: Vec<_> = (0..)
        .zip(bindings)
        .map(|(binding, &(descriptor, stages))| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(binding)
                .descriptor_type(descriptor)
                .descriptor_count(1)
                .stage_flags(stages)
        })
        .collect();
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
    // SAFETY: the description is valid, and the layout is taken over by `Owned`.
    unsafe {
        let raw = context.device().create_descriptor_set_layout(&info, None).of("vkCreateDescriptorSetLayout", name)?;
        Ok(Owned::new(context, raw, name))
    }
}

/// A pipeline layout, either for graphics or for compute.
///
/// Push constants for both at once are refused: **lavapipe bug D** (Mesa's llvmpipe driver, seen in 22.3.6) crashes in
/// `vkCmdPushConstants` with `COMPUTE` among the stages while no compute pipeline is bound.
///
/// # Safety
///
/// The set layouts are of this device.
pub unsafe fn pipeline_layout(
    context: &Arc<DeviceContext>,
    name: &str,
    set_layouts: &[vk::DescriptorSetLayout],
    push_constants: &[vk::PushConstantRange],
) -> Result<Owned<vk::PipelineLayout>, GpuError> {
    let compute = |range: &vk::PushConstantRange| range.stage_flags.contains(vk::ShaderStageFlags::COMPUTE);
    let graphics = |range: &vk::PushConstantRange| range.stage_flags != vk::ShaderStageFlags::COMPUTE;
    if push_constants.iter().any(compute) && push_constants.iter().any(graphics) {
        let message = "push constants for compute and for graphics: make two layouts".to_owned();
        return Err(GpuError::BadPipeline { object: name.to_owned(), message });
    }
    let max = context.properties().max_push_constants;
    if let Some(end) = push_constants.iter().map(|r| r.offset.saturating_add(r.size)).find(|&end| end > max) {
        let why = format!("push constants up to byte {end}: the device has {max}");
        return Err(GpuError::Unsupported { object: name.to_owned(), why });
    }
    let info = vk::PipelineLayoutCreateInfo::default().set_layouts(set_layouts).push_constant_ranges(push_constants);
    // SAFETY: as the caller promises; the layout is taken over by `Owned`.
    unsafe {
        let raw = context.device().create_pipeline_layout(&info, None).of("vkCreatePipelineLayout", name)?;
        Ok(Owned::new(context, raw, name))
    }
}
