//! The thin layer over Vulkan: device facts, memory, and what an `ash` renderer hands over. It knows nothing of meshes.
//!
//! * [`DeviceContext`] is the device all objects are made from, with its [`DeviceProperties`], its [`Allocator`] and its
//!   debug names. Its constructor is where the one safety contract of this layer is stated.
//! * [`Features`] names the device features that options need, [`GpuError`] the object that a Vulkan call failed for.
//! * [`Blend`], [`DepthState`] and [`DepthBias`] are parts of a [`Style`](crate::Style).
//!
//! Buffers, images, descriptors and pipelines are the crate's own business; tools find them in `headless::objects` (feature
//! `headless`).

#![cfg_attr(not(feature = "headless"), allow(dead_code, reason = "tools use the rest"))]

mod allocator;
mod batch;
mod buffer;
mod descriptors;
mod device;
mod error;
mod features;
mod image;
mod layout;
mod owned;
mod pipeline;
mod stages;

pub use allocator::{Allocation, AllocationRequest, Allocator, AllocatorError, Dedicated, MemoryLocation};
pub use batch::{PatchBatch, PatchDraw, Spacing};
pub use device::{ContextOptions, DeviceContext, DeviceProperties};
pub use error::GpuError;
pub use features::Features;
pub use pipeline::{Blend, DepthBias, DepthState};

pub(crate) use device::{MAX_OFFSET_ALIGNMENT, MAX_WORKGROUPS};
#[cfg(all(test, feature = "headless"))]
pub(crate) use layout::demand;
pub(crate) use objects::*;

/// What the crate makes of a device; public in `headless`.
pub(crate) mod objects {
    pub use super::batch::{Domain, tessellated_vertices};
    pub use super::buffer::{Buffer, BufferDesc};
    pub use super::descriptors::{DescriptorPool, DescriptorSet};
    #[cfg(feature = "headless")]
    pub use super::device::version_text;
    pub use super::error::VkResultExt;
    pub use super::image::{Image, ImageDesc, aspects};
    pub use super::layout::{SetLayout, descriptor_set_layout, pipeline_layout};
    pub use super::owned::Owned;
    pub use super::pipeline::{ComputePipelineDesc, GraphicsPipelineDesc, RenderTarget};
    pub use super::stages::{Shader, Specialization};
}
