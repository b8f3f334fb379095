//! Weighted sums of control vertices, of which limit masks and patches alike are made: values that can be summed, one-rings of
//! them with their tangent frames, Bezier curves, and the regular patch, which is the limit surface itself.
//!
//! Nothing here knows a scheme. The public names are those of [`patch`](crate::patch).

pub(crate) mod bezier;
pub mod bicubic;
mod corner;
mod point;
mod ring;
mod values;

pub(crate) use bezier::{
    Basis, CurveBasis, TensorCorner, cubic, curve_point, curve_slope, evaluate_tensor, seen_from_ends,
    tensor_derivatives,
};
pub(crate) use corner::CornerRings;
pub use corner::PatchCorner;
pub use point::{Point, Sample};
pub(crate) use point::{scalar, unit_normal};
pub(crate) use ring::tangent_scale;
pub use ring::{Frame, RingShape, RingValues};
pub use values::{Blend, Row};
