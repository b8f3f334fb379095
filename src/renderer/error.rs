use super::ModelId;
use crate::gpu::GpuError;
use crate::mesh::MeshError;
use crate::table::TableError;

/// What can go wrong in the renderer.
#[allow(missing_docs, reason = "the messages say it")]
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error(transparent)]
    Table(#[from] TableError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error("{device}: missing {}: choose another device, or options that need less", missing.join(", "))]
    Unsupported { device: String, missing: Vec<String> },
    #[error("model {}: there is no such model: it was removed, or is another renderer's", id.0)]
    NoSuchModel { id: ModelId },
    #[error("model {}: {given} positions are given, but its control mesh has {needed} vertices", id.0)]
    PositionCount { id: ModelId, given: usize, needed: usize },
    #[error("model {}: {table} take {bytes} bytes, but a shader can see {max} at once on this device: split the mesh", id.0)]
    TableTooLarge { id: ModelId, table: &'static str, bytes: u64, max: u64 },
    #[error("model {}: it was not yet prepared: record cmd_prepare after add_model and before cmd_draw", id.0)]
    NotPrepared { id: ModelId },
    #[error("frame index {given}: Options::frames_in_flight is {frames}, so frames are 0 to {}", frames - 1)]
    NoSuchFrame { given: u32, frames: u32 },
    #[error("{max} views were already drawn in frame {frame}: raise Options::views_per_frame")]
    TooManyViews { frame: u32, max: u32 },
    #[error("style {given}: Options::styles has {count}")]
    NoSuchStyle { given: usize, count: usize },
    #[error("model {}: the tessellation factor {factor} is no number from 1 up", id.0)]
    BadFactor { id: ModelId, factor: f32 },
    #[error("grid {given}: the tessellator of this device makes from 2 to {max} samples along a side")]
    BadGrid { given: u32, max: u32 },
    #[error("{what} of Options is {given}: it must be at least 1")]
    BadOption { what: &'static str, given: u32 },
}
