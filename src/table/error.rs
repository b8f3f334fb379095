use crate::mesh::MeshError;
use crate::patch::Undefined;

/// Why a mesh could not become patches.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// The mesh, or a table of it, is too large.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The scheme has no patch for a face.
    #[error(transparent)]
    Undefined(#[from] Undefined),
}
