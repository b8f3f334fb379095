//! The shaders of the renderer: the axes along which their sources vary, and which combinations there are. Compiled into
//! `build.rs`, too, which multiplies them, and writes [`ShaderId`](super::ShaderId).

use super::{PatchForm, Sharing};
use crate::named::named;

named! {
    /// A source, by its path below `glsl/`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Source {
        ControlMeshVert = "construct/control_mesh.vert",
        PatchNumberVert = "construct/patch_number.vert",
        TwoStageVert = "construct/two_stage.vert",
        TwoStageTesc = "construct/two_stage.tesc",
        TablesTesc = "construct/tables.tesc",
        ConvertVert = "construct/convert.vert",
        ConvertGeom = "construct/convert.geom",
        FramesComp = "compute/frames.comp",
        ControlPointsComp = "compute/control_points.comp",
        CullComp = "compute/cull.comp",
        GatherComp = "compute/gather.comp",
        RefineComp = "compute/refine.comp",
        TessellationTese = "evaluate/tessellation.tese",
        UniformGridComp = "evaluate/uniform_grid.comp",
        UniformGridVert = "evaluate/uniform_grid.vert",
        InstancedVert = "evaluate/instanced.vert",
        StripsGeom = "evaluate/strips.geom",
        FacesGeom = "subdivide/faces.geom",
        LitFrag = "shade/lit.frag",
        NormalsFrag = "shade/normals.frag",
        FlatFrag = "shade/flat.frag",
        FacetsFrag = "shade/facets.frag",
        TrianglesGeom = "capture/triangles.geom",
    }
}

named! {
    /// What a shader hands on, besides positions and normals.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Output {
        Surface = "surface",
        /// Texture coordinates.
        Texcoords = "texcoords",
        /// Control points, written down.
        CapturePoints = "capture-points",
        /// Each evaluated vertex as it comes, written down.
        CaptureVertices = "capture-vertices",
        /// The samples of a grid, written down.
        CaptureGrid = "capture-grid",
    }
}

/// How a source depends on the patch.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ByPatch {
    /// Not at all.
    No,
    /// On its scheme.
    Scheme,
    Yes,
}

/// The axes of a source.
struct Axes {
    patch: ByPatch,
    sharing: bool,
    outputs: &'static [Output],
    attributes: bool,
    /// Levels of subdivision.
    levels: u8,
}

impl Source {
    const fn axes(self) -> Axes {
        use Output::{CaptureGrid, CapturePoints, CaptureVertices, Surface, Texcoords};
        let none = Axes { patch: ByPatch::No, sharing: false, outputs: &[Surface], attributes: false, levels: 1 };
        let patch = Axes { patch: ByPatch::Yes, ..none };
        let sharing = Axes { sharing: true, ..patch };
        match self {
            Self::TwoStageVert => Axes { patch: ByPatch::Scheme, ..sharing },
            Self::TwoStageTesc | Self::TablesTesc => {
                Axes { outputs: &[Surface, Texcoords, CapturePoints, CaptureVertices], ..sharing }
            }
            Self::TessellationTese => Axes { outputs: &[Surface, Texcoords, CaptureVertices, CaptureGrid], ..sharing },
            Self::StripsGeom => Axes { outputs: &[Surface, Texcoords, CaptureVertices], ..sharing },
            Self::InstancedVert => {
                Axes { outputs: &[Surface, Texcoords, CaptureVertices], attributes: true, ..sharing }
            }
            Self::ControlPointsComp | Self::UniformGridComp => sharing,
            Self::ConvertGeom | Self::CullComp => patch,
            Self::UniformGridVert => Axes { sharing: true, outputs: &[Surface, Texcoords], ..none },
            Self::LitFrag | Self::NormalsFrag => Axes { sharing: true, ..none },
            Self::FacesGeom => Axes { outputs: &[Surface, Texcoords, CaptureGrid], levels: 4, ..none },
            _ => none,
        }
    }

    /// The stage, as its files end.
    pub fn stage(self) -> &'static str {
        self.name().rsplit('.').next().unwrap_or_default()
    }
}

/// What tells shaders apart. What is no axis of a source is as in [`ShaderKey::of`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ShaderKey {
    pub source: Source,
    pub patch: PatchForm,
    pub sharing: Sharing,
    pub output: Output,
    /// Whether instances have their control points as vertex attributes.
    pub attributes: bool,
    /// Levels of subdivision.
    pub level: u8,
}

impl ShaderKey {
    /// The first along all axes.
    pub const fn of(source: Source) -> Self {
        let (patch, sharing, output) = (PatchForm::Bicubic, Sharing::Positions, Output::Surface);
        Self { source, patch, sharing, output, attributes: false, level: 0 }
    }

