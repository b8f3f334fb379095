use std::sync::Arc;

use ash::vk;

use super::{DeviceContext, GpuError, Owned, VkResultExt};

/// A descriptor set layout, and its bindings.
#[derive(Debug)]
pub struct SetLayout {
    raw: Owned<vk::DescriptorSetLayout>,
    bindings: Vec<(vk::DescriptorType, vk::ShaderStageFlags)>,
}

impl SetLayout {
    /// The handle.
    pub fn raw(&self) -> vk::DescriptorSetLayout {
        self.raw.raw()
    }

    /// The type of the descriptor at each of the bindings 0, 1, ..., and the stages that see it.
    pub fn bindings(&self) -> &[(vk::DescriptorType, vk::ShaderStageFlags)] {
        &self.bindings
    }
}

/// A descriptor set layout with one descriptor at each of the bindings 0, 1, ...
pub fn descriptor_set_layout(
    context: &Arc<DeviceContext>,
    name: &str,
    bindings: &[(vk::DescriptorType, vk::ShaderStageFlags)],
) -> Result<SetLayout, GpuError> {
    let described: Vec<_> = (0..)
        .zip(bindings)
        .map(|(binding, &(descriptor, stages))| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(binding)
                .descriptor_type(descriptor)
                .descriptor_count(1)
                .stage_flags(stages)
        })
        .collect();
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&described);
    // SAFETY: the description is valid, and the layout is taken over by `Owned`.
    unsafe {
        let raw = context.device().create_descriptor_set_layout(&info, None).of("vkCreateDescriptorSetLayout", name)?;
        #[cfg(all(test, feature = "headless"))]
        demand::set_made(raw, bindings);
        Ok(SetLayout { raw: Owned::new(context, raw, name), bindings: bindings.to_vec() })
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
        #[cfg(all(test, feature = "headless"))]
        demand::layout_made(set_layouts);
        Ok(Owned::new(context, raw, name))
    }
}

/// Storage buffers that the pipeline layouts made by this thread demand of a shader stage.
#[cfg(all(test, feature = "headless"))]
pub(crate) mod demand {
    use ash::vk;
    use std::cell::{Cell, RefCell};
    use std::collections::HashMap;

    type Bindings = Vec<(vk::DescriptorType, vk::ShaderStageFlags)>;

    thread_local! {
        static SETS: RefCell<HashMap<vk::DescriptorSetLayout, Bindings>> = RefCell::default();
        static MOST: Cell<u32> = const { Cell::new(0) };
    }

    pub(super) fn set_made(layout: vk::DescriptorSetLayout, bindings: &[(vk::DescriptorType, vk::ShaderStageFlags)]) {
        SETS.with_borrow_mut(|sets| sets.insert(layout, bindings.to_vec()));
    }

    pub(super) fn layout_made(sets: &[vk::DescriptorSetLayout]) {
        let bindings: Bindings = SETS.with_borrow(|known| sets.iter().flat_map(|set| known[set].clone()).collect());
        for stage in (0..32).map(|bit| vk::ShaderStageFlags::from_raw(1 << bit)) {
            let counts = |&&(ty, stages): &&(vk::DescriptorType, vk::ShaderStageFlags)| {
                use vk::DescriptorType as Type;
                stages.contains(stage) && matches!(ty, Type::STORAGE_BUFFER | Type::STORAGE_BUFFER_DYNAMIC)
            };
            let count = bindings.iter().filter(counts).count() as u32;
            MOST.set(MOST.get().max(count));
        }
    }

    /// The most of any stage so far.
    pub(crate) fn most() -> u32 {
        MOST.get()
    }
}
