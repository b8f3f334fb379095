//! Patch schemes: how control points come from control vertices, and how a patch is evaluated from them.
//!
//! Every construction is linear in the control vertices, and is written once over values that can be [`Blend`]ed:
//! with [`DVec3`](glam::DVec3) it gives reference control points, with [`Vec3`](glam::Vec3) those of the CPU path,
//! with [`Row`] the weights of a stencil. Every function of a surface here has a GLSL twin of the same name.
//!
//! Parameters: a quad with corners `V_0..V_3` has `V_0` at (u, v) = (0, 0), `V_1` at (1, 0), `V_2` at (1, 1) and `V_3`
//! at (0, 1). A triangle has barycentric (u, v, w), u = 1 at `V_0`, v = 1 at `V_1`, w = 1 at `V_2`. Normals point to
//! the side from which the corners are counter-clockwise. At corner k the *plus* edge leads to corner k + 1, the
//! *minus* edge to corner k - 1.

pub mod acc;
pub mod edge;
mod fallback;
mod fallback_rings;
pub mod fitted;
#[allow(dead_code, reason = "what is left is for the shaders")]
mod form;
pub mod gregory;
pub mod pm;
mod scheme;

pub(crate) use crate::blend::unit_normal;
pub use crate::blend::{Blend, Frame, PatchCorner, Point, RingShape, RingValues, Row, Sample, bicubic};
pub use fallback::Fallback;
pub use fallback_rings::FallbackRings;
pub(crate) use form::PatchForm;
pub use scheme::{Scheme, Undefined};
