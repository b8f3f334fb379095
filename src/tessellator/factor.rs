//! What tessellation factors come from, and which patches are culled.

use crate::constants::{METRIC_CURVATURE, METRIC_EDGES, METRIC_PIXELS, METRIC_UNIFORM};
/// Where the tessellation factors of a draw come from.
///
/// The factor of an edge depends on the edge alone, so both its patches have the same; the inside of a patch takes the larger
/// of those of opposite edges. Factors are kept from 1 to what the device has (64 at least). With
/// [`Spacing::FractionalOdd`](crate::Spacing::FractionalOdd) or `FractionalEven` nothing pops when they change.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Factor {
    /// This for every edge and inside.
    Uniform(f32),
    /// Segments about this many pixels long, of the projected curve of each edge. Needs
    /// [`View::viewport`](crate::renderer::View::viewport).
    Pixels(f32),
    /// Segments that stray from their edge's curve by about this many pixels: few where it is flat, more where it is bent,
    /// and most where the bend is seen from the side, as on silhouettes. Needs [`View::viewport`](crate::renderer::View::viewport).
    Curvature(f32),
    /// Those of [`Renderer::set_edge_factors`](crate::renderer::Renderer::set_edge_factors), times this.
    Edges(f32),
    /// The model's own segments ([`Renderer::set_segments`](crate::renderer::Renderer::set_segments)), where
    /// [`Evaluation::needs_segments`](crate::renderer::Evaluation::needs_segments).
    Segments,
}

impl From<f32> for Factor {
    fn from(factor: f32) -> Self {
        Self::Uniform(factor)
    }
}

impl Factor {
    /// Number in it; 1 in [`Factor::Segments`].
    pub fn value(self) -> f32 {
        match self {
            Self::Uniform(x) | Self::Pixels(x) | Self::Curvature(x) | Self::Edges(x) => x,
            Self::Segments => 1.0,
        }
    }

    /// Whether the number makes sense.
    pub(crate) fn is_valid(self) -> bool {
        let x = self.value();
        match self {
            Self::Uniform(_) => x >= 1.0,
            _ => x > 0.0 && x.is_finite(),
        }
    }

    pub(crate) fn needs_viewport(self) -> bool {
        matches!(self, Self::Pixels(_) | Self::Curvature(_))
    }

    /// Its number in a draw's flags.
    pub(crate) fn metric(self) -> u32 {
        match self {
            Self::Uniform(_) | Self::Segments => METRIC_UNIFORM,
            Self::Pixels(_) => METRIC_PIXELS,
            Self::Curvature(_) => METRIC_CURVATURE,
            Self::Edges(_) => METRIC_EDGES,
        }
    }
}

/// Patches that are culled: by the control shader, or before by compute ([`Renderer::cmd_cull`](crate::renderer::Renderer::cmd_cull)). No
/// choice changes the factors of the patches that stay.
///
/// Pm- and c-patches are never culled, triangles only by the frustum and as small.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Cull {
    /// Patches beyond a plane of the view frustum; their hull grows by what displacement can move them.
    pub frustum: bool,
    /// Patches all of whose triangles face away: as the style culls triangles ([`Style::cull`](crate::renderer::Style::cull)), so that the
    /// picture is the same; or, if it culls none, patches whose inside is seen, which are hidden if the surface is closed. More are found where
    /// patches have many segments. Not done where the surface is displaced, nor in parallel
    /// projections. Views that mirror say so ([`View::mirrored`](crate::renderer::View::mirrored)).
    pub back: bool,
    /// Patches between the centres of pixels. For one sample a pixel, and filled triangles. Needs
    /// [`View::viewport`](crate::renderer::View::viewport). Not done where the surface is displaced.
    pub small: bool,
}

impl Cull {
    /// None.
    pub const NONE: Self = Self { frustum: false, back: false, small: false };
    /// All of them.
    pub const ALL: Self = Self { frustum: true, back: true, small: true };
}
