//! The pipelines of draws, each made when the first model is added that needs it.

use super::vertex_input::VertexInput;
use crate::gpu::{
    DeviceContext, GpuError, GraphicsPipelineDesc, Owned, Shader, Spacing, Specialization, pipeline_layout,
};
use crate::renderer::options::{ColorEncoding, Fragment, Geometry, Options, Style, Target};
use crate::renderer::shader::{
    Capture, Cut, GeometryKey, PatchStages, PipelineKey, STAGES, ShaderCode, model_layout, names, reads_texels, spaced,
    subdivision_shader, view_layout,
};
use crate::renderer::shader::{Output, ShaderId, ShaderKey, Source};
use crate::table::Evaluation;
use crate::table::Sharing;
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
    pub view_layout: Owned<vk::DescriptorSetLayout>,
    pub model_layout: Owned<vk::DescriptorSetLayout>,
    pub layout: Owned<vk::PipelineLayout>,
    made: FxHashMap<PipelineKey, Owned<vk::Pipeline>>,
}

impl DrawPipelines {
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        target: &Target,
        options: &Options,
        capture: Capture,
    ) -> Result<Self, GpuError> {
        let view_layout = view_layout(context)?;
        let model_layout = model_layout(context)?;
        let mut sets = vec![view_layout.raw(), model_layout.raw()];
        sets.extend(&options.set_layouts);
        let constants = [vk::PushConstantRange { stage_flags: STAGES, offset: 0, size: 128 }];
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
            view_layout,
            model_layout,
            layout,
            made: FxHashMap::default(),
        })
    }

    /// Whether instances have their control points as vertex attributes: where they fit, unless the caller has a shader of its own
    /// for texels only.
    pub(crate) fn has_attributes(&self, stages: PatchStages) -> bool {
        let key = |attributes| PatchStages { attributes, ..stages }.evaluation(self.capture, self.texcoords);
        let [texels, attributes] = [false, true].map(|attributes| self.shaders.is_own(key(attributes)));
        stages.fit_attributes(self.context.properties()) && (attributes || !texels)
    }

    pub(crate) fn styles(&self) -> &[Style] {
        &self.styles
    }

    pub(crate) fn get(&self, key: PipelineKey) -> Option<vk::Pipeline> {
        self.made.get(&key).map(Owned::raw)
    }

    /// Makes what draws of these patches need in every style.
    pub(crate) fn make(&mut self, patches: &[PatchStages], cut: Cut) -> Result<(), GpuError> {
        for style in 0..self.styles.len() {
            if self.styles[style].geometry != Geometry::Surface {
                self.make_one(PipelineKey { style, geometry: GeometryKey::Control })?;
                continue;
            }
            for stages in patches {
                self.make_one(PipelineKey { style, geometry: stages.geometry(cut) })?;
            }
        }
        Ok(())
    }

    /// The set layouts of views and of models.
    pub(crate) fn set_layouts(&self) -> [vk::DescriptorSetLayout; 2] {
        [self.view_layout.raw(), self.model_layout.raw()]
    }

    /// Makes what draws of subdivided faces need in every style of the surface.
    pub(crate) fn make_subdivision(&mut self, level: u32) -> Result<(), GpuError> {
        for style in 0..self.styles.len() {
            if self.styles[style].geometry == Geometry::Surface {
                self.make_one(PipelineKey { style, geometry: GeometryKey::Subdivision(level) })?;
            }
        }
        Ok(())
    }

    fn make_one(&mut self, key: PipelineKey) -> Result<(), GpuError> {
        if self.made.contains_key(&key) {
            return Ok(());
        }
        let (style, properties) = (&self.styles[key.style], self.context.properties());
        let reads_texels = [reads_texels(properties)];
        let (constants, code);
        let (name, mut stages) = match key.geometry {
            GeometryKey::Control => {
                let vertex = Shader::vertex(self.shaders.find(ShaderKey::of(Source::ControlMeshVert))?);
                ("control mesh".to_owned(), vec![vertex.specialized(&reads_texels)])
            }
            GeometryKey::Evaluated { displaced } => {
                let vertex = evaluated_vertices(displaced, self.texcoords);
                ("evaluated vertices".to_owned(), vec![Shader::vertex(self.shaders.find(vertex)?)])
            }
            GeometryKey::Subdivision(level) => {
                let vertex = Shader::vertex(self.shaders.find(ShaderKey::of(Source::PatchNumberVert))?);
                let geometry = self.shaders.find(subdivision_shader(level, self.capture, self.texcoords))?;
                let stages = vec![vertex, Shader::geometry(geometry).specialized(&reads_texels)];
                (format!("faces subdivided {level} times"), stages)
            }
            GeometryKey::Patches(patch, cut) => {
                let evaluation = self.shaders.find(patch.evaluation(self.capture, self.texcoords))?;
                constants = patch.specialization(cut, properties);
                let stages = match patch.evaluation {
                    Evaluation::Tessellation => {
                        let spacing = if self.capture == Capture::Grid { Spacing::Equal } else { patch.spacing };
                        code = spaced(evaluation, spacing);
                        self.tessellating(patch, &constants, &code)?
                    }
                    Evaluation::Geometry => {
                        let tile = Shader::vertex(self.shaders.find(ShaderKey::of(Source::PatchNumberVert))?);
                        vec![tile, Shader::geometry(evaluation).specialized(&constants)]
                    }
                    _ => vec![Shader::vertex(evaluation).specialized(&constants)],
                };
                (names::patches(patch, cut), stages)
            }
        };
        let target = style.target_or(&self.target);
        let encode = [Specialization::bool(1, target.encoding == ColorEncoding::Srgb)];
        stages.extend(fragment(style, target, key.geometry.is_displaced(), &encode));
        let pipeline = self.create(&format!("subdiv style {}: {name}", key.style), key, target, &stages)?;
        self.made.insert(key, pipeline);
        Ok(())
    }

    /// The stages before the fragment shader.
    fn tessellating<'s>(
        &'s self,
        patch: PatchStages,
        constants: &'s [Specialization],
        evaluation: &'s [u32],
    ) -> Result<Vec<Shader<'s>>, GpuError> {
        let vertex = self.shaders.find(patch.vertex())?;
        let control = self.shaders.find(patch.control(self.capture, self.texcoords))?;
        let mut stages = vec![
            Shader::vertex(vertex).specialized(constants),
            Shader::tess_control(control).specialized(constants),
            Shader::tess_evaluation(evaluation),
        ];
        if self.capture == Capture::Triangles {
            stages.push(Shader::geometry(self.shaders.find(ShaderKey::of(Source::TrianglesGeom))?));
        }
        Ok(stages)
    }

    fn create(
        &self,
        name: &str,
        key: PipelineKey,
        target: &Target,
        stages: &[Shader],
    ) -> Result<Owned<vk::Pipeline>, GpuError> {
        let style = &self.styles[key.style];
        let input = VertexInput::new(key.geometry, self.texcoords);
        let topology = match key.geometry {
            GeometryKey::Subdivision(_)
            | GeometryKey::Patches(PatchStages { evaluation: Evaluation::Geometry, .. }, _) => {
                vk::PrimitiveTopology::POINT_LIST
            }
            _ if style.geometry == Geometry::ControlEdges => vk::PrimitiveTopology::LINE_LIST,
            _ => vk::PrimitiveTopology::TRIANGLE_LIST,
        };
        // A lattice says what its indices are of.
        let topology_is_dynamic = match key.geometry {
            GeometryKey::Evaluated { .. } => true,
            GeometryKey::Patches(stages, _) => stages.is_instanced(),
            _ => false,
        };
        let mut dynamic_states = Vec::new();
        dynamic_states.extend(topology_is_dynamic.then_some(vk::DynamicState::PRIMITIVE_TOPOLOGY));
        // Set when bound: a pipeline that always discards has no attachment formats, and fits no rendering that has attachments.
        dynamic_states.extend(style.rasterizer_discard.then_some(vk::DynamicState::RASTERIZER_DISCARD_ENABLE));
        let desc = GraphicsPipelineDesc {
            patch_control_points: key.geometry.input_points(),
            vertex_bindings: input.bindings.as_slice(),
            vertex_attributes: &input.attributes,
            topology,
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
            ..GraphicsPipelineDesc::new(name, self.layout.raw(), target.render_target(), stages)
        };
        // SAFETY: the shaders are ours and match; the caller's shaders and targets do by the contract of `Renderer::new`.
        unsafe { desc.create(&self.context) }
    }
}

