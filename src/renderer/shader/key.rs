//! The shaders and the pipelines of a patch, by what tells them apart.

use super::axes::{Output, ShaderKey, Source};
use super::cut::Cut;
use crate::adaptive::DrawnBy;
use crate::constants;
use crate::gpu::{DeviceProperties, Spacing, Specialization};
use crate::patch::{PatchForm, Scheme};
use crate::table::{Construction, Evaluation, Sharing, TEXEL_BYTES};
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
    /// Whether draws are of instances of an item.
    pub instances: bool,
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

/// What tells the shaders of a patch apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct PatchStages {
    pub scheme: Scheme,
    pub kind: PatchKind,
    pub construction: Construction,
    pub evaluation: Evaluation,
    pub spacing: Spacing,
    pub sharing: Sharing,
    /// Whether another ring than its own owns what some corner shares.
    pub has_foreign_owners: bool,
    /// Whether edges of a uniform grid have factors of their own.
    pub edge_factors: bool,
    /// Texels that a corner has room for where its vectors are kept between draws, else 0.
    pub stride: u32,
    /// Whether the vertex shader has the control points as attributes of an instance.
    pub attributes: bool,
    /// Part of the surface that a patch is, where leaves are evaluated.
    pub adaptive: Option<DrawnBy>,
}

impl Capture {
    /// Output of the shader that evaluates.
    pub(crate) fn evaluated(self, texcoords: bool) -> Output {
        match self {
            Self::Points => Output::Surface,
            capture => capture.output(texcoords),
        }
    }

    /// Output of the control shader.
    fn output(self, texcoords: bool) -> Output {
        match self {
            Self::Off if texcoords => Output::Texcoords,
            Self::Off => Output::Surface,
            Self::Points => Output::CapturePoints,
            Self::Vertices | Self::Triangles => Output::CaptureVertices,
            Self::Grid => Output::CaptureGrid,
        }
    }
}

impl PatchStages {
    /// Whether patches are leaves, whose control points the control shader looks up.
    pub(crate) fn is_by_leaves(self) -> bool {
        self.adaptive == Some(DrawnBy::Leaves)
    }

    /// The patch that shaders are compiled for.
    fn form(self) -> PatchForm {
        self.scheme.form(self.kind).expect("plans have patches that their schemes have")
    }

    /// Control points that go into the control shader: one a corner, or one a patch that only says which patch it is.
    pub(crate) fn input_points(self) -> u32 {
        match self.construction {
            Construction::TwoStage => self.kind.corners() as u32,
            Construction::Stencil | Construction::Cached => 1,
        }
    }

    /// What tells apart the pipelines that make control points by compute: what is of no concern to them is as usual.
    pub(crate) fn for_control_points(self) -> Self {
        let (evaluation, spacing) = (Evaluation::Tessellation, Spacing::Equal);
        Self { evaluation, spacing, edge_factors: false, attributes: false, adaptive: None, ..self }
    }

    /// Whether it does with no more control points than a device has attributes.
    pub(crate) fn fit_attributes(self, device: &DeviceProperties) -> bool {
        self.attribute_offsets().count() <= device.max_vertex_attributes as usize
    }

    /// Where the attributes of an instance are in what is kept of a patch, in bytes.
    pub(crate) fn attribute_offsets(self) -> impl Iterator<Item = u32> {
        let texels = self.sharing.kept_texels(self.scheme.owned(self.kind));
        let of_corner = move |k| (0..texels).map(move |i| TEXEL_BYTES as u32 * (k * self.stride + i));
        (0..self.kind.corners() as u32).flat_map(of_corner)
    }

    /// Bytes of what is kept of a patch.
    pub(crate) fn patch_bytes(self) -> u32 {
        TEXEL_BYTES as u32 * self.stride * self.kind.corners() as u32
    }

    /// The key of one of its shaders.
    pub(crate) fn shader(self, source: Source, output: Output) -> ShaderKey {
        let (patch, sharing, attributes) = (self.form(), self.sharing, self.attributes);
        ShaderKey { source, patch, sharing, output, attributes, level: 0 }.canonical()
    }

    /// The shader that makes control points for all draws of a frame.
    pub(crate) fn control_points(self) -> ShaderKey {
        self.shader(Source::ControlPointsComp, Output::Surface)
    }

