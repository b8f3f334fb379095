//! What the GPU reads, as plain arrays: which patches there are, and for each construction the connectivity that its
//! shaders walk. Nothing here knows Vulkan; nothing here depends on positions.

mod cpu;
mod plan;
mod prepare;
mod rings;
mod stencils;

pub use cpu::{CpuSurface, grid_parameters};
pub use plan::{Patch, PatchPlan};
pub use prepare::{FaceOrigin, Notice, Prepared, prepare};
pub use rings::RingTable;
pub use stencils::StencilTable;

/// Bytes of a table's array.
pub(crate) fn bytes<T>(array: &[T]) -> u64 {
    size_of_val(array) as u64
}
