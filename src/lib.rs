//! Catmull-Clark control meshes, drawn smooth by Vulkan's tessellation stages.

#[cfg(feature = "headless")]
pub mod capture;
pub mod gpu;
#[cfg(feature = "headless")]
pub mod headless;
pub mod limit;
pub mod mesh;
pub mod patch;
pub mod renderer;
pub mod table;
pub mod topology;

pub use gpu::{Allocator, ContextOptions, DeviceContext, Spacing};
#[cfg(feature = "gltf")]
pub use mesh::GltfOptions;
pub use mesh::{
    ControlMesh, MeshData, MeshError, ObjOptions, ReadOptions, ShapeInfo, grid_torus, replicate, shape, shapes,
};
pub use patch::Scheme;
pub use renderer::{
    Construction, DrawItem, Error, ModelId, ModelOptions, Options, Renderer, Style, Target, View, check, requirements,
};