    /// The key of the shader that serves: with nothing said along axes that the source does not have.
    pub fn canonical(self) -> Self {
        let (axes, first) = (self.source.axes(), Self::of(self.source));
        let patch = match axes.patch {
            ByPatch::No => first.patch,
            ByPatch::Scheme => self.patch.of_scheme(),
            ByPatch::Yes => self.patch,
        };
        let sharing = if axes.sharing { self.sharing } else { first.sharing };
        let output = match self.output {
            // Control points are the same in all.
            Output::CapturePoints => self.output,
            // Displacement comes with texture coordinates.
            Output::Texcoords if sharing == Sharing::Displacement => Output::Surface,
            output => output,
        };
        let sharing = if output == Output::CapturePoints { Sharing::Positions } else { sharing };
        let output = if axes.outputs.contains(&output) { output } else { Output::Surface };
        let attributes = axes.attributes && self.attributes;
        let level = if axes.levels > 1 { self.level } else { 0 };
        Self { source: self.source, patch, sharing, output, attributes, level }
    }

    /// Whether there is such a shader.
    pub fn exists(self) -> bool {
        let (axes, patch) = (self.source.axes(), self.patch.facts());
        if self != self.canonical() || self.level >= axes.levels {
            return false;
        }
        let shares = self.sharing == Sharing::Positions || axes.patch == ByPatch::No || patch.keeps_frame;
        let is_needed = match self.source {
            // Where patches have no hull, none can be culled.
            Source::CullComp if patch.hull == 0 => false,
            Source::UniformGridVert | Source::LitFrag | Source::NormalsFrag if self.sharing == Sharing::Normals => {
                false
            }
            _ => true,
        };
        shares && is_needed
    }

    /// Whether only tools use the shader.
    pub fn is_for_tools(self) -> bool {
        matches!(self.output, Output::CapturePoints | Output::CaptureVertices | Output::CaptureGrid)
            || self.source == Source::TrianglesGeom
    }

    /// All that there are, in order.
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for source in Source::ALL {
            for patch in PatchForm::ALL {
                for sharing in [Sharing::Positions, Sharing::Normals, Sharing::Displacement] {
                    for output in Output::ALL {
                        for attributes in [false, true] {
                            let levels = 0..source.axes().levels;
                            let keys = levels.map(|level| Self { source, patch, sharing, output, attributes, level });
                            all.extend(keys.filter(|key| key.exists()));
                        }
                    }
                }
            }
        }
        all
    }

    /// The words that tell it from others of its source.
    pub fn words(self) -> Vec<String> {
        let axes = self.source.axes();
        let mut words = Vec::new();
        match axes.patch {
            ByPatch::No => {}
            ByPatch::Scheme => words.push(self.patch.facts().scheme.to_owned()),
            ByPatch::Yes => words.push(self.patch.name().to_owned()),
        }
        match self.sharing {
            Sharing::Positions => {}
            Sharing::Normals => words.push("shared".to_owned()),
            Sharing::Displacement => words.push("displaced".to_owned()),
        }
        if self.output != Output::Surface {
            words.push(self.output.name().to_owned());
        }
        if self.attributes {
            words.push("attributes".to_owned());
        }
        if axes.levels > 1 {
            words.push(format!("level-{}", self.level));
        }
        words
    }

    /// What the compiler is told: folders of includes, and macros.
    pub fn arguments(self) -> Vec<String> {
        let (axes, patch) = (self.source.axes(), self.patch.facts());
        let mut arguments = vec!["-Iglsl/lib".to_owned()];
        let mut define = |name: &str| arguments.push(format!("-D{name}"));
        if axes.patch == ByPatch::Yes {
            define(&format!("CORNERS={}", patch.corners));
            define(&format!("OWNED={}", patch.owned));
            define(&format!("HULL={}", patch.hull));
            match patch.corners {
                3 => define("TRIANGLE"),
                5 => define("PENTAGON"),
                _ => {}
            }
            if patch.keeps_frame {
                define("KEEPS_FRAME");
            }
            if patch.two_face_points {
                define("TWO_FACE_POINTS");
            }
            if patch.may_be_adaptive {
                define("MAY_BE_ADAPTIVE");
            }
        }
        match self.sharing {
            Sharing::Positions => {}
            Sharing::Normals => define("SHARED"),
            Sharing::Displacement => define("DISPLACED"),
        }
        match self.output {
            Output::Surface => {}
            Output::Texcoords => define("TEXCOORD"),
            Output::CapturePoints => define("CAPTURE_POINTS"),
            Output::CaptureVertices => define("CAPTURE"),
            Output::CaptureGrid => define("CAPTURE_GRID"),
        }
        if self.attributes {
            define("ATTRIBUTES");
        }
        if axes.levels > 1 {
            define(&format!("LEVEL={}", self.level));
        }
        if axes.patch != ByPatch::No {
            arguments.push(format!("-Iglsl/schemes/{}", patch.scheme));
        }
        arguments
    }
}
