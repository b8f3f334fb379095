//! Which shaders a patch is drawn with: found by name, so that a scheme adds files and its arm in [`files`].

use super::cut::Cut;
use crate::gpu::{DeviceProperties, Spacing, Specialization};
use crate::patch::Scheme;
use crate::table::{Construction, Evaluation, Sharing, TEXEL_BYTES, kept_texels};
use crate::topology::PatchKind;

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
pub(crate) struct PipelineKey {
    /// Index into the styles.
    pub style: usize,
    pub geometry: GeometryKey,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum GeometryKey {
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
    pub(crate) fn is_displaced(self) -> bool {
        match self {
            Self::Patches(patch, _) => patch.sharing == Sharing::Displacement,
            Self::Evaluated { displaced } => displaced,
            Self::Subdivision(_) | Self::Control => false,
        }
    }

    /// Control points that go into a control shader, if there is one.
    pub(crate) fn input_points(self) -> u32 {
        match self {
            Self::Patches(patch, _) if patch.evaluation == Evaluation::Tessellation => patch.input_points(),
            _ => 0,
        }
    }
}

/// What tells the shaders of a patch apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct PatchStages {
    pub scheme: Scheme,
    pub kind: PatchKind,
    pub construction: Construction,
    pub evaluation: Evaluation,
    pub spacing: Spacing,
    pub sharing: Sharing,
    /// Whether any corner has another ring than its own speak for what it shares.
    pub has_speakers: bool,
    /// Whether edges of a lattice have factors of their own.
    pub edge_factors: bool,
    /// Texels that a corner has room for where its vectors are kept between draws, else 0.
    pub stride: u32,
    /// Whether the vertex shader has the control points as attributes of an instance.
    pub attributes: bool,
}

impl Sharing {
    /// At the end of a shader's name.
    fn suffix(self, capture: Capture) -> &'static str {
        match self {
            // Control points are the same in all.
            _ if capture == Capture::Points => "",
            Self::Positions => "",
            Self::Normals => "_SHARED",
            Self::Displacement => "_DISPLACED",
        }
    }
}

/// The files `glsl/construct/_.tesc` and `glsl/evaluate/_.tese` of a kind of patch; the latter is also its name in
/// `glsl/lib/draw/kinds.glsl`.
fn files(scheme: Scheme, kind: PatchKind) -> [&'static str; 2] {
    match (kind, scheme) {
        (PatchKind::Regular, _) => ["REGULAR", "BICUBIC"],
        (PatchKind::IrregularQuad, Scheme::Gregory | Scheme::GregoryFitted) => ["GREGORY", "GREGORY_QUAD"],
        (PatchKind::Triangle, Scheme::Gregory | Scheme::GregoryFitted) => ["GREGORY", "GREGORY_TRIANGLE"],
        (_, Scheme::Acc) => ["ACC", "ACC"],
        (PatchKind::IrregularQuad, Scheme::Pm | Scheme::CPatch) => ["PM", "PM_QUAD"],
        (PatchKind::Triangle, Scheme::Pm | Scheme::CPatch) => ["PM", "PM_TRIANGLE"],
        (PatchKind::Pentagon, _) => ["PM", "PM_PENTAGON"],
    }
}

impl PatchStages {
    /// Control points that go into the control shader: one a corner, or one a patch that only says which patch it is.
    pub(crate) fn input_points(self) -> u32 {
        match self.construction {
            Construction::TwoStage => self.kind.corners() as u32,
            Construction::Stencil | Construction::Cached => 1,
        }
    }

    /// What tells their pipelines apart in one style.
    pub(crate) fn geometry(self, cut: Cut) -> GeometryKey {
        match self.evaluation {
            Evaluation::Compute => GeometryKey::Evaluated { displaced: self.sharing == Sharing::Displacement },
            Evaluation::Tessellation => GeometryKey::Patches(self, cut),
            _ => GeometryKey::Patches(self, cut.without_control()),
        }
    }

    /// What tells apart the pipelines that make control points by compute: what is of no concern to them is as usual.
    pub(crate) fn for_control_points(self) -> Self {
        let (evaluation, spacing) = (Evaluation::Tessellation, Spacing::Equal);
        Self { evaluation, spacing, edge_factors: false, attributes: false, ..self }
    }

    /// Whether the vertex shader evaluates instances of a lattice.
    pub(crate) fn is_instanced(self) -> bool {
        matches!(self.evaluation, Evaluation::Instanced | Evaluation::GeometryTwoPass)
    }

    /// Whether it does with no more control points than a device has attributes.
    pub(crate) fn fit_attributes(self, device: &DeviceProperties) -> bool {
        self.is_instanced() && self.attribute_offsets().count() <= device.max_vertex_attributes as usize
    }

    /// Where the attributes of an instance are in what is kept of a patch, in bytes.
    pub(crate) fn attribute_offsets(self) -> impl Iterator<Item = u32> {
        let texels = kept_texels(self.scheme.owned(self.kind), self.sharing);
        let of_corner = move |k| (0..texels).map(move |i| TEXEL_BYTES as u32 * (k * self.stride + i));
        (0..self.kind.corners() as u32).flat_map(of_corner)
    }

