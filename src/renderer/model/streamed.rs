//! A buffer that the host may write anew for each frame.

use crate::gpu::{Buffer, BufferDesc, DeviceContext, GpuError, MemoryLocation};
use ash::vk;
use bytemuck::NoUninit;
use std::sync::Arc;

/// An array on the device, and a copy for each frame that may be on the device.
pub(crate) struct Streamed {
    buffer: Buffer,
    staged: Buffer,
    /// Bytes of the array.
    size: u64,
    /// The frame whose copy is the newest, if that was not sent.
    pending: Option<u32>,
    /// Whether any was.
    sent: bool,
}

impl Streamed {
    /// With these contents in all frames, and room for `more` bytes on the device, which the device fills.
    pub(crate) fn new<T: NoUninit>(
        context: &Arc<DeviceContext>,
        name: &str,
        contents: &[T],
        more: u64,
        frames: u32,
    ) -> Result<Self, GpuError> {
        // A buffer of no bytes is no buffer, and one of no texels no texel buffer.
        let size = (size_of_val(contents) as u64).max(16);
        let buffer = Buffer::new(
            context,
            &BufferDesc {
                name,
                size: size + more,
                usage: vk::BufferUsageFlags::STORAGE_BUFFER
                    | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER
                    | vk::BufferUsageFlags::TRANSFER_DST,
                location: MemoryLocation::DeviceLocal,
            },
        )?;
        let mut staged = Buffer::new(
            context,
            &BufferDesc {
                name: &format!("{name} to copy"),
                size: size * u64::from(frames),
                usage: vk::BufferUsageFlags::TRANSFER_SRC,
                location: MemoryLocation::Upload,
            },
        )?;
        for frame in 0..u64::from(frames) {
            staged.write(frame * size, contents)?;
        }
        Ok(Self { buffer, staged, size, pending: None, sent: false })
    }

    /// Takes new contents, for the copy of this frame.
    pub(crate) fn write<T: NoUninit>(&mut self, frame: u32, contents: &[T]) -> Result<(), GpuError> {
        self.staged.write(u64::from(frame) * self.size, contents)?;
        self.pending = Some(frame);
        Ok(())
    }

    /// Has the copy of this frame sent again, which was lost.
    pub(crate) fn send_again(&mut self, frame: u32) {
        self.pending = Some(frame);
    }

    /// Has the device keep what it has of its own, whatever was written before.
    pub(crate) fn supersede(&mut self) {
        (self.pending, self.sent) = (None, true);
    }

    pub(crate) fn is_due(&self) -> bool {
        self.pending.is_some() || !self.sent
    }

    /// Records the copy that is due, if one is. `newest` is what was written last: another frame's copy of it must not be sent by
    /// this frame, which gets its own.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering.
    pub(crate) unsafe fn cmd_send<T: NoUninit>(
        &mut self,
        device: &ash::Device,
        cmd: vk::CommandBuffer,
        frame: u32,
        newest: &[T],
    ) -> Result<(), GpuError> {
        if self.pending.is_some_and(|pending| pending != frame) {
            self.write(frame, newest)?;
        }
        // Before the first copy every frame's holds the first contents, or newer ones.
        if self.is_due() {
            let src_offset = u64::from(frame) * self.size;
            let region = vk::BufferCopy { src_offset, dst_offset: 0, size: self.size };
            // SAFETY: as the caller promises; both buffers hold the range.
            unsafe { device.cmd_copy_buffer(cmd, self.staged.raw(), self.buffer.raw(), &[region]) };
        }
        self.pending = None;
        self.sent = true;
        Ok(())
    }

    /// What is on the device.
    pub(crate) fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// Bytes on the device, and on the host.
    pub(crate) fn bytes(&self) -> [u64; 2] {
        [self.buffer.size(), self.staged.size()]
    }
}
