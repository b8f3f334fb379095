//! Catmull-Clark subdivision itself, which the patch schemes approximate: refinement by its rules, and the exact limit
//! surface.

mod face_varying;
mod fan;
mod local;
mod masks;
mod refine;
mod sharpness;
mod stencils;
mod surface;

pub(crate) use fan::{Fan, FanRows, Fans, LEVELS};
pub use refine::{Refined, refine};
pub(crate) use sharpness::EdgeProfile;
pub use stencils::Stencils;
pub use surface::{LimitSample, LimitSurface};
