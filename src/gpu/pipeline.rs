use std::sync::Arc;

use ash::vk;

use super::stages::Stages;
use super::{DeviceContext, GpuError, Owned, Shader, VkResultExt};

/// Attachments of a graphics pipeline.
#[derive(Debug, Clone, Copy)]
pub enum RenderTarget<'a> {
    #[allow(missing_docs, reason = "named as in Vulkan")]
    /// `vkCmdBeginRendering` with these formats; `UNDEFINED` where there is no such attachment.
    Dynamic { color: &'a [vk::Format], depth: vk::Format, stencil: vk::Format },
    #[allow(missing_docs, reason = "named as in Vulkan")]
    /// A subpass of a render pass that has this many colour attachments.
    RenderPass { render_pass: vk::RenderPass, subpass: u32, color_attachments: u32 },
}

impl RenderTarget<'_> {
    pub(crate) fn color_attachments(&self) -> usize {
        match self {
            Self::Dynamic { color, .. } => color.len(),
            Self::RenderPass { color_attachments, .. } => *color_attachments as usize,
        }
    }
}

/// The depth test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DepthState {
    /// Comparison of a fragment's depth with the depth that is there.
    pub compare: vk::CompareOp,
    /// Whether the depth of fragments that pass is kept.
    pub write: bool,
}

impl DepthState {
    /// Nearer than what is there, where near is 0 and far is 1.
    pub const LESS: Self = Self { compare: vk::CompareOp::LESS, write: true };
    /// As near as what is there, or nearer: for what lies on top.
    pub const LESS_OR_EQUAL: Self = Self { compare: vk::CompareOp::LESS_OR_EQUAL, write: true };
}

/// Bias that is added to the depth of a fragment (Vulkan 1.3, "Depth Bias").
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DepthBias {
    /// Smallest steps of the depth format.
    pub constant: f32,
    /// Times the greatest slope of depth in the triangle.
    pub slope: f32,
}

/// Blending of a fragment's colour with the colour that is there; the same for all colour attachments that are written to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Blend {
    /// Replaces it.
    #[default]
    Opaque,
    /// `src.rgb * src.a + dst.rgb * (1 - src.a)`.
    Alpha,
    /// `src.rgb + dst.rgb * (1 - src.a)`.
    PremultipliedAlpha,
    /// `src + dst`.
    Add,
}

impl Blend {
    fn attachment(self) -> vk::PipelineColorBlendAttachmentState {
        use vk::BlendFactor as F;
        let (src, dst) = match self {
            Self::Opaque | Self::PremultipliedAlpha => (F::ONE, F::ONE_MINUS_SRC_ALPHA),
            Self::Alpha => (F::SRC_ALPHA, F::ONE_MINUS_SRC_ALPHA),
            Self::Add => (F::ONE, F::ONE),
        };
        vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA)
            .blend_enable(self != Self::Opaque)
            .src_color_blend_factor(src)
            .dst_color_blend_factor(dst)
            .src_alpha_blend_factor(F::ONE)
            .dst_alpha_blend_factor(dst)
    }
}

/// A graphics pipeline in the making: start from [`GraphicsPipelineDesc::new`] and set what differs.
///
/// Viewport and scissor are dynamic.
#[allow(missing_docs, reason = "named as in Vulkan")]
#[derive(Debug, Clone)]
pub struct GraphicsPipelineDesc<'a> {
    /// The debug name.
    pub name: &'a str,
    pub layout: vk::PipelineLayout,
    pub target: RenderTarget<'a>,
    pub shaders: &'a [Shader<'a>],
    /// Vertices of a patch that come into the TCS; nought in a pipeline without tessellation.
    pub patch_control_points: u32,
    /// Used in a pipeline without tessellation.
    pub topology: vk::PrimitiveTopology,
    pub vertex_bindings: &'a [vk::VertexInputBindingDescription],
    pub vertex_attributes: &'a [vk::VertexInputAttributeDescription],
    pub polygon_mode: vk::PolygonMode,
    pub cull_mode: vk::CullModeFlags,
    pub front_face: vk::FrontFace,
    pub line_width: f32,
    /// No depth test if none.
    pub depth: Option<DepthState>,
    pub depth_bias: Option<DepthBias>,
    pub blend: Blend,
    /// Leave all colour attachments but the first as they are.
    pub first_color_only: bool,
    pub samples: vk::SampleCountFlags,
    /// Stop before rasterization: for capture and for timing the geometry.
    pub rasterizer_discard: bool,
    /// State besides viewport and scissor that is set while recording.
    pub dynamic_states: &'a [vk::DynamicState],
    pub cache: vk::PipelineCache,
}

