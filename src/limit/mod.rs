//! Catmull-Clark subdivision itself, which the patch schemes approximate: refinement by its rules, and the exact limit
//! surface.

mod face_varying;
mod local;
mod masks;
mod refine;
mod stencils;
mod surface;

pub use refine::{Refined, refine};
pub use stencils::Stencils;
pub use surface::{LimitSample, LimitSurface};
