//! Every pipeline that the models of a renderer need, made when the first such model is added.

use super::bindings::model_layout;
use super::cached::CachedPipelines;
use super::conversion::Conversion;
use super::factor::Cut;
use super::lattice::LatticePipelines;
use super::lists::{ListPipelines, view_layout};
use super::stages::{PatchStages, Sharing, reads_texels, spaced};
use super::vertex_input::VertexInput;
use super::{ColorEncoding, Construction, Evaluation, Fragment, Geometry, Options, Style, Target, names, subdivision};
use crate::gpu::{
    DeviceContext, GpuError, GraphicsPipelineDesc, Owned, Shader, Spacing, Specialization, pipeline_layout, shaders,
};
use ash::vk;
use rustc_hash::FxHashMap;
use std::collections::HashMap;
use std::sync::Arc;

/// What the tessellation stages do besides drawing: nothing, or write down what they computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(not(feature = "headless"), allow(dead_code, reason = "only `capture` asks for it"))]
pub(crate) enum Capture {
    #[default]
    Off,
    /// The control points.
    Points,
    /// Each evaluated vertex as it comes.
    Vertices,
    /// The samples of a grid.
    Grid,
    /// The vertices of each triangle.
    Triangles,
}

/// What tells pipelines of one renderer apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct PipelineKey {
    /// Index into the styles.
    pub style: usize,
    pub geometry: GeometryKey,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum GeometryKey {
    /// Of draws with these flags ([`Cut`]), if they are of the tessellation stages.
    Patches(PatchStages, Cut),
    /// Patches of all kinds that were evaluated before.
    Evaluated {
        displaced: bool,
    },
    /// Faces that are subdivided this many times.
    Subdivision(u32),
    Control,
}

impl GeometryKey {
    fn is_displaced(self) -> bool {
        match self {
            Self::Patches(patch, _) => patch.sharing == Sharing::Displacement,
            Self::Evaluated { displaced } => displaced,
            Self::Subdivision(_) | Self::Control => false,
        }
    }

    /// Control points that go into a control shader, if there is one.
    fn input_points(self) -> u32 {
        match self {
            Self::Patches(patch, _) if patch.evaluation == Evaluation::Tessellation => patch.input_points(),
            _ => 0,
        }
    }
}

/// The caller's own shaders in the place of ours, by name.
pub(super) struct ShaderCode(HashMap<String, Vec<u32>>);

impl ShaderCode {
    /// Whether it is the caller's own.
    fn is_own(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// A shader by its name: the caller's own, or ours.
    pub(super) fn find(&self, name: &str) -> Result<&[u32], GpuError> {
        self.0.get(name).map_or_else(|| shaders::named(name), |code| Ok(code))
    }
}

/// Layouts and pipelines.
pub(super) struct Pipelines {
    context: Arc<DeviceContext>,
    target: Target,
    styles: Vec<Style>,
    texcoords: bool,
    shaders: ShaderCode,
    capture: Capture,
    cache: vk::PipelineCache,
    pub view_layout: Owned<vk::DescriptorSetLayout>,
    pub model_layout: Owned<vk::DescriptorSetLayout>,
    pub layout: Owned<vk::PipelineLayout>,
    /// For what the cached construction computes.
    pub cached: CachedPipelines,
    /// For the first of two passes, once a model wants it.
    pub conversion: Option<Conversion>,
    /// For what evaluation by compute does.
    pub lattice: LatticePipelines,
    /// For patches that are left out before draws.
    pub lists: ListPipelines,
    made: FxHashMap<PipelineKey, Owned<vk::Pipeline>>,
}

/// The stages that read set 0, set 1 and the push constants.
pub(crate) const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::VERTEX.as_raw()
        | vk::ShaderStageFlags::TESSELLATION_CONTROL.as_raw()
        | vk::ShaderStageFlags::TESSELLATION_EVALUATION.as_raw()
        | vk::ShaderStageFlags::GEOMETRY.as_raw()
        | vk::ShaderStageFlags::FRAGMENT.as_raw(),
);

