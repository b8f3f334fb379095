//! Timings: each way to draw a surface, and how far that is from the floor.
//!
//! A [`Bench`] races [`Contestant`]s: schemes, constructions and [`Path`]s. For one mesh and one tessellation factor they
//! draw in turns, A B C A B C, so that a machine that becomes slower or faster does so for all alike, and frame `i` of
//! one is compared with frame `i` of the other. Nothing here knows files or prints.
//!
//! Measured, in milliseconds:
//!
//! * **gpu**: from the first command of a frame to the last, by timestamps of the device: attachments are cleared, the
//!   control points made anew if the vertices [move](Motion), the surface drawn with pixels.
//! * **geometry**: the same with the rasterizer switched off, into attachments of no size to speak of.
//! * **fence**: for each of the two, on the host's clock: recording, submission, and the wait for the fence.
//! * **construction**: geometry at factor 1 less that of the bilinear floor at factor 1: making the control points, and
//!   evaluating the corners of a patch rather than passing them on. No device tells the stages of a draw apart more
//!   closely. Of paths through the tessellation stages, which are the floor's, and not of models that stand
//!   [still](Motion).
//! * **set-up**: tables from the mesh, then buffers, copies to the device and control points that are kept, each the median
//!   of several; pipelines are not in it, but in:
//! * **first use**: making the pipelines, and the first frame with them, in which some drivers compile. Drivers keep what
//!   they compiled on the disk: for a first use in truth, switch that off (Mesa: `MESA_SHADER_CACHE_DISABLE=1`).
//! * **recording** ([`Bench::recording`]): what the host takes to record a frame of many models.

mod cpu;
mod drawable;
mod error;
mod floors;
mod options;
mod published;
mod race;
mod recording;
mod row;
mod scene;
mod shaders {
    //! Compiled from `glsl/bench`.
    include!(concat!(env!("OUT_DIR"), "/bench_shaders.rs"));
}
mod subject;
mod surface;

pub use drawable::{Setup, Traffic};
pub use error::BenchError;
pub use options::{BenchOptions, Camera, Motion};
pub use race::{Bench, Event};
pub use recording::{Crowd, Recording};
pub use row::{Row, Series};
pub use subject::{Subject, Subset};

use crate::adaptive::{DrawnBy, Sums};
use crate::named::named;
use crate::patch::Scheme;
use crate::renderer::{Construction, Cull, Evaluation};

named! {
    /// A way to get the surface drawn.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Path {
        /// The tessellation stages, as [`Renderer`](crate::Renderer) draws.
        Tessellation = Evaluation::Tessellation.name(),
        /// Tessellation stages with ACC as published (Loop and Schaefer 2008), where the evaluation shader makes the tangents: for the scheme
        /// [`Scheme::Acc`] and [`Construction::TwoStage`], to compare with.
        AccPublished = "acc-published",
        /// ACC as published by the vertex shader that evaluates instances of a uniform grid, as [`Path::Instanced`]: for
        /// [`Construction::Cached`].
        AccPublishedInstanced = "acc-published-instanced",
        /// Evaluated by compute once a frame, and drawn as indexed triangles in each pass ([`Evaluation::Compute`]).
        Compute = Evaluation::Compute.name(),
        /// A uniform grid instanced over the patches ([`Evaluation::Instanced`]).
        Instanced = Evaluation::Instanced.name(),
        /// Strips from the geometry shader ([`Evaluation::Geometry`]).
        Geometry = Evaluation::Geometry.name(),
        /// Control points from the geometry shader, then instanced ([`Evaluation::GeometryTwoPass`]).
        GeometryTwoPass = Evaluation::GeometryTwoPass.name(),
        /// Faces subdivided in a geometry shader ([`Evaluation::Subdivision`]): at factors 1, 2, 4 and 8.
        Subdivision = Evaluation::Subdivision.name(),
        /// The limit surface out of the CPU's arrays ([`dice`](crate::dice)), filled anew and copied whenever the vertices move: in the
        /// times by the host's clock, not in those of the device. Factors are rounded up to a power of two, from 2 up.
        Cpu = "cpu",
        /// A floor: the tessellation stages at the same factors, but corners pass through and faces stay bilinear.
        Bilinear = "bilinear",
        /// A floor: triangles that were evaluated before, as they are. The tessellator's own triangles for quads; a plain
        /// grid, which has fewer, for triangles.
        VertexBuffer = "vertex-buffer",
    }
}

