//! Built-in control meshes, by name.
mod creature;
mod sculpt;
use super::{ControlMesh, MeshData, MeshError};
pub fn shape(_name: &str) -> Result<ControlMesh, MeshError> {
    let (positions, face_vertices) = creature::build();
    ControlMesh::new(MeshData { positions, face_sizes: vec![4; face_vertices.len() / 4], face_vertices, ..MeshData::default() })
}
