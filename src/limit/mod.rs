//! Catmull-Clark subdivision itself, which the patch schemes approximate: refinement by its rules, and the exact limit
//! surface.

mod edits;
mod face_varying;
mod fan;
mod local;
mod masked;
mod masks;
mod part;
mod refine;
mod sample;
mod sharpness;
mod stencils;
mod step;
mod surface;

pub(crate) use edits::VertexEdits;
pub(crate) use face_varying::value_mesh;
pub(crate) use fan::{Fan, FanRows, Fans};
pub(crate) use local::{Local, with_rings};
pub(crate) use masked::{MaskedRows, Masks};
pub(crate) use masks::{corner_masks, dart_edge, dart_frame};
pub(crate) use part::{Part, refine_part};
pub use refine::{Refined, refine};
pub use sample::LimitSample;
pub(crate) use sharpness::{EdgeProfile, LEVELS, is_semi_sharp};
pub use stencils::Stencils;
pub use surface::LimitSurface;
pub(crate) use surface::is_semi_sharp_at;