    /// Bytes of what is kept of a patch.
    pub(crate) fn patch_bytes(self) -> u32 {
        TEXEL_BYTES as u32 * self.stride * self.kind.corners() as u32
    }

    /// The name of the shader that makes control points for all draws of a frame.
    pub(crate) fn control_points(self) -> String {
        let sharing = self.sharing.suffix(Capture::Off);
        format!("COMPUTE_CONTROL_POINTS_COMP{}{}{sharing}", self.scheme_suffix(), self.domain_suffix())
    }

    /// Of shaders that make control points and are not of regular patches.
    fn scheme_suffix(self) -> String {
        match files(self.scheme, self.kind) {
            ["REGULAR", _] => String::new(),
            [file, _] => format!("_{file}"),
        }
    }

    /// Of shaders that are not of quads.
    fn domain_suffix(self) -> &'static str {
        match self.kind {
            PatchKind::Triangle => "_TRIANGLE",
            PatchKind::Pentagon => "_PENTAGON",
            PatchKind::Regular | PatchKind::IrregularQuad => "",
        }
    }

    /// The name of the vertex shader.
    pub(crate) fn vertex(self, capture: Capture) -> String {
        if self.construction != Construction::TwoStage {
            return "CONSTRUCT_PATCH_NUMBER_VERT".to_owned();
        }
        format!("CONSTRUCT_TWO_STAGE_VERT{}{}", self.scheme_suffix(), self.sharing.suffix(capture))
    }

    /// Whether its control points enclose it, so that they tell whether it can be seen. GLSL twin: `HULL` in
    /// `glsl/lib/edges/culling.glsl`.
    pub(crate) fn has_hull(self) -> bool {
        !matches!(files(self.scheme, self.kind)[0], "PM")
    }

    /// What tells apart the pipelines that list which patches can be seen.
    pub(crate) fn for_culling(self) -> Self {
        Self {
            sharing: Sharing::Positions,
            has_speakers: false,
            attributes: self.attributes,
            ..self.for_control_points()
        }
    }

    /// The name of the shader that lists which patches can be seen.
    pub(crate) fn culling(self) -> String {
        let construction = match self.construction {
            Construction::TwoStage => "_TWO_STAGE",
            Construction::Stencil => "_STENCIL",
            Construction::Cached => "",
        };
        format!("COMPUTE_CULL_COMP{}{}{construction}", self.scheme_suffix(), self.domain_suffix())
    }

    /// What the shaders of draws that are cut so are specialized to, but for those that evaluate and shade.
    pub(crate) fn specialization(self, cut: Cut, device: &DeviceProperties) -> [Specialization; 10] {
        [
            Specialization::uint(0, self.kind.corners() as u32),
            Specialization::float(2, device.max_tessellation_level as f32),
            Specialization::uint(3, self.stride),
            Specialization::uint(4, cut.flags()),
            Specialization::bool(5, self.scheme == Scheme::GregoryFitted),
            Specialization::bool(6, self.scheme.has_pentagons()),
            Specialization::bool(7, self.has_speakers),
            Specialization::bool(8, self.edge_factors),
            reads_texels(device),
            Specialization::bool(10, cut.is_listed()),
        ]
    }

    /// The name of the control shader.
    pub(crate) fn control(self, capture: Capture, texcoords: bool) -> String {
        let [file, _] = files(self.scheme, self.kind);
        let mut name = match self.construction {
            Construction::TwoStage => format!("CONSTRUCT_{file}_TESC"),
            Construction::Stencil => format!("CONSTRUCT_STENCIL_TESC_OWNED_{}", self.scheme.owned(self.kind)),
            Construction::Cached => format!("CONSTRUCT_CACHED_TESC_OWNED_{}", self.scheme.owned(self.kind)),
        };
        name += self.domain_suffix();
        name += self.sharing.suffix(capture);
        name += match capture {
            Capture::Points => "_CAPTURE_POINTS",
            Capture::Vertices | Capture::Grid | Capture::Triangles => "_CAPTURE",
            // Displacement comes with texture coordinates.
            Capture::Off if texcoords && self.sharing != Sharing::Displacement => "_TEXCOORD",
            Capture::Off => "",
        };
        name
    }

    /// The name of the shader that evaluates.
    pub(crate) fn evaluation(self, capture: Capture, texcoords: bool) -> String {
        let [_, file] = files(self.scheme, self.kind);
        let mut name = match self.evaluation {
            // Subdivision has no patches: see `subdivision::shader`.
            Evaluation::Tessellation | Evaluation::Subdivision => format!("EVALUATE_{file}_TESE"),
            Evaluation::Compute => format!("EVALUATE_LATTICE_COMP_{file}"),
            Evaluation::Instanced | Evaluation::GeometryTwoPass => format!("EVALUATE_INSTANCED_VERT_{file}"),
            Evaluation::Geometry => format!("EVALUATE_STRIPS_GEOM_{file}"),
        };
        if (self.evaluation, self.construction) == (Evaluation::Geometry, Construction::Cached) {
            name += "_CACHED";
        }
        name += self.sharing.suffix(capture);
        name += match capture {
            Capture::Grid => "_CAPTURE_GRID",
            Capture::Vertices | Capture::Triangles => "_CAPTURE",
            // Displacement comes with texture coordinates.
            Capture::Off if texcoords && self.sharing != Sharing::Displacement => "_TEXCOORD",
            Capture::Off | Capture::Points => "",
        };
        if self.attributes {
            name += "_ATTRIBUTES";
        }
        name
    }
}

