//! Instances of an item.

use super::{Error, ModelId};
use crate::gpu::MAX_OFFSET_ALIGNMENT;
use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::Mat4;
use std::ops::Range;

/// One of many copies of an item in a draw, with what it has of its own. GLSL twin: `instance_four` in `glsl/lib/draw/draw.glsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Instance {
    /// The first three rows of the matrix from object to world, as in `VkTransformMatrixKHR`; in place of
    /// [`DrawItem::transform`](super::DrawItem::transform). Affine.
    pub transform: [[f32; 4]; 3],
    /// Linear RGBA of all patches, in place of [`DrawItem::colors`](super::DrawItem::colors).
    pub color: [f32; 4],
    /// Words for your own shaders, in place of [`DrawItem::words`](super::DrawItem::words): `draw_words()` in
    /// `glsl/lib/draw/draw.glsl`.
    pub words: [u32; 4],
}

/// Bytes of an instance.
const INSTANCE_BYTES: u64 = size_of::<Instance>() as u64;
const _: () = assert!(INSTANCE_BYTES == 80);

impl Instance {
    /// With a matrix by columns, in light grey.
    pub fn new(transform: &[[f32; 4]; 4]) -> Self {
        let matrix = Mat4::from_cols_array_2d(transform);
        let transform = [0, 1, 2].map(|i| matrix.row(i).into());
        Self { transform, color: [0.7, 0.7, 0.7, 1.0], words: [0; 4] }
    }
}

/// The instances of a [`DrawItem`](super::DrawItem), in a buffer: yours, or that of
/// [`Renderer::instances`](crate::renderer::Renderer::instances).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instances {
    buffer: vk::Buffer,
    size: u64,
    offset: u64,
    stride: u32,
    count: u32,
    /// The frame and the renderer, if they are the renderer's.
    frame: Option<[u64; 2]>,
}

impl Instances {
    /// Instances in a buffer of yours of `size` bytes: `count` times an [`Instance`] from `offset` on, every `stride` bytes, both
    /// multiples of 4. The device may write them, but their number is the host's to say.
    ///
    /// # Safety
    /// Whenever they are drawn, the buffer is of the context's device, was made with the usage `STORAGE_BUFFER`, has memory and as many
    /// bytes as is said, and lives until the device is done with the frame. What writes the instances is made available to
    /// `SHADER_READ` in the stages of the draws.
    pub unsafe fn in_buffer(buffer: vk::Buffer, size: u64, offset: u64, stride: u32, count: u32) -> Self {
        Self { buffer, size, offset, stride, count, frame: None }
    }

    /// Those of a renderer in a frame, one after the other.
    pub(crate) fn in_frame(frame: [u64; 2], buffer: vk::Buffer, size: u64, offset: u64, count: u32) -> Self {
        Self { buffer, size, offset, stride: INSTANCE_BYTES as u32, count, frame: Some(frame) }
    }

    /// Number of instances.
    pub fn count(self) -> u32 {
        self.count
    }

    pub(crate) fn buffer(self) -> vk::Buffer {
        self.buffer
    }

    pub(crate) fn frame(self) -> Option<[u64; 2]> {
        self.frame
    }

    /// The word of the first instance among the bytes that are seen, and the words from one to the next.
    pub(crate) fn words(self, seen: &Range<u64>) -> [u32; 2] {
        [((self.offset - seen.start) / 4) as u32, self.stride / 4]
    }

    /// The bytes of the buffer that shaders see: of the caller's from where any device lets a descriptor start, of the crate's all.
    ///
    /// # Errors
    /// [`Error::NoInstanceBuffer`], [`Error::BadInstanceLayout`], [`Error::InstanceBufferTooSmall`], [`Error::TableTooLarge`] if
    /// they are more than a shader sees at once.
    pub(crate) fn seen(self, id: ModelId, max: u64) -> Result<Range<u64>, Error> {
        let Self { buffer, offset, stride, size, count, frame } = self;
        if buffer == vk::Buffer::null() {
            return Err(Error::NoInstanceBuffer { id });
        }
        if !offset.is_multiple_of(4) || !stride.is_multiple_of(4) || u64::from(stride) < INSTANCE_BYTES {
            return Err(Error::BadInstanceLayout { id, offset, stride });
        }
        let needed = offset.saturating_add(u64::from(stride) * u64::from(count.saturating_sub(1)) + INSTANCE_BYTES);
        if needed > size {
            return Err(Error::InstanceBufferTooSmall { id, size, needed });
        }
        let seen = if frame.is_some() { 0..size } else { offset - offset % MAX_OFFSET_ALIGNMENT..needed };
        let bytes = seen.end - seen.start;
        if bytes > max {
            return Err(Error::TableTooLarge { id, table: INSTANCES, bytes, max });
        }
        Ok(seen)
    }
}

/// What grows with instances.
pub(crate) const INSTANCES: &str = "instances of an item";
