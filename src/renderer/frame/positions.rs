//! Positions of control vertices, frame by frame: the host's, or the device's.

use super::{Frame, Renderer};
use crate::renderer::model::Given;
use crate::renderer::options::{DevicePositions, Error, ModelId};

/// Who set the positions of a model in a frame.
pub(super) enum Moved {
    Host,
    /// The device, and what is not recorded yet.
    Device(Option<Given>),
}

impl Renderer {
    /// Moves the control vertices of a model, from the next [`Renderer::cmd_prepare`] of `frame` on until other positions are set.
    /// Object space, one position a vertex of the mesh, in its order. The numbers are not looked at: patches around a vertex that is
    /// NaN or infinite are missing.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`], [`Error::OldFrame`], [`Error::PositionCount`], [`Error::PositionsTwice`].
    pub fn set_positions(&mut self, id: ModelId, frame: Frame, positions: &[[f32; 3]]) -> Result<(), Error> {
        self.check_frame(frame)?;
        let model = self.models.get_mut(&id).ok_or(Error::NoSuchModel { id })?;
        if let Some(Moved::Device(_)) = self.begun.moved.get(&id) {
            return Err(Error::PositionsTwice { id });
        }
        model.set_positions(frame.index(), positions)?;
        self.begun.moved.insert(id, Moved::Host);
        Ok(())
    }

    /// Room for your shaders to write the positions of a model for a frame, if you have no buffer of your own: hand what it gives to
    /// [`Renderer::set_device_positions`] for the same frame. 16 bytes a position, as in an array of `vec4`; each frame in flight has
    /// its own, which nothing reads any more when the frame begins. The buffer has the usages `STORAGE_BUFFER`, `TRANSFER_DST` and
    /// `TRANSFER_SRC`, is made by the first call for a model, and lives as long as the model, or until its mesh changes and
    /// [`Options::frames_in_flight`](crate::renderer::Options::frames_in_flight) frames began since.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`], [`Error::OldFrame`], [`Error::RefinedOnHost`]; failed Vulkan calls.
    pub fn device_positions(&mut self, id: ModelId, frame: Frame) -> Result<DevicePositions, Error> {
        self.check_frame(frame)?;
        let model = self.models.get_mut(&id).ok_or(Error::NoSuchModel { id })?;
        model.position_room(&self.context, [frame.index(), self.options.frames_in_flight])
    }

    /// As [`Renderer::set_positions`], with positions that the device writes: the next [`Renderer::cmd_prepare`] of `frame` reads them,
    /// and they hold until others are set. They are as good as the host's to the bit, for every construction and evaluation; faces of
    /// adaptive surfaces are refined by the device anyway, whole meshes with
    /// [`ModelOptions::refine_on_device`](crate::renderer::ModelOptions::refine_on_device).
    ///
    /// The commands that write them come before those of `cmd_prepare` on the same queue, which computes. Its barriers wait for all writes
    /// of compute shaders and copies before; others you make available to `COMPUTE_SHADER`, `SHADER_READ` yourself. `cmd_prepare` reads
    /// the buffer in that stage, with that access, and nothing reads it after: what writes it next waits for that stage, unless the
    /// frame is known to be done.
    ///
    /// Of a [lost](Renderer::frame_lost) frame, or of one that is not prepared, they are forgotten: the model is as it was before, until
    /// positions are set again.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`], [`Error::OldFrame`], [`Error::PositionsTwice`] if the host set positions for this frame,
    /// [`Error::RefinedOnHost`]; [`Error::NoPositionBuffer`], [`Error::BadPositionLayout`], [`Error::PositionBufferTooSmall`],
    /// [`Error::TableTooLarge`]; failed Vulkan calls. The model is as it was before.
    ///
    /// # Safety
    /// The buffer is of the context's device, was made with the usage `STORAGE_BUFFER`, has memory and as many bytes as is said, and
    /// lives until the device is done with the frame.
    pub unsafe fn set_device_positions(
        &mut self,
        id: ModelId,
        frame: Frame,
        positions: DevicePositions,
    ) -> Result<(), Error> {
        self.check_frame(frame)?;
        let model = self.models.get(&id).ok_or(Error::NoSuchModel { id })?;
        model.check_given()?;
        if let Some(Moved::Host) = self.begun.moved.get(&id) {
            return Err(Error::PositionsTwice { id });
        }
        let (count, code) = (model.tables.control_vertices, &self.pipelines.draws.shaders);
        // SAFETY: as the caller promises.
        let given = unsafe { self.pipelines.gather.give(id, count, positions, code)? };
        self.begun.moved.insert(id, Moved::Device(Some(given)));
        Ok(())
    }
}
