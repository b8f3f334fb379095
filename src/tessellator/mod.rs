//! The tessellator's orders: factors of patches and edges, which patches are culled, and what lies along the edges. On the CPU, in
//! f32 and in the order in which the shaders compute it.
//!
//! Every function here has a GLSL twin of the same name. Where that is `precise` both give the same bits, as far as the driver
//! rounds divisions and square roots as IEEE 754 says.

mod culling;
mod draw;
mod edges;
mod factor;
mod factors;
mod shared;

pub use culling::Examined;
pub use draw::{MeasuredDraw, viewport};
pub use edges::{SharedSample, SharingCorner, share};
pub use factor::{Cull, Factor};
pub use factors::{PatchFactors, map_lod};
pub use shared::{FramedRing, SharedEdge, share_corner};
