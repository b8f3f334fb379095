//! The thin layer over Vulkan: device facts, memory, buffers, images, shaders and pipelines. It knows nothing of
//! meshes, and owns only what it creates.
//!
//! * [`DeviceContext`] is the device all objects are made from, with its [`DeviceProperties`], its allocator and its
//!   debug names. Its constructor is where the one safety contract of this layer is stated.
//! * [`Buffer`], [`Image`] and [`Owned`] handles destroy themselves when dropped, and keep their context alive.
//! * [`GraphicsPipelineDesc`] and [`ComputePipelineDesc`] make pipelines.
//! * [`PatchBatch`] says how many patches one draw instance may hold, which some drivers limit.

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
pub use batch::{Domain, PatchBatch, PatchDraw, Spacing, tessellated_vertices};
pub use buffer::{Buffer, BufferDesc};
pub use descriptors::{DescriptorPool, DescriptorSet};
pub use device::{ContextOptions, DeviceContext, DeviceProperties, MAX_OFFSET_ALIGNMENT, MAX_WORKGROUPS, version_text};
pub use error::{GpuError, VkResultExt};
pub use features::Features;
pub use image::{Image, ImageDesc, aspects};
#[cfg(all(test, feature = "headless"))]
pub(crate) use layout::demand;
pub use layout::{SetLayout, descriptor_set_layout, pipeline_layout};
pub use owned::{DeviceHandle, Owned};
pub use pipeline::{Blend, ComputePipelineDesc, DepthBias, DepthState, GraphicsPipelineDesc, RenderTarget};
pub use stages::{Shader, Specialization};
