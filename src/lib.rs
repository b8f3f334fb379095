//! Catmull-Clark control meshes, drawn smooth by Vulkan's tessellation stages.

pub mod gpu;
#[cfg(feature = "headless")]
pub mod headless;
pub mod mesh;

pub use mesh::{ControlMesh, MeshData, MeshError};
