//! Catmull-Clark subdivision itself: refinement by its rules, which the patch schemes approximate.

mod refine;

pub use refine::{Refined, Stencils, refine};
