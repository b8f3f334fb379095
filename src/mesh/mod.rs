//! Control meshes: what they are, how they are checked, and how files and built-in shapes become one; repair of what is not.

mod adjacency;
mod animation;
mod check;
mod control_mesh;
mod edits;
mod error;
#[cfg(feature = "gltf")]
mod gltf;
mod limits;
mod obj;
mod ply;
mod read;
mod repair;
mod rules;
mod shapes;
pub mod write;

pub use animation::{Animations, Skinning};
pub(crate) use check::MAX_CORNERS;
pub use control_mesh::{ControlMesh, Corner, Crease, FaceVarying, MeshData, SHARPNESS_INFINITE};
pub use edits::{Change, Edit, MAX_EDIT_LEVEL};
pub use error::MeshError;
#[cfg(feature = "gltf")]
pub use gltf::GltfOptions;
pub use limits::Limits;
pub use obj::ObjOptions;
pub use read::{Animated, ReadOptions, read, read_animated, read_repaired};
pub use repair::{Place, Repair, RepairKind, RepairOptions, Repairs, repair};
pub use rules::{BoundaryRule, CreaseMethod, FaceVaryingRule, Package, TriangleRule};
pub use shapes::{ShapeInfo, animated_shape, grid_torus, replicate, shape, shapes};

pub(crate) use adjacency::NO_TWIN;
