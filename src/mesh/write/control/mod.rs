//! Control meshes, written to files that are read back as the same mesh: OBJ with tags, PLY and GLB with polygons.

#[cfg(feature = "gltf")]
mod glb;
mod obj;
mod ply;
mod split;

#[cfg(feature = "gltf")]
pub use glb::write_glb;
pub use obj::write_obj;
pub use ply::write_ply;

use crate::mesh::ControlMesh;

/// The vertex that each face corner names.
fn corners_of(mesh: &ControlMesh) -> impl Iterator<Item = &[u32]> {
    (0..mesh.face_count() as u32).map(|face| mesh.face(face))
}

#[cfg(all(test, feature = "gltf"))]
mod tests;
