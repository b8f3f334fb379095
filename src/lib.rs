//! Catmull-Clark control meshes, drawn smooth by Vulkan's tessellation stages.

pub mod mesh;

pub use mesh::{ControlMesh, MeshData, MeshError, ShapeInfo, grid_torus, replicate, shape, shapes};