impl<'a> GraphicsPipelineDesc<'a> {
    /// Filled, opaque triangles, counter-clockwise front faces, no culling, no depth test, one sample.
    pub fn new(name: &'a str, layout: vk::PipelineLayout, target: RenderTarget<'a>, shaders: &'a [Shader<'a>]) -> Self {
        Self {
            name,
            layout,
            target,
            shaders,
            patch_control_points: 0,
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            vertex_bindings: &[],
            vertex_attributes: &[],
            polygon_mode: vk::PolygonMode::FILL,
            cull_mode: vk::CullModeFlags::NONE,
            front_face: vk::FrontFace::COUNTER_CLOCKWISE,
            line_width: 1.0,
            depth: None,
            depth_bias: None,
            blend: Blend::Opaque,
            first_color_only: false,
            samples: vk::SampleCountFlags::TYPE_1,
            rasterizer_discard: false,
            dynamic_states: &[],
            cache: vk::PipelineCache::null(),
        }
    }

    fn rasterization(&self) -> vk::PipelineRasterizationStateCreateInfo<'static> {
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default()
            .rasterizer_discard_enable(self.rasterizer_discard)
            .polygon_mode(self.polygon_mode)
            .cull_mode(self.cull_mode)
            .front_face(self.front_face)
            .line_width(self.line_width);
        match self.depth_bias {
            None => rasterization,
            Some(bias) => rasterization
                .depth_bias_enable(true)
                .depth_bias_constant_factor(bias.constant)
                .depth_bias_slope_factor(bias.slope),
        }
    }

    fn depth_stencil(&self) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
        let none = vk::PipelineDepthStencilStateCreateInfo::default();
        self.depth.map_or(none, |state| {
            none.depth_test_enable(true).depth_write_enable(state.write).depth_compare_op(state.compare)
        })
    }

    fn attachments(&self) -> Vec<vk::PipelineColorBlendAttachmentState> {
        let mut attachments = vec![self.blend.attachment(); self.target.color_attachments()];
        if self.first_color_only {
            // Nothing is written by default.
            attachments.iter_mut().skip(1).for_each(|other| *other = vk::PipelineColorBlendAttachmentState::default());
        }
        attachments
    }

    /// Makes the pipeline.
    ///
    /// # Safety
    ///
    /// The shaders are valid SPIR-V whose interfaces match each other, the layout, the vertex input and the target; layout,
    /// render pass and cache are of this device.
    pub unsafe fn create(&self, context: &Arc<DeviceContext>) -> Result<Owned<vk::Pipeline>, GpuError> {
        self.check(context)?;
        let tessellated = self.patch_control_points > 0;
        let stages = Stages::new(context, self.name, self.shaders)?;
        let specializations = stages.specializations();
        let stage_infos = stages.infos(&specializations);

        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(self.vertex_bindings)
            .vertex_attribute_descriptions(self.vertex_attributes);
        let input_assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(if tessellated {
            vk::PrimitiveTopology::PATCH_LIST
        } else {
            self.topology
        });
        let tessellation =
            vk::PipelineTessellationStateCreateInfo::default().patch_control_points(self.patch_control_points);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let rasterization = self.rasterization();
        let multisample = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(self.samples);
        let (depth, attachments) = (self.depth_stencil(), self.attachments());
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let dynamic_states = [&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR], self.dynamic_states].concat();
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic_states);

        let mut rendering = vk::PipelineRenderingCreateInfo::default();
        let mut info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stage_infos)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&input_assembly)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(self.layout);
        if tessellated {
            info = info.tessellation_state(&tessellation);
        }
        match self.target {
            RenderTarget::Dynamic { color, depth, stencil } => {
                rendering = rendering
                    .color_attachment_formats(color)
                    .depth_attachment_format(depth)
                    .stencil_attachment_format(stencil);
                info = info.push_next(&mut rendering);
            }
            RenderTarget::RenderPass { render_pass, subpass, .. } => {
                info = info.render_pass(render_pass).subpass(subpass);
            }
        }
        // SAFETY: as the caller promises.
        let created = unsafe { context.device().create_graphics_pipelines(self.cache, &[info], None) };
        owned_pipeline(context, created, "vkCreateGraphicsPipelines", self.name)
    }

    /// Checks what would be undefined behaviour, or fail with a message that helps nobody.
    fn check(&self, context: &DeviceContext) -> Result<(), GpuError> {
        let (properties, features) = (context.properties(), context.features());
        let unsupported = |why: String| Err(GpuError::Unsupported { object: self.name.to_owned(), why });
        let has = |stage| self.shaders.iter().any(|shader| shader.stage == stage);
        let control = has(vk::ShaderStageFlags::TESSELLATION_CONTROL);
        let evaluation = has(vk::ShaderStageFlags::TESSELLATION_EVALUATION);
        if control != evaluation || control != (self.patch_control_points > 0) {
            return Err(GpuError::BadPipeline {
                object: self.name.to_owned(),
                message:
                    "a tessellating pipeline has a TCS, a TES and a number of patch control points; others have none"
                        .to_owned(),
            });
        }
        if control && !features.tessellation {
            return unsupported("tessellationShader is not enabled on the device".to_owned());
        }
        if has(vk::ShaderStageFlags::GEOMETRY) && !features.geometry {
            return unsupported("geometryShader is not enabled on the device".to_owned());
        }
        if self.first_color_only && self.target.color_attachments() > 1 && !features.independent_blend {
            return unsupported("independentBlend is not enabled on the device".to_owned());
        }
        if self.patch_control_points > properties.max_patch_size {
            let (asked, max) = (self.patch_control_points, properties.max_patch_size);
            return unsupported(format!("{asked} control points a patch: the device has at most {max}"));
        }
        if self.polygon_mode != vk::PolygonMode::FILL && !features.fill_mode_non_solid {
            return unsupported("fillModeNonSolid is not enabled on the device".to_owned());
        }
        if self.line_width != 1.0 && !features.wide_lines {
            let asked = self.line_width;
            return unsupported(format!("lines of {asked} pixels: wideLines is not enabled on the device"));
        }
        let [thinnest, widest] = properties.line_widths;
        if self.line_width != 1.0 && !(thinnest..=widest).contains(&self.line_width) {
            let asked = self.line_width;
            return unsupported(format!("lines of {asked} pixels: the device has {thinnest} to {widest}"));
        }
        Ok(())
    }
}

