//! Positions of control vertices in a buffer of the device.

use super::{Error, ModelId};
use crate::gpu::MAX_OFFSET_ALIGNMENT;
use ash::vk;
use std::ops::Range;

/// Positions of a model's control vertices in a buffer: three `f32` each, in object space, one position a vertex of the mesh that
/// the model was made of, in its order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DevicePositions {
    /// The buffer, with the usage `STORAGE_BUFFER`.
    pub buffer: vk::Buffer,
    /// Bytes before the first position; a multiple of 4.
    pub offset: u64,
    /// Bytes from one position to the next; a multiple of 4, from 12 up. Those after the first 12 are not looked at.
    pub stride: u32,
    /// Bytes of the whole buffer.
    pub size: u64,
}

/// Bytes of a position.
const POSITION_BYTES: u64 = 12;

impl DevicePositions {
    /// The bytes of the buffer that a shader sees to read `count` positions: from where any device lets a descriptor start.
    ///
    /// # Errors
    /// [`Error::NoPositionBuffer`], [`Error::BadPositionLayout`], [`Error::PositionBufferTooSmall`], [`Error::TableTooLarge`] if
    /// they are more than a shader sees at once.
    pub(crate) fn seen(self, id: ModelId, count: usize, max: u64) -> Result<Range<u64>, Error> {
        let Self { buffer, offset, stride, size } = self;
        if buffer == vk::Buffer::null() {
            return Err(Error::NoPositionBuffer { id });
        }
        if !offset.is_multiple_of(4) || !stride.is_multiple_of(4) || u64::from(stride) < POSITION_BYTES {
            return Err(Error::BadPositionLayout { id, offset, stride });
        }
        let last = u64::from(stride) * count.saturating_sub(1) as u64;
        let needed = offset.saturating_add(last + POSITION_BYTES);
        if needed > size {
            return Err(Error::PositionBufferTooSmall { id, size, needed });
        }
        let seen = offset - offset % MAX_OFFSET_ALIGNMENT..needed;
        let bytes = seen.end - seen.start;
        if bytes > max {
            return Err(Error::TableTooLarge { id, table: "positions on the device", bytes, max });
        }
        Ok(seen)
    }
}
