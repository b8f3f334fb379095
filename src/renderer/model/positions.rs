//! The vertices that the shaders of a model read.

use super::gather::PositionRoom;
use super::streamed::Streamed;
use super::{Model, name};
use crate::gpu::{Buffer, DeviceContext, GpuError};
use crate::renderer::options::{DevicePositions, Error};
use crate::table::{ModelTables, TEXEL_BYTES};
use ash::vk;
use std::sync::Arc;

/// Where the vertices come from, and the buffer that shaders read. The host writes them for each frame in which they moved, or the
/// device did, and they are [gathered](super::gather).
pub(crate) struct Positions {
    streamed: Streamed,
    /// To put the vertices in that are then written.
    stored: Vec<[f32; 4]>,
    /// For the device to write them, once it was asked for.
    room: Option<PositionRoom>,
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
        Ok(Self { streamed, stored, room: None })
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

    /// As [`Streamed::supersede`].
    pub(crate) fn supersede(&mut self) {
        self.streamed.supersede();
    }

    /// Room for the device to write the positions of `count` control vertices for a frame, one of `frames` in flight.
    pub(crate) fn room(
        &mut self,
        context: &Arc<DeviceContext>,
        (name, count): (&str, usize),
        [frame, frames]: [u32; 2],
    ) -> Result<DevicePositions, GpuError> {
        let room = match self.room.take() {
            Some(room) => room,
            None => PositionRoom::new(context, name, count, frames)?,
        };
        Ok(self.room.insert(room).of_frame(frame))
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
        let [device, host] = self.streamed.bytes();
        [device + self.room.as_ref().map_or(0, PositionRoom::bytes), host]
    }
}

impl Model {
    pub(crate) fn set_positions(&mut self, frame: u32, control: &[[f32; 3]]) -> Result<(), Error> {
        let needed = self.tables.control_vertices;
        if control.len() != needed {
            return Err(Error::PositionCount { id: self.id, given: control.len(), needed });
        }
        Ok(self.positions.write(frame, &self.tables, control)?)
    }

    /// Checks that the device may give the positions.
    pub(crate) fn check_given(&self) -> Result<(), Error> {
        if self.tables.refines_on_host() { Err(Error::RefinedOnHost { id: self.id }) } else { Ok(()) }
    }

    /// Room for the device to write the positions of a frame, one of `frames` in flight.
    pub(crate) fn position_room(
        &mut self,
        context: &Arc<DeviceContext>,
        frames: [u32; 2],
    ) -> Result<DevicePositions, Error> {
        self.check_given()?;
        let of_model = (name(&self.options), self.tables.control_vertices);
        Ok(self.positions.room(context, of_model, frames)?)
    }
}