/// A compute pipeline in the making.
#[allow(missing_docs, reason = "named as in Vulkan")]
#[derive(Debug, Clone, Copy)]
pub struct ComputePipelineDesc<'a> {
    /// The debug name.
    pub name: &'a str,
    pub layout: vk::PipelineLayout,
    pub shader: Shader<'a>,
    pub cache: vk::PipelineCache,
}

impl ComputePipelineDesc<'_> {
    /// Makes the pipeline.
    ///
    /// # Safety
    ///
    /// The shader is valid SPIR-V whose interface matches the layout; layout and cache are of this device.
    pub unsafe fn create(&self, context: &Arc<DeviceContext>) -> Result<Owned<vk::Pipeline>, GpuError> {
        let stages = Stages::new(context, self.name, std::slice::from_ref(&self.shader))?;
        let specializations = stages.specializations();
        let info =
            vk::ComputePipelineCreateInfo::default().stage(stages.infos(&specializations)[0]).layout(self.layout);
        // SAFETY: as the caller promises.
        let created = unsafe { context.device().create_compute_pipelines(self.cache, &[info], None) };
        owned_pipeline(context, created, "vkCreateComputePipelines", self.name)
    }
}

fn owned_pipeline(
    context: &Arc<DeviceContext>,
    created: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    call: &'static str,
    name: &str,
) -> Result<Owned<vk::Pipeline>, GpuError> {
    // One pipeline was asked for; on failure its handle is null.
    let pipelines = created.map_err(|(_, result)| result).of(call, name)?;
    // SAFETY: the pipeline was just created.
    Ok(unsafe { Owned::new(context, pipelines[0], name) })
}
