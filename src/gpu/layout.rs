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

/// A descriptor set, with a pool of its own that goes with it.
#[derive(Debug)]
pub struct DescriptorSet {
    raw: vk::DescriptorSet,
    _pool: Owned<vk::DescriptorPool>,
}

impl DescriptorSet {
    /// A set with nothing in it, whose layout has so many descriptors of each type.
    ///
    /// # Safety
    ///
    /// The layout is of this device, and has these descriptors.
    pub unsafe fn new(
        context: &Arc<DeviceContext>,
        layout: vk::DescriptorSetLayout,
        name: &str,
        descriptors: &[(vk::DescriptorType, u32)],
    ) -> Result<Self, GpuError> {
        let size = |&(ty, descriptor_count): &(_, _)| vk::DescriptorPoolSize { ty, descriptor_count };
        let sizes: Vec<_> = descriptors.iter().map(size).collect();
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        let (device, layouts) = (context.device(), [layout]);
        // SAFETY: as the caller promises; the pool is taken over by `Owned` and has room for the set.
        unsafe {
            let pool = device.create_descriptor_pool(&info, None).of("vkCreateDescriptorPool", name)?;
            let pool = Owned::new(context, pool, name);
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool.raw()).set_layouts(&layouts);
            let sets = device.allocate_descriptor_sets(&info).of("vkAllocateDescriptorSets", name)?;
            context.set_name(sets[0], name);
            Ok(Self { raw: sets[0], _pool: pool })
        }
    }

    /// A set with parts of buffers at the bindings 0, 1, ...
    ///
    /// # Safety
    ///
    /// The layout is of this device, and has these descriptors. The buffers live as long as the set is used.
    pub unsafe fn of_buffers(
        context: &Arc<DeviceContext>,
        layout: vk::DescriptorSetLayout,
        name: &str,
        buffers: &[(vk::DescriptorType, vk::DescriptorBufferInfo)],
    ) -> Result<Self, GpuError> {
        let descriptors: Vec<_> = buffers.iter().map(|&(ty, _)| (ty, 1)).collect();
        // SAFETY: as the caller promises.
        let set = unsafe { Self::new(context, layout, name, &descriptors)? };
        let writes: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, (ty, buffer))| {
                vk::WriteDescriptorSet::default()
                    .dst_set(set.raw)
                    .dst_binding(binding)
                    .descriptor_type(*ty)
                    .buffer_info(std::slice::from_ref(buffer))
            })
            .collect();
        // SAFETY: as the caller promises; the set is new.
        unsafe { context.device().update_descriptor_sets(&writes, &[]) };
        Ok(set)
    }

    /// The handle.
    pub fn raw(&self) -> vk::DescriptorSet {
        self.raw
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