/// The fragment shader, if there is anything for it to do; `ours` are the constants of those that are ours.
fn fragment<'a>(style: &'a Style, target: &Target, displaced: bool, ours: &'a [Specialization]) -> Option<Shader<'a>> {
    let id = match (&style.fragment, style.geometry) {
        _ if style.rasterizer_discard => return None,
        (Fragment::Spirv(code), _) => return Some(Shader::fragment(code)),
        _ if target.render_target().color_attachments() == 0 => return None,
        (Fragment::Lit, Geometry::Surface) if displaced => ShaderId::ShadeLitFragDisplaced,
        (Fragment::Normals, Geometry::Surface) if displaced => ShaderId::ShadeNormalsFragDisplaced,
        (Fragment::Lit, Geometry::Surface) => ShaderId::ShadeLitFrag,
        (Fragment::Lit, Geometry::ControlFaces) => ShaderId::ShadeFacetsFrag,
        (Fragment::Normals, Geometry::Surface) => ShaderId::ShadeNormalsFrag,
        _ => ShaderId::ShadeFlatFrag,
    };
    Some(Shader::fragment(id.code()).specialized(ours))
}

/// The vertex shader of vertices that compute evaluated.
fn evaluated_vertices(displaced: bool, texcoords: bool) -> ShaderKey {
    let sharing = if displaced { Sharing::Displacement } else { Sharing::Positions };
    let output = if texcoords { Output::Texcoords } else { Output::Surface };
    ShaderKey { sharing, output, ..ShaderKey::of(Source::LatticeVert) }.canonical()
}
