//! What the GPU reads, as plain arrays: which patches there are, and for each construction the connectivity that its
//! shaders walk. Nothing here knows Vulkan; nothing here depends on positions.
//!
//! Loop et al. (2009, figures 7 and 8) keep these tables in textures. Here they are storage buffers. Measured on
//! lavapipe with the monster frog (1292 patches, factor 1, rasterizer discard, ten draws a frame, medians of 61 frames,
//! three runs of each, alternating, on a busy machine): tables as texel buffers 14.7, 14.0, 13.2 ms, as storage buffers
//! 14.5, 14.3, 17.3 ms (two-stage); 13.9, 12.7, 12.4 against 13.1, 12.9, 17.5 ms (stencil). No difference above the
//! noise, and texel buffers may end at 65 536 elements.

mod cpu;
mod error;
mod lattice;
mod plan;
mod prepare;
mod rings;
mod shared;
mod stencils;
mod subdivision;

pub use cpu::{CpuSurface, grid_parameters};
pub use error::TableError;
pub(crate) use lattice::{
    MAX_SEGMENTS, TILE_VERTICES, lattice_indices, lattice_tiles, lattice_triangles, lattice_vertices,
};
pub use plan::{Patch, PatchGroup, PatchPlan};
pub use prepare::{FaceOrigin, Notice, Prepared, prepare, prepare_patches, prepare_quads};
pub use rings::RingTable;
pub use shared::{SharedCorner, SharedTable, SharedTexcoord};
pub use stencils::StencilTable;
pub use subdivision::SubdivisionTable;

/// Bytes of a table's array.
pub(crate) fn bytes<T>(array: &[T]) -> u64 {
    size_of_val(array) as u64
}
