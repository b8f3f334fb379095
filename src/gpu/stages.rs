use std::sync::Arc;

use ash::vk;

use super::{DeviceContext, GpuError, Owned, VkResultExt};

/// A specialization constant: its `constant_id`, and its value as 32 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Specialization {
    /// The `constant_id`.
    pub id: u32,
    /// The value, as Vulkan copies it.
    pub bits: u32,
}

impl Specialization {
    /// A `uint`.
    pub fn uint(id: u32, value: u32) -> Self {
        Self { id, bits: value }
    }

    /// An `int`.
    pub fn int(id: u32, value: i32) -> Self {
        Self { id, bits: value.cast_unsigned() }
    }

    /// A `float`.
    pub fn float(id: u32, value: f32) -> Self {
        Self { id, bits: value.to_bits() }
    }

    /// A `bool`.
    pub fn bool(id: u32, value: bool) -> Self {
        Self { id, bits: value.into() }
    }
}

/// One shader stage of a pipeline; its entry point is `main`.
#[derive(Debug, Clone, Copy)]
pub struct Shader<'a> {
    /// Just one.
    pub stage: vk::ShaderStageFlags,
    /// SPIR-V words.
    pub code: &'a [u32],
    /// Values for constants of the code; those not named keep their default.
    pub specialization: &'a [Specialization],
}

impl<'a> Shader<'a> {
    /// A stage without specialization constants.
    pub fn new(stage: vk::ShaderStageFlags, code: &'a [u32]) -> Self {
        Self { stage, code, specialization: &[] }
    }

    /// The vertex stage.
    pub fn vertex(code: &'a [u32]) -> Self {
        Self::new(vk::ShaderStageFlags::VERTEX, code)
    }

    /// The tessellation control stage.
    pub fn tess_control(code: &'a [u32]) -> Self {
        Self::new(vk::ShaderStageFlags::TESSELLATION_CONTROL, code)
    }

    /// The tessellation evaluation stage.
    pub fn tess_evaluation(code: &'a [u32]) -> Self {
        Self::new(vk::ShaderStageFlags::TESSELLATION_EVALUATION, code)
    }

    /// The geometry stage.
    pub fn geometry(code: &'a [u32]) -> Self {
        Self::new(vk::ShaderStageFlags::GEOMETRY, code)
    }

    /// The fragment stage.
    pub fn fragment(code: &'a [u32]) -> Self {
        Self::new(vk::ShaderStageFlags::FRAGMENT, code)
    }

    /// The compute stage.
    pub fn compute(code: &'a [u32]) -> Self {
        Self::new(vk::ShaderStageFlags::COMPUTE, code)
    }

    /// The same shader with specialization constants.
    pub fn specialized(self, specialization: &'a [Specialization]) -> Self {
        Self { specialization, ..self }
    }
}

/// The shader modules of a pipeline while it is made.
pub(super) struct Stages<'a> {
    shaders: &'a [Shader<'a>],
    modules: Vec<Owned<vk::ShaderModule>>,
    /// For each shader, where its constants lie among 32-bit values.
    entries: Vec<Vec<vk::SpecializationMapEntry>>,
    values: Vec<Vec<u32>>,
}

impl<'a> Stages<'a> {
    pub fn new(context: &Arc<DeviceContext>, name: &str, shaders: &'a [Shader<'a>]) -> Result<Self, GpuError> {
        let mut stages = Self { shaders, modules: Vec::new(), entries: Vec::new(), values: Vec::new() };
        for shader in shaders {
            let info = vk::ShaderModuleCreateInfo::default().code(shader.code);
            // SAFETY: the SPIR-V is valid (contract of `create`), and the module is taken over by `Owned`.
            let module = unsafe {
                let module = context.device().create_shader_module(&info, None).of("vkCreateShaderModule", name)?;
                Owned::new(context, module, &format!("{name} {:?}", shader.stage))
            };
            stages.modules.push(module);
            let entry = |(i, s): (usize, &Specialization)| vk::SpecializationMapEntry {
                constant_id: s.id,
                offset: 4 * i as u32,
                size: 4,
            };
            stages.entries.push(shader.specialization.iter().enumerate().map(entry).collect());
            stages.values.push(shader.specialization.iter().map(|s| s.bits).collect());
        }
        Ok(stages)
    }

    pub fn specializations(&self) -> Vec<vk::SpecializationInfo<'_>> {
        let pairs = self.entries.iter().zip(&self.values);
        pairs.map(|(e, v)| vk::SpecializationInfo::default().map_entries(e).data(bytemuck::cast_slice(v))).collect()
    }

    pub fn infos<'b>(
        &self,
        specializations: &'b [vk::SpecializationInfo<'b>],
    ) -> Vec<vk::PipelineShaderStageCreateInfo<'b>> {
        let stages = self.shaders.iter().zip(&self.modules).zip(specializations);
        stages
            .map(|((shader, module), specialization)| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(shader.stage)
                    .module(module.raw())
                    .name(c"main")
                    .specialization_info(specialization)
            })
            .collect()
    }
}
