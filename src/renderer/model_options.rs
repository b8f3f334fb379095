//! How one model is drawn.

use super::DisplacementId;
use crate::gpu::{Features, Spacing};
use crate::patch::{Fallback, Scheme};

/// How the control points are made on the GPU. All give the same points but for rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Construction {
    /// The vertex shader turns each control vertex and its one-ring into limit point and tangents, the control shader
    /// assembles the patch. The smaller tables.
    #[default]
    TwoStage,
    /// The control shader sums the vertices around the patch with the weights of its type of connectivity.
    Stencil,
    /// The two stages in compute shaders, once a frame in which the vertices moved: each ring, then each patch. Draws read the
    /// control points. Takes memory, and pays where a model is drawn in several passes or stands still. Needs a queue that
    /// computes, but for [`Evaluation::GeometryTwoPass`], which sums with weights.
    Cached,
}

impl Construction {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::TwoStage, Self::Stencil, Self::Cached];

    /// As the program calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::TwoStage => "two-stage",
            Self::Stencil => "stencil",
            Self::Cached => "cached",
        }
    }
}

/// What evaluates the patches.
///
/// All but the tessellation stages and subdivision evaluate on a lattice with the same number of segments along every edge,
/// from 1 to 1024: they are for [`Spacing::Equal`] and [`Factor::Uniform`](super::Factor::Uniform), or for factors of edges
/// ([`ModelOptions::edge_factors`]) of which the largest holds inside patches. Where patches share positions to the last bit, they
/// do so here; for normals and displacement see [`Evaluation::shares`], for patches that are left out [`Evaluation::culls`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Evaluation {
    /// The tessellation stages, in each draw anew.
    #[default]
    Tessellation,
    /// A compute shader, once a frame in which the vertices or the segments changed
    /// ([`Renderer::set_segments`](super::Renderer::set_segments)). Draws are of indexed triangles. Takes memory for the vertices,
    /// and pays where a model is drawn in several passes or stands still.
    Compute,
    /// The vertex shader, in each draw anew: one lattice of indexed triangles is instanced over the patches (the Direct3D 10
    /// path of Loop et al. 2009). Its segments are those of [`Renderer::set_segments`](super::Renderer::set_segments).
    Instanced,
    /// The geometry shader, in each draw anew: it makes the control points and emits the patch as strips of triangles.
    Geometry,
    /// In two passes (Ni et al. 2008): the geometry shader makes the control points once a frame in which the vertices moved, then
    /// they are evaluated as by [`Evaluation::Instanced`]. Needs no queue that computes.
    GeometryTwoPass,
    /// No patches: a geometry shader subdivides each face by the Catmull-Clark rules, straight from the control vertices, in each
    /// draw anew (Antal et al. 2007). The [`Factor`](super::Factor) is `Uniform`: 1, 2, 4 or 8 segments along every edge, for 0
    /// to 3 levels. Vertices are those of the refined mesh, not limit points, with the normals of limit points; creases and
    /// corners of finite sharpness are followed as far as the levels go. Neighbouring faces share positions to the bit.
    ///
    /// A mesh with faces that are no quads is refined once before. Scheme, fallback, construction and spacing have no say.
    Subdivision,
}

impl Evaluation {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Tessellation, Self::Compute, Self::Instanced, Self::Geometry, Self::GeometryTwoPass, Self::Subdivision];

    /// As the program calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tessellation => "tessellation",
            Self::Compute => "compute",
            Self::Instanced => "instanced",
            Self::Geometry => "geometry",
            Self::GeometryTwoPass => "geometry-two-pass",
            Self::Subdivision => "subdivision",
        }
    }

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

    /// Whether draws can leave out patches ([`Cull`](super::Cull)): by
    /// [`Renderer::cmd_cull`](super::Renderer::cmd_cull), the tessellation stages by themselves, too.
    pub fn culls(self) -> bool {
        matches!(self, Self::Tessellation | Self::Instanced)
    }

    /// Whether [`Renderer::set_segments`](super::Renderer::set_segments) has to say how many segments edges have.
    pub fn needs_segments(self) -> bool {
        matches!(self, Self::Compute | Self::Instanced | Self::GeometryTwoPass)
    }

    /// What the device must have for it, besides what everything needs.
    pub fn features(self) -> Features {
        Features {
            geometry: matches!(self, Self::Geometry | Self::GeometryTwoPass | Self::Subdivision),
            vertex_stores: self == Self::GeometryTwoPass,
            ..Features::NONE
        }
    }
}

/// How one model is drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelOptions {
    /// The debug name.
    pub name: String,
    /// Which patches faces become.
    pub scheme: Scheme,
    /// What becomes of faces that the scheme has no patches for.
    pub fallback: Fallback,
    /// How the control points are made.
    pub construction: Construction,
    /// What evaluates the patches.
    pub evaluation: Evaluation,
    /// Where the tessellator puts its vertices along an edge.
    pub spacing: Spacing,
    /// Give neighbouring patches the same normals along their edges and at their corners, to the last bit: positions are the
    /// same in any case. Costs table memory and 10 to 25 % of the geometry's time; displacement needs it.
    ///
    /// For schemes that are watertight ([`Scheme::is_watertight`]).
    pub shared_normals: bool,
    /// Move the surface along its normal by what a map says, a height map or one of vectors
    /// ([`Renderer::add_displacement`](super::Renderer::add_displacement)); draws say how far
    /// ([`DrawItem::displacement`](super::DrawItem::displacement)). The mesh has to have texture coordinates. Normals are
    /// shared then in any case.
    pub displacement: Option<DisplacementId>,
    /// Let edges have tessellation factors of their own ([`Factor::Edges`](super::Factor::Edges)).
    pub edge_factors: bool,
    /// Steps of Catmull-Clark refinement before patches are made. Faces with five or more corners need one, and get it.
    pub refine: u32,
}
