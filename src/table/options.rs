//! What tables are built for.

use super::Sharing;
#[cfg(doc)]
use crate::Spacing;
use crate::adaptive::{AdaptiveOptions, DrawnBy};
use crate::named::named;
use crate::patch::{Fallback, Scheme};

named! {
    /// How the control points are made on the GPU. All give the same points but for rounding.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[non_exhaustive]
    pub enum Construction {
        /// The vertex shader turns each control vertex and its one-ring into limit point and tangents, the control shader
        /// assembles the patch. The smaller tables.
        #[default]
        TwoStage = "two-stage",
        /// The control shader sums the vertices around the patch with the weights of its type of connectivity.
        Stencil = "stencil",
        /// The two stages in compute shaders, once a frame in which the vertices moved: each ring, then each patch. Draws read the
        /// control points. Takes memory, and pays where a model is drawn in several passes or stands still. Needs a queue that
        /// computes, but for [`Evaluation::GeometryTwoPass`], which sums with weights.
        Cached = "cached",
    }
}

named! {
    /// What evaluates the patches.
    ///
    /// All but the tessellation stages and subdivision evaluate on a uniform grid with the same number of segments along every edge,
    /// from 1 to 1024, or with factors of edges ([`TableOptions::edge_factors`]) of which the largest holds inside patches: they are for
    /// [`Spacing::Equal`], and for [`Factor::Segments`](crate::tessellator::Factor::Segments) where [`Evaluation::needs_segments`]. Where patches share positions to the last bit, they
    /// do so here; for normals and displacement see [`Evaluation::shares`], for culling [`Evaluation::culls`].
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[non_exhaustive]
    pub enum Evaluation {
        /// The tessellation stages, in each draw anew.
        #[default]
        Tessellation = "tessellation",
        /// A compute shader, once a frame in which the vertices or the segments changed
        /// (`Renderer::set_segments`). Draws are of indexed triangles. Takes memory for the vertices,
        /// and pays where a model is drawn in several passes or stands still.
        Compute = "compute",
        /// The vertex shader, in each draw anew: one uniform grid of indexed triangles is instanced over the patches (the Direct3D 10
        /// path of Loop et al. 2009). Its segments are those of `Renderer::set_segments`.
        Instanced = "instanced",
        /// The geometry shader, in each draw anew: it makes the control points and emits the patch as strips of triangles.
        Geometry = "geometry",
        /// In two passes (Ni et al. 2008): the geometry shader makes the control points once a frame in which the vertices moved, then
        /// they are evaluated as by [`Evaluation::Instanced`]. Needs no queue that computes.
        GeometryTwoPass = "geometry-two-pass",
        /// No patches: a geometry shader subdivides each face by the Catmull-Clark rules, straight from the control vertices, in each
        /// draw anew (Antal et al. 2007). The [`Factor`](crate::tessellator::Factor) is `Uniform`: 1, 2, 4 or 8 segments along every edge, for 0
        /// to 3 levels. Vertices are those of the refined mesh, not limit points, with the normals of limit points; creases and
        /// corners of finite sharpness are followed as far as the levels go. Neighbouring faces share positions to the bit.
        ///
        /// A mesh with faces that are no quads is refined once before. Scheme, fallback, construction and spacing have no say.
        Subdivision = "subdivision",
    }
}

impl Evaluation {
    /// The constructions that it goes with, the usual one first.
    pub fn constructions(self) -> &'static [Construction] {
        match self {
            Self::Tessellation | Self::Subdivision => &Construction::ALL,
            Self::Compute | Self::Instanced | Self::GeometryTwoPass => &[Construction::Cached],
            Self::Geometry => &[Construction::Stencil, Construction::Cached],
        }
    }

    /// Whether patches that are made so can share more than positions: normals, and where they are displaced.
    pub fn shares(self, construction: Construction) -> bool {
        match self {
            Self::Tessellation => true,
            Self::Compute | Self::Instanced | Self::Geometry => construction == Construction::Cached,
            Self::GeometryTwoPass | Self::Subdivision => false,
        }
    }

    /// Whether draws can cull patches ([`Cull`](crate::tessellator::Cull)): by `Renderer::cmd_cull`, the tessellation stages by themselves,
    /// too.
    pub fn culls(self) -> bool {
        matches!(self, Self::Tessellation | Self::Instanced)
    }

    /// Whether the segments of edges have to be set before the draw, by `Renderer::set_segments`.
    pub fn needs_segments(self) -> bool {
        matches!(self, Self::Compute | Self::Instanced | Self::GeometryTwoPass)
    }
}

/// What tables are built for: how a model is drawn, as far as its tables depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TableOptions {
    /// The patches that faces become.
    pub scheme: Scheme,
    /// The patches of faces that the scheme has none for.
    pub fallback: Fallback,
    /// The construction of the control points.
    pub construction: Construction,
    /// The evaluation of the patches.
    pub evaluation: Evaluation,
    /// Whether neighbouring patches share normals.
    pub shared_normals: bool,
    /// Whether the surface is displaced; neighbouring patches share normals then in any case.
    pub displaced: bool,
    /// Whether edges have tessellation factors of their own.
    pub edge_factors: bool,
    /// Steps of Catmull-Clark refinement before patches are made.
    pub refine: u32,
    /// Whether the device refines, where the whole mesh is.
    pub refine_on_device: bool,
    /// Depth of adaptive subdivision, if irregular faces are refined where they have to be.
    pub adaptive: Option<AdaptiveOptions>,
}

impl TableOptions {
    pub(crate) fn sharing(self) -> Sharing {
        match (self.displaced, self.shared_normals) {
            (true, _) => Sharing::Displacement,
            (false, true) => Sharing::Normals,
            (false, false) => Sharing::Positions,
        }
    }

    /// Whether patches are leaves of adaptive subdivision.
    pub(crate) fn is_by_leaves(self) -> bool {
        self.adaptive.is_some_and(|adaptive| adaptive.drawn_by == DrawnBy::Leaves)
    }
}
