//! How finely patches are cut, and which are left out.

use super::gpu_data::{CULL_BACK_FLAG, CULL_FRUSTUM_FLAG, CULL_SMALL_FLAG, METRIC_SHIFT};

/// Where the tessellation factors of a draw come from.
///
/// The factor of an edge depends on the edge alone, so both its patches have the same; the inside of a patch takes the larger
/// of those of opposite edges. Factors are kept from 1 to what the device has (64 at least). With
/// [`Spacing::FractionalOdd`](crate::Spacing::FractionalOdd) or `FractionalEven` nothing pops when they change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Factor {
    /// This for every edge and inside.
    Uniform(f32),
    /// Segments about this many pixels long, of the projected curve of each edge. Needs
    /// [`View::viewport`](super::View::viewport).
    Pixels(f32),
    /// Segments that stray from their edge's curve by about this many pixels: few where it is flat, more where it is bent,
    /// and most where the bend is seen from the side, as on silhouettes. Needs [`View::viewport`](super::View::viewport).
    Curvature(f32),
    /// Those of [`Renderer::set_edge_factors`](super::Renderer::set_edge_factors), times this.
    Edges(f32),
}

impl From<f32> for Factor {
    fn from(factor: f32) -> Self {
        Self::Uniform(factor)
    }
}

impl Factor {
    /// The number in it.
    pub fn value(self) -> f32 {
        match self {
            Self::Uniform(x) | Self::Pixels(x) | Self::Curvature(x) | Self::Edges(x) => x,
        }
    }

    /// Whether the number makes sense.
    pub(super) fn is_valid(self) -> bool {
        let x = self.value();
        match self {
            Self::Uniform(_) => x >= 1.0,
            _ => x > 0.0 && x.is_finite(),
        }
    }

    pub(super) fn needs_viewport(self) -> bool {
        matches!(self, Self::Pixels(_) | Self::Curvature(_))
    }

    pub(super) fn flags(self) -> u32 {
        let metric = match self {
            Self::Uniform(_) => 0,
            Self::Pixels(_) => 1,
            Self::Curvature(_) => 2,
            Self::Edges(_) => 3,
        };
        metric << METRIC_SHIFT
    }
}

/// Which patches the control shader leaves out. No choice changes the factors of the patches that stay.
///
/// Pm- and c-patches are never left out, triangles only by the frustum and as small.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Cull {
    /// Those beyond a plane of the view frustum; their hull grows by what displacement can move them.
    pub frustum: bool,
    /// Those that face away as a whole: the picture is the same if the style culls back faces, or if what lies in front hides
    /// them. Not done where the surface is displaced, nor in parallel projections.
    pub back: bool,
    /// Those between the centres of pixels. For one sample a pixel, and filled triangles. Needs
    /// [`View::viewport`](super::View::viewport). Not done where the surface is displaced.
    pub small: bool,
}

impl Cull {
    /// None.
    pub const NONE: Self = Self { frustum: false, back: false, small: false };
    /// All of them.
    pub const ALL: Self = Self { frustum: true, back: true, small: true };

    pub(super) fn flags(self) -> u32 {
        let flag = |on: bool, flag: u32| if on { flag } else { 0 };
        flag(self.frustum, CULL_FRUSTUM_FLAG) | flag(self.back, CULL_BACK_FLAG) | flag(self.small, CULL_SMALL_FLAG)
    }
}
