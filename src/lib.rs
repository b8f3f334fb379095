//! Catmull-Clark control meshes, drawn smooth by Vulkan's tessellation stages.

pub mod limit;
pub mod mesh;
pub mod patch;
pub mod table;
pub mod topology;

pub use mesh::{ControlMesh, MeshData, MeshError};
