//! Connectivity without positions: manifold vertices, ordered one-rings, sharp edges and patch classes.

mod classes;
mod half_edges;
mod ring;
mod rings;

pub use classes::{PatchKind, draws_face};
pub use half_edges::{SHARP_FROM, Topology};
pub use ring::{Place, Ring, RingKind};