/// What all shaders that read tables are specialized to. GLSL twin: `READS_TEXELS` in `glsl/lib/draw/positions.glsl`.
pub(crate) fn reads_texels(device: &DeviceProperties) -> Specialization {
    Specialization::bool(9, device.reads_texels)
}

/// The name of the geometry shader that subdivides faces.
pub(crate) fn subdivision_shader(level: u32, capture: Capture, texcoords: bool) -> String {
    let mut name = String::from("SUBDIVIDE_FACES_GEOM");
    if level > 0 {
        name += &format!("_LEVEL_{level}");
    }
    name += match capture {
        Capture::Off if texcoords => "_TEXCOORD",
        Capture::Off => "",
        Capture::Grid => "_CAPTURE_GRID",
        // There is none: what else is captured is of patches.
        _ => "_CAPTURE",
    };
    name
}

#[cfg(all(test, feature = "headless"))]
mod tests {
    use super::*;
    use crate::gpu::shaders;

    #[test]
    fn every_patch_has_its_shaders() {
        let modes = [Capture::Off, Capture::Points, Capture::Vertices, Capture::Grid, Capture::Triangles];
        for (scheme, kind) in Scheme::ALL.into_iter().flat_map(|scheme| PatchKind::ALL.map(|kind| (scheme, kind))) {
            if matches!(scheme, Scheme::Acc | Scheme::CPatch) && kind == PatchKind::Triangle
                || kind == PatchKind::Pentagon && !scheme.has_pentagons()
            {
                continue;
            }
            let ways = Evaluation::ALL.into_iter().flat_map(|e| e.constructions().iter().map(move |&c| (e, c)));
            for ((evaluation, construction), sharing) in
                ways.flat_map(|way| [Sharing::Positions, Sharing::Normals, Sharing::Displacement].map(|s| (way, s)))
            {
                let tessellates = evaluation == Evaluation::Tessellation;
                if sharing != Sharing::Positions && !(scheme.is_watertight() && evaluation.shares(construction)) {
                    continue;
                }
                let spacing = Spacing::Equal;
                let attributes = matches!(evaluation, Evaluation::Instanced | Evaluation::GeometryTwoPass);
                let stages = PatchStages {
                    scheme,
                    kind,
                    construction,
                    evaluation,
                    spacing,
                    sharing,
                    has_speakers: true,
                    edge_factors: false,
                    stride: 9,
                    attributes,
                };
                for (capture, texcoords) in modes.into_iter().flat_map(|mode| [(mode, false), (mode, true)]) {
                    let made = [stages.vertex(capture), stages.control(capture, texcoords), stages.control_points()];
                    let culling = stages.has_hull().then(|| stages.culling());
                    let watched = match evaluation {
                        Evaluation::Tessellation => true,
                        Evaluation::Compute => capture == Capture::Off,
                        _ => matches!(capture, Capture::Off | Capture::Vertices),
                    };
                    let evaluation = watched.then(|| stages.evaluation(capture, texcoords));
                    for name in made.into_iter().filter(|_| tessellates).chain(culling).chain(evaluation) {
                        assert!(shaders::find(&name).is_some(), "{name}");
                    }
                }
            }
        }
    }

    #[test]
    fn instances_have_attributes_where_there_are_enough() {
        let headless = crate::headless::Headless::new(&crate::headless::HeadlessOptions::default()).unwrap();
        let stages = |sharing, stride| PatchStages {
            scheme: Scheme::Gregory,
            kind: PatchKind::IrregularQuad,
            construction: Construction::Cached,
            evaluation: Evaluation::Instanced,
            spacing: Spacing::Equal,
            sharing,
            has_speakers: false,
            edge_factors: false,
            stride,
            attributes: false,
        };
        // As many as every Vulkan device has, unless patches share more.
        for (sharing, stride, needed) in
            [(Sharing::Positions, 4, 16), (Sharing::Normals, 8, 32), (Sharing::Displacement, 9, 36)]
        {
            let stages = stages(sharing, stride);
            let fit = |max_vertex_attributes| {
                stages.fit_attributes(&DeviceProperties { max_vertex_attributes, ..headless.properties().clone() })
            };
            assert!(fit(needed) && !fit(needed - 1), "{sharing:?}");
            assert_eq!(stages.patch_bytes(), 16 * needed);
        }
        let tessellated = PatchStages { evaluation: Evaluation::Tessellation, ..stages(Sharing::Positions, 4) };
        assert!(!tessellated.fit_attributes(headless.properties()));
    }
}