impl Pipelines {
    pub(super) fn new(
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
        let sets = [view_layout.raw(), model_layout.raw()];
        let cached = CachedPipelines::new(context, sets, options.pipeline_cache)?;
        let wireframe = options.styles.iter().any(|style| style.wireframe);
        let lattice = LatticePipelines::new(context, sets, options.pipeline_cache, options.texcoords, wireframe)?;
        let lists = ListPipelines::new(context, sets, options.pipeline_cache)?;
        Ok(Self {
            context: context.clone(),
            target: target.clone(),
            styles: options.styles.clone(),
            texcoords: options.texcoords,
            shaders: ShaderCode(options.shaders.iter().cloned().collect()),
            capture,
            cache: options.pipeline_cache,
            view_layout,
            model_layout,
            layout,
            cached,
            conversion: None,
            lattice,
            lists,
            made: FxHashMap::default(),
        })
    }

    /// Whether instances have their control points as vertex attributes: where they fit, unless the caller has a shader of its own
    /// for texels only.
    pub(super) fn has_attributes(&self, stages: PatchStages) -> bool {
        let name = |attributes| PatchStages { attributes, ..stages }.evaluation(self.capture, self.texcoords);
        let [texels, attributes] = [false, true].map(|attributes| self.shaders.is_own(&name(attributes)));
        stages.fit_attributes(self.context.properties()) && (attributes || !texels)
    }

    pub(super) fn styles(&self) -> &[Style] {
        &self.styles
    }

    pub(super) fn get(&self, key: PipelineKey) -> Option<vk::Pipeline> {
        self.made.get(&key).map(Owned::raw)
    }

    /// Makes what draws of these patches need in every style.
    pub(super) fn make(&mut self, patches: &[PatchStages], cut: Cut) -> Result<(), GpuError> {
        // Subdivision has no patches, and pipelines by level.
        let patches = || patches.iter().filter(|stages| stages.evaluation != Evaluation::Subdivision);
        for &stages in patches() {
            match (stages.construction, stages.evaluation) {
                (Construction::Cached, Evaluation::GeometryTwoPass) => self.convert(stages)?,
                (Construction::Cached, _) => self.cached.make(stages, &self.shaders)?,
                _ => {}
            }
            if stages.evaluation == Evaluation::Compute {
                self.lattice.make(stages, &self.shaders)?;
            }
        }
        for style in 0..self.styles.len() {
            if self.styles[style].geometry != Geometry::Surface {
                self.make_one(PipelineKey { style, geometry: GeometryKey::Control })?;
                continue;
            }
            for stages in patches() {
                self.make_one(PipelineKey { style, geometry: stages.geometry(cut) })?;
            }
        }
        Ok(())
    }

    /// Makes what draws of subdivided faces need in every style of the surface.
    pub(super) fn make_subdivision(&mut self, level: u32) -> Result<(), GpuError> {
        for style in 0..self.styles.len() {
            if self.styles[style].geometry == Geometry::Surface {
                self.make_one(PipelineKey { style, geometry: GeometryKey::Subdivision(level) })?;
            }
        }
        Ok(())
    }

    /// Makes what the first of two passes needs.
    fn convert(&mut self, stages: PatchStages) -> Result<(), GpuError> {
        let mut made = match self.conversion.take() {
            Some(made) => made,
            None => Conversion::new(&self.context, [self.view_layout.raw(), self.model_layout.raw()], self.cache)?,
        };
        let result = made.make(stages, &self.shaders);
        self.conversion = Some(made);
        result
    }

