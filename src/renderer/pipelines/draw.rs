//! The pipelines of draws, each made when the first model is added that needs it.

use super::recipe::{MadeFor, Recipe, RecipeStage};
use crate::constants::{ID_ENCODE_SRGB, ID_INSTANCES};
use crate::gpu::{DeviceContext, GpuError, GraphicsPipelineDesc, Owned, Shader, Specialization, pipeline_layout};
use crate::renderer::options::{ColorEncoding, Fragment, Geometry, Options, Style, Target};
use crate::renderer::shader::{
    Capture, DrawConstants, GeometryKey, PipelineKey, STAGES, SetLayouts, ShaderCode, ShaderId, without_instances,
};
use ash::vk;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Layouts and pipelines of draws.
pub(crate) struct DrawPipelines {
    context: Arc<DeviceContext>,
    target: Target,
    styles: Vec<Style>,
    texcoords: bool,
    pub shaders: ShaderCode,
    capture: Capture,
    cache: vk::PipelineCache,
    pub layout: Owned<vk::PipelineLayout>,
    made: FxHashMap<PipelineKey, Owned<vk::Pipeline>>,
}

impl DrawPipelines {
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        target: &Target,
        options: &Options,
        capture: Capture,
        layouts: &SetLayouts,
    ) -> Result<Self, GpuError> {
        let sets = [&layouts.shared()[..], &options.set_layouts].concat();
        let constants =
            [vk::PushConstantRange { stage_flags: STAGES, offset: 0, size: size_of::<DrawConstants>() as u32 }];
        // SAFETY: the layouts are of this device; for the caller's own that is part of the contract of `Renderer::new`.
        let layout = unsafe { pipeline_layout(context, "subdiv", &sets, &constants)? };
        Ok(Self {
            context: context.clone(),
            target: target.clone(),
            styles: options.styles.clone(),
            texcoords: options.texcoords,
            shaders: ShaderCode::new(options),
            capture,
            cache: options.pipeline_cache,
            layout,
            made: FxHashMap::default(),
        })
    }

    /// What recipes depend on.
    pub(crate) fn made_for(&self) -> MadeFor<'_> {
        MadeFor { properties: self.context.properties(), capture: self.capture, texcoords: self.texcoords }
    }

    pub(crate) fn styles(&self) -> &[Style] {
        &self.styles
    }

    pub(crate) fn get(&self, key: PipelineKey) -> Option<vk::Pipeline> {
        self.made.get(&key).map(Owned::raw)
    }

    /// Makes the pipelines of a recipe in every style of the surface.
    pub(crate) fn make(
        &mut self,
        (geometry, instances): (GeometryKey, bool),
        recipe: impl Fn(GeometryKey, &MadeFor) -> Recipe,
    ) -> Result<(), GpuError> {
        for style in 0..self.styles.len() {
            let key = PipelineKey { style, geometry, instances };
            if self.styles[style].geometry == Geometry::Surface && !self.made.contains_key(&key) {
                let recipe = recipe(geometry, &self.made_for());
                self.make_one(key, &recipe)?;
            }
        }
        Ok(())
    }

    /// Makes the pipelines of the control mesh, in the styles that draw it.
    pub(crate) fn make_control(&mut self, instances: bool) -> Result<(), GpuError> {
        for style in 0..self.styles.len() {
            let key = PipelineKey { style, geometry: GeometryKey::Control, instances };
            let topology = match self.styles[style].geometry {
                Geometry::Surface => continue,
                Geometry::ControlFaces => vk::PrimitiveTopology::TRIANGLE_LIST,
                Geometry::ControlEdges => vk::PrimitiveTopology::LINE_LIST,
            };
            if !self.made.contains_key(&key) {
                let recipe = Recipe::control_mesh(&self.made_for(), topology);
                self.make_one(key, &recipe)?;
            }
        }
        Ok(())
    }

    fn make_one(&mut self, key: PipelineKey, recipe: &Recipe) -> Result<(), GpuError> {
        let style = &self.styles[key.style];
        let target = style.target_or(&self.target);
        let last = recipe.stages.len() - 1;
        let code = |(number, stage): (usize, &RecipeStage)| match key.instances {
            true => stage.code(&self.shaders),
            false => stage.code_of_one(&self.shaders, number == last),
        };
        let codes = recipe.stages.iter().enumerate().map(code).collect::<Result<Vec<_>, _>>()?;
        let encode = [
            Specialization::bool(ID_INSTANCES, key.instances),
            Specialization::bool(ID_ENCODE_SRGB, target.encoding == ColorEncoding::Srgb),
        ];
        let of_instances = Specialization::bool(ID_INSTANCES, key.instances);
        let constants: Vec<Vec<_>> = recipe.stages.iter().map(|stage| stage.with(of_instances)).collect();
        let stages = recipe.stages.iter().zip(&codes).zip(&constants);
        let mut stages: Vec<Shader> = stages.map(|((stage, code), constants)| stage.shader(code, constants)).collect();
        let (fragment, ours) = fragment(style, target, recipe.displaced).unzip();
        let fragment = fragment.map(|code| match key.instances {
            true => code.to_vec(),
            false => without_instances(code, vk::ShaderStageFlags::FRAGMENT, false),
        });
        // Of our constants, a shader of the caller's has those alone that say what is drawn.
        let constants = if ours == Some(true) { &encode[..] } else { &encode[..1] };
        stages.extend(fragment.as_ref().map(|code| Shader::fragment(code).specialized(constants)));
        let mut dynamic_states = Vec::new();
        dynamic_states.extend(recipe.topology_is_dynamic.then_some(vk::DynamicState::PRIMITIVE_TOPOLOGY));
        // Set when bound: a pipeline that always discards has no attachment formats, and fits no rendering that has attachments.
        dynamic_states.extend(style.rasterizer_discard.then_some(vk::DynamicState::RASTERIZER_DISCARD_ENABLE));
        let name = format!("subdiv style {}: {}", key.style, recipe.name);
        let desc = GraphicsPipelineDesc {
            patch_control_points: recipe.input_points,
            vertex_bindings: recipe.input.bindings.as_slice(),
            vertex_attributes: &recipe.input.attributes,
            topology: recipe.topology,
            polygon_mode: if style.wireframe { vk::PolygonMode::LINE } else { vk::PolygonMode::FILL },
            cull_mode: style.cull,
            front_face: style.front_face,
            line_width: style.line_width,
            depth: if target.depth { style.depth } else { None },
            depth_bias: style.depth_bias,
            blend: style.blend,
            first_color_only: style.writes_first_only(target),
            samples: target.samples,
            dynamic_states: &dynamic_states,
            cache: self.cache,
            ..GraphicsPipelineDesc::new(&name, self.layout.raw(), target.render_target(), &stages)
        };
        // SAFETY: the shaders are ours and match; the caller's shaders and targets do by the contract of `Renderer::new`.
        let pipeline = unsafe { desc.create(&self.context)? };
        self.made.insert(key, pipeline);
        Ok(())
    }
}

/// The SPIR-V of the fragment shader, if there is anything for it to do, and whether it is ours.
fn fragment<'a>(style: &'a Style, target: &Target, displaced: bool) -> Option<(&'a [u32], bool)> {
    let id = match (&style.fragment, style.geometry) {
        _ if style.rasterizer_discard => return None,
        (Fragment::Spirv(code), _) => return Some((code, false)),
        _ if target.render_target().color_attachments() == 0 => return None,
        (Fragment::Lit, Geometry::Surface) if displaced => ShaderId::ShadeLitFragDisplaced,
        (Fragment::Normals, Geometry::Surface) if displaced => ShaderId::ShadeNormalsFragDisplaced,
        (Fragment::Lit, Geometry::Surface) => ShaderId::ShadeLitFrag,
        (Fragment::Lit, Geometry::ControlFaces) => ShaderId::ShadeFacetsFrag,
        (Fragment::Normals, Geometry::Surface) => ShaderId::ShadeNormalsFrag,
        _ => ShaderId::ShadeFlatFrag,
    };
    Some((id.code(), true))
}
