//! What the GPU reads, as plain arrays: which patches there are, and for each construction the connectivity that its
//! shaders walk. Nothing here knows Vulkan; nothing here depends on positions.
//!
//! Loop et al. (2009, figures 7 and 8) keep these tables in textures. Here they are storage buffers, and those of the two-stage
//! construction and the positions texel buffers, too, in texels of up to four numbers: what shaders read by, where the device has
//! texel buffers that are large enough for any table
//! ([`DeviceProperties::reads_texels`](crate::gpu::DeviceProperties::reads_texels)).

mod bytes;
mod cells;
mod cpu;
mod edges;
mod error;
mod hulls;
mod leaves;
mod model;
mod options;
mod patch_id;
mod pieces;
mod plan;
mod prepare;
mod rings;
mod shared;
mod sharing;
mod stencils;
mod steps;
mod subdivision;
mod uniform_grid;
mod wedges;

pub(crate) use bytes::bytes;
pub use cells::{CurvePart, Parts};
#[cfg(feature = "measure")]
pub(crate) use cpu::in_wedge;
pub use cpu::{CpuSurface, grid_parameters};
pub use edges::{EdgeRecord, EdgeTable};
pub use error::TableError;
pub use leaves::{LeafTable, Refinement, RefinementStep};
pub(crate) use model::TEXEL_BYTES;
pub use model::{ModelTables, TableBytes};
pub use options::{Construction, Evaluation, TableOptions};
pub use patch_id::{FaceOrigin, PatchId};
pub use plan::{Patch, PatchGroup, PatchPlan};
pub(crate) use prepare::prepare_for;
pub use prepare::{Notice, Prepared, Step, prepare, prepare_patches, prepare_quads};
pub use rings::RingTable;
pub(crate) use shared::SHARED_WORDS;
pub use shared::{SharedTable, SharedTexcoord};
pub(crate) use sharing::Sharing;
pub use stencils::StencilTable;
pub use subdivision::SubdivisionTable;
pub(crate) use uniform_grid::{
    MAX_SEGMENTS, TILE_VERTICES, UniformGridIndices, uniform_grid_tiles, uniform_grid_vertices,
};
