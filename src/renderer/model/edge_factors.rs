//! Tessellation factors that the edges of a model have of their own.

use super::streamed::Streamed;
use crate::gpu::{Buffer, DeviceContext, GpuError};
use crate::renderer::options::{Error, ModelId};
use crate::table::EdgeTable;
use ash::vk;
use std::sync::Arc;

pub(crate) struct EdgeFactors {
    /// The factor of each patch corner's plus edge.
    of_corners: Streamed,
    /// What was last written.
    written: Vec<f32>,
    largest_written: f32,
    /// The largest of what the device has.
    largest: f32,
}

impl EdgeFactors {
    /// All 1.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        name: &str,
        edges: &EdgeTable,
        frames: u32,
    ) -> Result<Self, GpuError> {
        let ones = vec![1.0f32; edges.of_corners.len()];
        Ok(Self {
            of_corners: Streamed::new(context, &format!("{name}: factors of edges"), &ones, 0, frames)?,
            written: ones,
            largest_written: 1.0,
            largest: 1.0,
        })
    }

    /// Takes the factors of all edges, for the copy of this frame.
    pub(crate) fn write(&mut self, id: ModelId, frame: u32, edges: &EdgeTable, factors: &[f32]) -> Result<(), Error> {
        let needed = edges.vertices.len();
        if factors.len() != needed {
            return Err(Error::EdgeFactorCount { id, given: factors.len(), needed });
        }
        if let Some(edge) = factors.iter().position(|factor| !factor.is_finite()) {
            return Err(Error::BadEdgeFactor { id, edge, factor: factors[edge] });
        }
        self.written.clear();
        self.written.extend(edges.of_corners.iter().map(|&edge| factors[edge as usize]));
        self.of_corners.write(frame, &self.written)?;
        self.largest_written = factors.iter().copied().fold(1.0, f32::max);
        Ok(())
    }

    /// What was last written, corner by corner.
    pub(crate) fn written(&self) -> &[f32] {
        &self.written
    }

    /// The largest of what the device has; at least 1.
    pub(crate) fn largest(&self) -> f32 {
        self.largest
    }

    pub(crate) fn is_due(&self) -> bool {
        self.of_corners.is_due()
    }

    /// As [`Streamed::send_again`].
    pub(crate) fn send_again(&mut self, frame: u32) {
        self.of_corners.send_again(frame);
    }

    /// Records the copy that is due, if one is.
    ///
    /// # Safety
    /// As [`Streamed::cmd_send`].
    pub(crate) unsafe fn cmd_send(
        &mut self,
        device: &ash::Device,
        cmd: vk::CommandBuffer,
        frame: u32,
    ) -> Result<(), GpuError> {
        self.largest = self.largest_written;
        // SAFETY: as the caller promises.
        unsafe { self.of_corners.cmd_send(device, cmd, frame, &self.written) }
    }

    pub(crate) fn buffer(&self) -> &Buffer {
        self.of_corners.buffer()
    }

    /// Bytes on the device, and on the host.
    pub(crate) fn bytes(&self) -> [u64; 2] {
        self.of_corners.bytes()
    }
}