    /// The shader that makes them in a pass of its own.
    pub(crate) fn conversion(self) -> ShaderKey {
        self.shader(Source::ConvertGeom, Output::Surface)
    }

    /// The vertex shader.
    pub(crate) fn vertex(self) -> ShaderKey {
        match self.construction {
            Construction::TwoStage => self.shader(Source::TwoStageVert, Output::Surface),
            Construction::Stencil | Construction::Cached => ShaderKey::of(Source::PatchNumberVert),
        }
    }

    /// Whether its control points enclose it, or its hull does of a face that is refined, so that they tell whether it can be seen. See
    /// `glsl/lib/edges/culling.glsl`.
    pub(crate) fn has_hull(self) -> bool {
        self.form().facts().hull > 0
    }

    /// What tells apart the pipelines that list which patches can be seen.
    pub(crate) fn for_culling(self) -> Self {
        Self {
            sharing: Sharing::Positions,
            has_foreign_owners: false,
            attributes: self.attributes,
            adaptive: self.adaptive,
            ..self.for_control_points()
        }
    }

    /// The shader that lists which patches can be seen.
    pub(crate) fn culling(self) -> ShaderKey {
        self.shader(Source::CullComp, Output::Surface)
    }

    /// What the shaders of draws that are cut so are specialized to, but for those that evaluate and shade.
    pub(crate) fn specialization(self, cut: Cut, device: &DeviceProperties) -> [Specialization; 12] {
        let cut = if self.adaptive.is_some() { cut.of_refined() } else { cut };
        let flags = cut.flags(self.has_hull());
        let adaptive = match self.adaptive {
            None => constants::NOT_ADAPTIVE,
            Some(DrawnBy::Faces) => constants::BY_FACES,
            Some(DrawnBy::Leaves) => constants::BY_LEAVES,
        };
        [
            Specialization::uint(constants::ID_CORNERS, self.kind.corners() as u32),
            Specialization::float(constants::ID_MAX_FACTOR, device.max_tessellation_level as f32),
            Specialization::uint(constants::ID_STRIDE, self.stride),
            Specialization::uint(constants::ID_DRAW_FLAGS, flags),
            Specialization::bool(constants::ID_MAY_BE_FITTED, self.scheme == Scheme::GregoryFitted),
            Specialization::bool(constants::ID_MAY_HAVE_PENTAGONS, self.scheme.has_pentagons()),
            Specialization::bool(constants::ID_HAS_FOREIGN_OWNERS, self.has_foreign_owners),
            Specialization::bool(constants::ID_HAS_EDGE_FACTORS, self.edge_factors),
            reads_texels(device),
            Specialization::bool(constants::ID_LISTED, cut.is_listed()),
            Specialization::uint(constants::ID_CONSTRUCTION, construction_number(self.construction)),
            Specialization::uint(constants::ID_ADAPTIVE, adaptive),
        ]
    }

    /// The control shader.
    pub(crate) fn control(self, capture: Capture, texcoords: bool) -> ShaderKey {
        let source = match self.construction {
            Construction::TwoStage => Source::TwoStageTesc,
            Construction::Stencil | Construction::Cached => Source::TablesTesc,
        };
        let output = match capture {
            Capture::Grid => Output::CaptureVertices,
            capture => capture.output(texcoords),
        };
        self.shader(source, output)
    }
}

/// The number of a construction in shaders.
fn construction_number(construction: Construction) -> u32 {
    match construction {
        Construction::TwoStage => constants::TWO_STAGE,
        Construction::Stencil => constants::STENCIL,
        Construction::Cached => constants::CACHED,
    }
}

/// What all shaders that read tables are specialized to. GLSL twin: `READS_TEXELS` in `glsl/lib/draw/positions.glsl`.
pub(crate) fn reads_texels(device: &DeviceProperties) -> Specialization {
    Specialization::bool(constants::ID_READS_TEXELS, device.reads_texels)
}

#[cfg(all(test, feature = "headless"))]
mod tests {
    use super::*;

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
            has_foreign_owners: false,
            edge_factors: false,
            stride,
            attributes: false,
            adaptive: None,
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
    }
}
