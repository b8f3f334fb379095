//! How one model is drawn.

use super::DisplacementId;
use crate::adaptive::AdaptiveOptions;
use crate::gpu::Spacing;
use crate::patch::{Fallback, Scheme};
use crate::table::{Construction, Evaluation, TableOptions};

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
    /// ([`Renderer::add_displacement`](crate::renderer::Renderer::add_displacement)); draws say how far
    /// ([`DrawItem::displacement`](crate::renderer::DrawItem::displacement)). The mesh has to have texture coordinates. Normals are
    /// shared then in any case.
    pub displacement: Option<DisplacementId>,
    /// Let edges have tessellation factors of their own ([`Factor::Edges`](crate::renderer::Factor::Edges)).
    pub edge_factors: bool,
    /// Steps of Catmull-Clark refinement before patches are made. Faces with five or more corners need one, and get it, but where
    /// end caps are patches of the scheme ([`Scheme::has_caps`](crate::Scheme::has_caps)): there they and the faces around them are drawn
    /// by their leaves, which needs a queue that computes.
    pub refine: u32,
    /// Let the device do the whole mesh's steps of refinement, which the host does otherwise each time that positions are set: in
    /// single precision, as all that follows. Needs a queue that computes, and memory for the weights; no edits of vertices at finer levels. It is for
    /// [positions of the device](crate::renderer::Renderer::set_device_positions), and costs nothing where no steps are needed.
    pub refine_on_device: bool,
    /// Refine irregular faces where they have to be, and draw the limit surface itself but for end caps at this depth: see
    /// [`adaptive`](crate::adaptive). Still one patch a face, or a triangle an edge where faces are no quads. Needs a queue
    /// that computes.
    pub adaptive: Option<AdaptiveOptions>,
}

impl ModelOptions {
    /// Default options with an evaluation and its usual construction ([`Evaluation::constructions`]).
    pub fn evaluated(evaluation: Evaluation) -> Self {
        let construction = evaluation.constructions().first().copied().unwrap_or_default();
        Self { construction, evaluation, ..Self::default() }
    }
}

impl From<&ModelOptions> for TableOptions {
    fn from(options: &ModelOptions) -> Self {
        let &ModelOptions {
            scheme,
            fallback,
            construction,
            evaluation,
            shared_normals,
            edge_factors,
            refine,
            refine_on_device,
            adaptive,
            ..
        } = options;
        let displaced = options.displacement.is_some();
        Self {
            scheme,
            fallback,
            construction,
            evaluation,
            shared_normals,
            displaced,
            edge_factors,
            refine,
            refine_on_device,
            adaptive,
        }
    }
}