impl Path {
    /// Evaluation of the patches; `None` for a floor, and for the CPU's vertices.
    pub fn evaluation(self) -> Option<Evaluation> {
        match self {
            Self::Tessellation | Self::AccPublished => Some(Evaluation::Tessellation),
            Self::Compute => Some(Evaluation::Compute),
            Self::Instanced | Self::AccPublishedInstanced => Some(Evaluation::Instanced),
            Self::Geometry => Some(Evaluation::Geometry),
            Self::GeometryTwoPass => Some(Evaluation::GeometryTwoPass),
            Self::Subdivision => Some(Evaluation::Subdivision),
            Self::Cpu | Self::Bilinear | Self::VertexBuffer => None,
        }
    }

    /// The schemes whose patches it draws; none if it draws no patches.
    pub fn schemes(self) -> &'static [Scheme] {
        match self {
            _ if self.is_published_acc() => &[Scheme::Acc],
            Self::Subdivision | Self::Cpu | Self::Bilinear | Self::VertexBuffer => &[],
            _ => &Scheme::ALL,
        }
    }

    /// The constructions that it goes with; none if it draws no patches.
    pub fn constructions(self) -> &'static [Construction] {
        match self {
            Self::AccPublished => &[Construction::TwoStage],
            Self::Subdivision => &[],
            _ => self.evaluation().map_or(&[], Evaluation::constructions),
        }
    }

    /// Whether [`Bench::recording`] knows it: what the renderer draws by itself.
    pub fn is_recorded(self) -> bool {
        self.evaluation().is_some() && !self.is_published_acc()
    }

    /// Whether it is there to compare with only: ACC as published.
    pub(super) fn is_published_acc(self) -> bool {
        matches!(self, Self::AccPublished | Self::AccPublishedInstanced)
    }

    /// Whether it draws through the tessellation stages.
    pub(super) fn tessellates(self) -> bool {
        self == Self::Bilinear || self.evaluation() == Some(Evaluation::Tessellation)
    }

    /// Whether it does less than draw the surface from control vertices that move: what the others cannot get below.
    pub fn is_floor(self) -> bool {
        matches!(self, Self::Bilinear | Self::VertexBuffer)
    }
}

named! {
    /// Where normals along edges and at corners come from.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[non_exhaustive]
    pub enum Normals {
        /// Each patch has its own.
        #[default]
        Own = "own",
        /// Normals that patches share
        /// ([`ModelOptions::shared_normals`](crate::renderer::ModelOptions::shared_normals)).
        Shared = "shared",
    }
}

named! {
    /// Stage that culls patches.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum CullBy {
        /// The control shader, in each draw ([`Renderer::cmd_draw`](crate::Renderer::cmd_draw)).
        Control = "control",
        /// A compute shader, before the draws of a view ([`Renderer::cmd_cull`](crate::Renderer::cmd_cull)).
        Compute = "compute",
    }
}

impl CullBy {
    /// Stage that culls if none is named: compute where control points are cached.
    pub const fn usual(patches: Option<(Scheme, Construction)>) -> Self {
        match patches {
            Some((_, Construction::Cached)) => Self::Compute,
            _ => Self::Control,
        }
    }
}

named! {
    /// How an adaptive surface follows creases of finite sharpness.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[non_exhaustive]
    pub enum Creases {
        /// Leaves follow them directly; around their ends and corners end caps are at the depth of all others.
        #[default]
        Direct = "direct",
        /// Likewise, but end caps there are as deep as the sharpest crease asks for.
        Deep = "deep",
        /// Faces along them are refined as often as the sharpest asks for.
        Refined = "refined",
    }
}

/// A contestant of a race.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Contestant {
    /// Way to draw the surface.
    pub path: Path,
    /// Scheme and construction of the patches; `None` for floors, subdivision and the CPU's vertices.
    pub patches: Option<(Scheme, Construction)>,
    /// Depth of adaptive subdivision; `None` where each face is one patch of the scheme.
    pub depth: Option<u32>,
    /// How it follows creases, if it is adaptive.
    pub creases: Creases,
    /// What its refined vertices are sums of, if it is adaptive.
    pub sums: Sums,
    /// Part of the surface that a patch of it is, if it is adaptive.
    pub drawn_by: DrawnBy,
    /// Source of its normals.
    pub normals: Normals,
    /// Patches that it culls.
    pub cull: Cull,
    /// Stage that culls them. Without tessellation stages it is compute in any case.
    pub cull_by: CullBy,
}

