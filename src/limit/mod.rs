//! Catmull-Clark subdivision itself, which the patch schemes approximate: refinement by its rules, and the exact limit
//! surface.

mod local;
mod masks;
mod refine;
mod surface;

pub use refine::{Refined, Stencils, refine};
pub use surface::{LimitSample, LimitSurface};
