//! Rows: results of a race.

use super::{Camera, Contestant, Setup, Traffic};
use crate::measure::statistics::Estimate;
use crate::renderer::TableBytes;

/// Frame by frame, in milliseconds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// On the device, from the first command to the last.
    pub device: Vec<f64>,
    /// On the host's clock, with recording, submission and the wait for the fence.
    pub host: Vec<f64>,
}

/// Result of one contestant at one factor.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Row {
    /// Who.
    pub contestant: Contestant,
    /// Camera that it was drawn from.
    pub camera: Camera,
    /// The factor.
    pub factor: f32,
    /// Patches that a frame draws, in all instances and passes.
    pub patches: u64,
    /// Invocations of the evaluation stage in a frame; `None` if the device cannot count.
    pub evaluations: Option<u64>,
    /// Invocations of compute shaders in a frame.
    pub computed: Option<u64>,
    /// Triangles in a frame, before clipping. Where grids are strips (see
    /// [`DeviceProperties::indices_at_once`](crate::gpu::DeviceProperties::indices_at_once)) those that join their rows count, too.
    pub triangles: Option<u64>,
    /// Triangles that clipping left.
    pub visible: Option<u64>,
    /// Frames with pixels.
    pub gpu: Series,
    /// Frames without rasterization.
    pub geometry: Series,
    /// Time to make the control points, in milliseconds (see the module); `None` without the bilinear floor, for floors
    /// and paths without the tessellation stages, and if the vertices do not move.
    pub construction: Option<Estimate>,
    /// Set-up before the first frame.
    pub setup: Setup,
    /// Everything that drawing reads.
    pub bytes: Vec<TableBytes>,
    /// Bytes that a frame moves.
    pub traffic: Traffic,
}