    /// Makes what lists of the patches of these need that can be seen.
    pub(super) fn make_lists(&mut self, patches: &[PatchStages], cut: Cut) -> Result<(), GpuError> {
        let mut patches = patches.iter().filter(|stages| stages.has_hull());
        patches.try_for_each(|&stages| self.lists.make(stages, cut, &self.shaders))
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
                let vertex = Shader::vertex(self.shaders.find("CONSTRUCT_CONTROL_MESH_VERT")?);
                ("control mesh".to_owned(), vec![vertex.specialized(&reads_texels)])
            }
            GeometryKey::Evaluated { displaced } => {
                let vertex = match (displaced, self.texcoords) {
                    (true, _) => "EVALUATE_LATTICE_VERT_DISPLACED",
                    (false, true) => "EVALUATE_LATTICE_VERT_TEXCOORD",
                    (false, false) => "EVALUATE_LATTICE_VERT",
                };
                ("evaluated vertices".to_owned(), vec![Shader::vertex(self.shaders.find(vertex)?)])
            }
            GeometryKey::Subdivision(level) => {
                let vertex = Shader::vertex(self.shaders.find("CONSTRUCT_PATCH_NUMBER_VERT")?);
                let geometry = self.shaders.find(&subdivision::shader(level, self.capture, self.texcoords))?;
                let stages = vec![vertex, Shader::geometry(geometry).specialized(&reads_texels)];
                (format!("faces subdivided {level} times"), stages)
            }
            GeometryKey::Patches(patch, cut) => {
                let evaluation = self.shaders.find(&patch.evaluation(self.capture, self.texcoords))?;
                constants = patch.specialization(cut, properties);
                let stages = match patch.evaluation {
                    Evaluation::Tessellation => {
                        let spacing = if self.capture == Capture::Grid { Spacing::Equal } else { patch.spacing };
                        code = spaced(evaluation, spacing);
                        self.tessellating(patch, &constants, &code)?
                    }
                    Evaluation::Geometry => {
                        let tile = Shader::vertex(self.shaders.find("CONSTRUCT_PATCH_NUMBER_VERT")?);
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
        let vertex = self.shaders.find(&patch.vertex(self.capture))?;
        let control = self.shaders.find(&patch.control(self.capture, self.texcoords))?;
        let mut stages = vec![
            Shader::vertex(vertex).specialized(constants),
            Shader::tess_control(control).specialized(constants),
            Shader::tess_evaluation(evaluation),
        ];
        if self.capture == Capture::Triangles {
            stages.push(Shader::geometry(shaders::CAPTURE_TRIANGLES_GEOM));
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
        let dynamic_states: &[_] = match key.geometry {
            GeometryKey::Evaluated { .. } => &[vk::DynamicState::PRIMITIVE_TOPOLOGY],
            GeometryKey::Patches(stages, _) if stages.is_instanced() => &[vk::DynamicState::PRIMITIVE_TOPOLOGY],
            _ => &[],
        };
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
            rasterizer_discard: style.rasterizer_discard,
            dynamic_states,
            cache: self.cache,
            ..GraphicsPipelineDesc::new(name, self.layout.raw(), target.render_target(), stages)
        };
        // SAFETY: the shaders are ours and match; the caller's shaders and targets do by the contract of `Renderer::new`.
        unsafe { desc.create(&self.context) }
    }
}

/// The fragment shader, if there is anything for it to do; `ours` are the constants of those that are ours.
fn fragment<'a>(style: &'a Style, target: &Target, displaced: bool, ours: &'a [Specialization]) -> Option<Shader<'a>> {
    let code = match (&style.fragment, style.geometry) {
        _ if style.rasterizer_discard => return None,
        (Fragment::Spirv(code), _) => return Some(Shader::fragment(code)),
        _ if target.render_target().color_attachments() == 0 => return None,
        (Fragment::Lit, Geometry::Surface) if displaced => shaders::SHADE_LIT_FRAG_DISPLACED,
        (Fragment::Normals, Geometry::Surface) if displaced => shaders::SHADE_NORMALS_FRAG_DISPLACED,
        (Fragment::Lit, Geometry::Surface) => shaders::SHADE_LIT_FRAG,
        (Fragment::Lit, Geometry::ControlFaces) => shaders::SHADE_FACETS_FRAG,
        (Fragment::Normals, Geometry::Surface) => shaders::SHADE_NORMALS_FRAG,
        _ => shaders::SHADE_FLAT_FRAG,
    };
    Some(Shader::fragment(code).specialized(ours))
}
