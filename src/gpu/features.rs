use std::ffi::CStr;

use ash::vk;

macro_rules! features {
    ($($(#[$doc:meta])* $field:ident = $name:literal,)*) => {
        /// The device features that the crate knows of: those a device has, those that are enabled on it, or those that
        /// something needs.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
        pub struct Features {
            $($(#[$doc])* #[doc = concat!("(`", $name, "`)")] pub $field: bool,)*
        }

        impl Features {
            /// No feature.
            pub const NONE: Self = Self { $($field: false,)* };

            /// Every feature, with its Vulkan name.
            pub fn named(self) -> impl Iterator<Item = (&'static str, bool)> {
                [$(($name, self.$field),)*].into_iter()
            }

            /// The features of both.
            pub fn union(self, other: Self) -> Self {
                Self { $($field: self.$field || other.$field,)* }
            }

            /// The features that are in both.
            pub fn intersection(self, other: Self) -> Self {
                Self { $($field: self.$field && other.$field,)* }
            }
        }
    };
}

features! {
    /// The tessellation stages, without which nothing works.
    tessellation = "tessellationShader",
    /// Rendering without render pass objects.
    dynamic_rendering = "dynamicRendering",
    /// `vkCmdPipelineBarrier2` and its like.
    synchronization2 = "synchronization2",
    /// Keeps validation layers from warning of outputs that the next stage does not read, such as what invocations of a control
    /// shader tell each other; every device with Vulkan 1.3 has it.
    maintenance4 = "maintenance4",
    /// `discard` in fragment shaders of the caller's, compiled for Vulkan 1.3.
    terminate_invocation = "shaderTerminateInvocation",
    /// `discard` by other compilers.
    demote_to_helper_invocation = "shaderDemoteToHelperInvocation",
    /// Wireframe pictures.
    fill_mode_non_solid = "fillModeNonSolid",
    /// Lines of more than one pixel.
    wide_lines = "wideLines",
    /// Shaders before rasterization that write buffers: capture of evaluated vertices.
    vertex_stores = "vertexPipelineStoresAndAtomics",
    /// Counting shader invocations.
    statistics = "pipelineStatisticsQuery",
    /// Geometry shaders, the `gl_PrimitiveID` of fragment shaders with them: subdivision of faces.
    geometry = "geometryShader",
    /// Indirect draws that start at any instance: patches that compute shaders culled.
    indirect_first_instance = "drawIndirectFirstInstance",
    /// Several indirect draws in one call: the same.
    multi_draw_indirect = "multiDrawIndirect",
    /// Colour attachments that differ in how they are written: shaders of ours that write to the first only.
    independent_blend = "independentBlend",
    /// `double` in shaders.
    float64 = "shaderFloat64",
    /// Anisotropic texture filtering.
    anisotropy = "samplerAnisotropy",
    /// Transform feedback (the extension `VK_EXT_transform_feedback`).
    transform_feedback = "transformFeedback",
}

impl Features {
    /// The features that a physical device has.
    ///
    /// # Safety
    ///
    /// `physical_device` comes from `instance`, whose version is at least 1.1.
    pub unsafe fn supported(instance: &ash::Instance, physical_device: vk::PhysicalDevice) -> Self {
        // SAFETY: as the caller promises.
        let extensions = unsafe { instance.enumerate_device_extension_properties(physical_device) }.unwrap_or_default();
        let has = |name: &CStr| extensions.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name));

        let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
        let mut feedback = vk::PhysicalDeviceTransformFeedbackFeaturesEXT::default();
        let mut all = vk::PhysicalDeviceFeatures2::default().push_next(&mut v13);
        if has(ash::ext::transform_feedback::NAME) {
            all = all.push_next(&mut feedback);
        }
        // SAFETY: as the caller promises; a structure that the device does not know stays as it is, all false.
        unsafe { instance.get_physical_device_features2(physical_device, &mut all) };
        let core = all.features;
        Self {
            tessellation: core.tessellation_shader == vk::TRUE,
            dynamic_rendering: v13.dynamic_rendering == vk::TRUE,
            synchronization2: v13.synchronization2 == vk::TRUE,
            maintenance4: v13.maintenance4 == vk::TRUE,
            terminate_invocation: v13.shader_terminate_invocation == vk::TRUE,
            demote_to_helper_invocation: v13.shader_demote_to_helper_invocation == vk::TRUE,
            fill_mode_non_solid: core.fill_mode_non_solid == vk::TRUE,
            wide_lines: core.wide_lines == vk::TRUE,
            vertex_stores: core.vertex_pipeline_stores_and_atomics == vk::TRUE,
            statistics: core.pipeline_statistics_query == vk::TRUE,
            geometry: core.geometry_shader == vk::TRUE,
            indirect_first_instance: core.draw_indirect_first_instance == vk::TRUE,
            multi_draw_indirect: core.multi_draw_indirect == vk::TRUE,
            independent_blend: core.independent_blend == vk::TRUE,
            float64: core.shader_float64 == vk::TRUE,
            anisotropy: core.sampler_anisotropy == vk::TRUE,
            transform_feedback: feedback.transform_feedback == vk::TRUE,
        }
    }

    /// The Vulkan names of the features in `needed` that are not in `self`.
    pub fn missing(self, needed: Self) -> Vec<&'static str> {
        self.named()
            .zip(needed.named())
            .filter(|((_, has), (_, needs))| *needs && !*has)
            .map(|((name, _), _)| name)
            .collect()
    }

    /// The device extensions that the features need on Vulkan 1.3.
    pub fn extensions(self) -> Vec<&'static CStr> {
        if self.transform_feedback { vec![ash::ext::transform_feedback::NAME] } else { Vec::new() }
    }

    /// Turns the features on in structures of the caller's chain for `vkCreateDevice`, and leaves what else is on there as it is. The
    /// extension's `transformFeedback` is in neither.
    ///
    /// ```
    /// use ash::vk;
    /// use ash_subdiv::renderer::{Options, Target, requirements};
    ///
    /// let target = Target::dynamic(vk::Format::R8G8B8A8_SRGB, vk::Format::D32_SFLOAT, vk::SampleCountFlags::TYPE_1);
    /// let needs = requirements(&target, &Options::default()).features;
    /// // As your engine has them.
    /// let mut core = vk::PhysicalDeviceFeatures::default().sampler_anisotropy(true);
    /// let mut v13 = vk::PhysicalDeviceVulkan13Features::default().synchronization2(true);
    /// needs.enable(&mut core, &mut v13);
    /// assert!(core.tessellation_shader == vk::TRUE && v13.dynamic_rendering == vk::TRUE);
    /// assert!(core.sampler_anisotropy == vk::TRUE && v13.synchronization2 == vk::TRUE);
    /// ```
    pub fn enable(self, core: &mut vk::PhysicalDeviceFeatures, v13: &mut vk::PhysicalDeviceVulkan13Features<'_>) {
        let set = |flag: &mut vk::Bool32, on: bool| *flag |= vk::Bool32::from(on);
        set(&mut core.tessellation_shader, self.tessellation);
        set(&mut core.fill_mode_non_solid, self.fill_mode_non_solid);
        set(&mut core.wide_lines, self.wide_lines);
        set(&mut core.vertex_pipeline_stores_and_atomics, self.vertex_stores);
        set(&mut core.pipeline_statistics_query, self.statistics);
        set(&mut core.geometry_shader, self.geometry);
        set(&mut core.draw_indirect_first_instance, self.indirect_first_instance);
        set(&mut core.multi_draw_indirect, self.multi_draw_indirect);
        set(&mut core.independent_blend, self.independent_blend);
        set(&mut core.shader_float64, self.float64);
        set(&mut core.sampler_anisotropy, self.anisotropy);
        set(&mut v13.dynamic_rendering, self.dynamic_rendering);
        set(&mut v13.synchronization2, self.synchronization2);
        set(&mut v13.maintenance4, self.maintenance4);
        set(&mut v13.shader_terminate_invocation, self.terminate_invocation);
        set(&mut v13.shader_demote_to_helper_invocation, self.demote_to_helper_invocation);
    }

    /// Calls `with` with the chain of feature structures to hand to `vkCreateDevice`, for Vulkan 1.3.
    ///
    /// In it is a `VkPhysicalDeviceVulkan13Features`, of which a chain has one at most, and none of the structures that were
    /// promoted into it beside it (such as `VkPhysicalDeviceDynamicRenderingFeatures`). If you have one, use
    /// [`Features::enable`].
    pub fn chain<R>(self, with: impl FnOnce(&mut vk::PhysicalDeviceFeatures2<'_>) -> R) -> R {
        let (mut core, mut v13) =
            (vk::PhysicalDeviceFeatures::default(), vk::PhysicalDeviceVulkan13Features::default());
        self.enable(&mut core, &mut v13);
        let mut feedback = vk::PhysicalDeviceTransformFeedbackFeaturesEXT::default().transform_feedback(true);
        let mut all = vk::PhysicalDeviceFeatures2::default().features(core).push_next(&mut v13);
        if self.transform_feedback {
            all = all.push_next(&mut feedback);
        }
        with(&mut all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_features_are_named() {
        let has = Features { tessellation: true, ..Features::NONE };
        let needs = Features { tessellation: true, float64: true, wide_lines: true, ..Features::NONE };
        assert_eq!(has.missing(needs), ["wideLines", "shaderFloat64"]);
        assert!(needs.missing(has).is_empty());
        assert_eq!(has.union(needs), needs);
        assert_eq!(has.intersection(needs), has);
    }
}
