//! The buffer that the shaders write to.

use super::CapturedVertex;
use crate::constants;
use crate::gpu::{Buffer, BufferDesc, DeviceContext, GpuError, MemoryLocation};
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;

/// The head of the buffer. GLSL twin: `glsl/lib/capture/capture.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Head {
    pub first_patch: u32,
    pub patches: u32,
    pub grid: u32,
    pub capacity: u32,
    pub count: u32,
}

pub(super) const HEAD_BYTES: u64 = size_of::<Head>() as u64;
pub(super) const RECORD_BYTES: u64 = size_of::<CapturedVertex>() as u64;
/// Words that the control points of a patch take, whatever its kind, and its factors after them.
pub(super) const CONTROL_POINT_WORDS: usize = constants::CONTROL_POINT_WORDS as usize;
pub(super) const FACTOR_WORDS: usize = constants::FACTOR_WORDS as usize;
pub(super) use crate::constants::EDGES_ONLY;

const _: () = assert!(RECORD_BYTES == 4 * constants::RECORD_WORDS as u64 && HEAD_BYTES == 20);

pub(super) fn capture_buffer(context: &Arc<DeviceContext>, size: u64) -> Result<Buffer, GpuError> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    Buffer::new(context, &BufferDesc { name: "capture", size, usage, location: MemoryLocation::Readback })
}
