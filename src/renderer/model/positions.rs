//! The vertices that the shaders of a model read.

use super::streamed::Streamed;
use crate::gpu::{Buffer, DeviceContext, GpuError};
use crate::table::{ModelTables, TEXEL_BYTES};
use ash::vk;
use std::sync::Arc;

/// Where the vertices come from, and the buffer that shaders read: the host's, which refines them and writes them for each
/// frame in which they moved. Nothing else of a model knows that; a buffer that the device writes would be another source here.
pub(crate) struct Positions {
    streamed: Streamed,
    /// To put the vertices in that are then written.
    stored: Vec<[f32; 4]>,
}

impl Positions {
    /// For these positions of the control vertices, in all frames.
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        name: &str,
        tables: &ModelTables,
        control: &[[f32; 3]],
        frames: u32,
    ) -> Result<Self, GpuError> {
        let mut stored = Vec::new();
        tables.store_positions(control, &mut stored);
        let refined = TEXEL_BYTES * (tables.stored_vertices() - stored.len()) as u64;
        let streamed = Streamed::new(context, &format!("{name}: positions"), &stored, refined, frames)?;
        Ok(Self { streamed, stored })
    }

    /// Takes positions of the control vertices, for the copy of this frame.
    pub(crate) fn write(&mut self, frame: u32, tables: &ModelTables, control: &[[f32; 3]]) -> Result<(), GpuError> {
        tables.store_positions(control, &mut self.stored);
        self.streamed.write(frame, &self.stored)
    }

    /// Whether the device's are out of date.
    pub(crate) fn is_due(&self) -> bool {
        self.streamed.is_due()
    }

    /// As [`Streamed::send_again`].
    pub(crate) fn send_again(&mut self, frame: u32) {
        self.streamed.send_again(frame);
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
        // SAFETY: as the caller promises.
        unsafe { self.streamed.cmd_send(device, cmd, frame, &self.stored) }
    }

    /// What shaders read.
    pub(crate) fn buffer(&self) -> &Buffer {
        self.streamed.buffer()
    }

    /// Bytes on the device, and on the host.
    pub(crate) fn bytes(&self) -> [u64; 2] {
        self.streamed.bytes()
    }
}