impl Contestant {
    /// A contestant with each patch's own normals, without culling; `cull_by` is [as usual](CullBy::usual).
    pub const fn new(path: Path, patches: Option<(Scheme, Construction)>) -> Self {
        Self {
            path,
            patches,
            depth: None,
            creases: Creases::Direct,
            sums: Sums::Levels,
            drawn_by: DrawnBy::Faces,
            normals: Normals::Own,
            cull: Cull::NONE,
            cull_by: CullBy::usual(patches),
        }
    }

    /// Variants with each of these normals and cullings that it can be combined with: patches are culled where
    /// [`Evaluation::culls`], by each of these that can (as it is if none are given), and normals shared where the scheme is
    /// watertight and [`Evaluation::shares`]. Floors, and the CPU's vertices, stay as they are.
    pub fn variants(self, normals: &[Normals], culls: &[Cull], cull_by: &[CullBy]) -> Vec<Self> {
        if self.path.evaluation().is_none() {
            return vec![self];
        }
        let culls_any = !self.path.is_published_acc() && self.path.evaluation().is_some_and(Evaluation::culls);
        let shares = match (self.path.evaluation(), self.patches) {
            (Some(evaluation), Some((scheme, construction))) if !self.path.is_published_acc() => {
                scheme.is_watertight() && evaluation.shares(construction)
            }
            _ => false,
        };
        let normals = normals.iter().filter(|&&normals| normals == Normals::Own || shares);
        let own = [self.cull_by];
        let cull_by = if cull_by.is_empty() { &own } else { cull_by };
        let can = |by: &&CullBy| **by == CullBy::Compute || self.path.tessellates();
        let culled = |&cull: &Cull| -> Vec<Self> {
            match cull {
                Cull::NONE => vec![Self { cull, ..self }],
                _ if culls_any => cull_by.iter().filter(can).map(|&cull_by| Self { cull, cull_by, ..self }).collect(),
                _ => Vec::new(),
            }
        };
        let culled: Vec<Self> = culls.iter().flat_map(culled).collect();
        let with = |&normals| culled.iter().map(move |&one| Self { normals, ..one });
        normals.flat_map(with).collect()
    }

    /// The same, and adaptive surfaces of these depths, with each way to follow creases, each kind of sums and each kind of patches,
    /// where the scheme has end caps and the path draws them: patches by leaves where it has tessellation stages.
    pub fn at_depths(self, depths: &[u32], creases: &[Creases], sums: &[Sums], by: &[DrawnBy]) -> Vec<Self> {
        let caps = self.patches.is_some_and(|(scheme, _)| scheme.has_caps());
        let depths = if caps { depths } else { &[] };
        let by: Vec<DrawnBy> =
            by.iter().copied().filter(|&by| by == DrawnBy::Faces || self.path.tessellates()).collect();
        let ways: Vec<_> = sums.iter().flat_map(|&sums| by.iter().map(move |&by| (sums, by))).collect();
        let of = |depth, creases| {
            let way = move |&(sums, drawn_by)| Self { depth: Some(depth), creases, sums, drawn_by, ..self };
            ways.iter().map(way)
        };
        let at = |&depth| creases.iter().flat_map(move |&creases| of(depth, creases));
        [self].into_iter().chain(depths.iter().flat_map(at)).collect()
    }

    /// Each path with each scheme and construction that it can be combined with.
    ///
    /// The first that is no floor is what the others are compared with.
    pub fn all(paths: &[Path], schemes: &[Scheme], constructions: &[Construction]) -> Vec<Self> {
        let of_path = |&path: &Path| -> Vec<Self> {
            if path.schemes().is_empty() {
                return vec![Self::new(path, None)];
            }
            let schemes = schemes.iter().filter(|scheme| path.schemes().contains(scheme));
            let constructions = constructions.iter().filter(|construction| path.constructions().contains(construction));
            let pairs = schemes.flat_map(|&scheme| constructions.clone().map(move |&c| (scheme, c)));
            pairs.map(|pair| Self::new(path, Some(pair))).collect()
        };
        paths.iter().flat_map(of_path).collect()
    }

    /// Whether compute culls patches.
    pub(super) fn culls_by_compute(self) -> bool {
        self.cull != Cull::NONE && (self.cull_by == CullBy::Compute || !self.path.tessellates())
    }

    /// The scheme as the program calls it; `none` without patches.
    pub fn scheme_name(self) -> &'static str {
        self.patches.map_or("none", |(scheme, _)| scheme.name())
    }

    /// The construction as the program calls it; `none` without patches.
    pub fn construction_name(self) -> &'static str {
        self.patches.map_or("none", |(_, construction)| construction.name())
    }
}
