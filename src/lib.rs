//! Catmull-Clark control meshes, drawn smooth by Vulkan's tessellation stages.

pub mod gpu;
#[cfg(feature = "headless")]
pub mod headless;
pub mod limit;
pub mod mesh;
pub mod patch;
pub mod table;
pub mod topology;

pub use mesh::{ControlMesh, MeshData, MeshError};
