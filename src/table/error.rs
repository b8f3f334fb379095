use super::Evaluation;
use crate::adaptive::AdaptiveError;
use crate::mesh::MeshError;
use crate::patch::{Scheme, Undefined};

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
    /// There is no plan of adaptive subdivision.
    #[error(transparent)]
    Adaptive(#[from] AdaptiveError),
    /// Adaptive subdivision in an evaluation without patches.
    #[error("evaluation by {} has no patches: it cannot be adaptive", evaluation.name())]
    NotAdaptive {
        /// The evaluation that was asked for.
        evaluation: Evaluation,
    },
    /// Patches by leaves in another evaluation than the tessellation stages.
    #[error("evaluation by {} has no patches by leaves: only by {} there are such; draw by faces", evaluation.name(), Evaluation::Tessellation.name())]
    NotByLeaves {
        /// The evaluation that was asked for.
        evaluation: Evaluation,
    },
    /// Shared normals of a scheme that is not watertight.
    #[error("the scheme {} has no edges that both patches evaluate alike: for shared normals and displacement choose gregory", scheme.name())]
    NothingShared {
        /// The scheme that was asked for.
        scheme: Scheme,
    },
    /// Refinement by the device of a mesh that has edits of vertices.
    #[error("refine_on_device: the mesh has edits of vertices at finer levels, which the host makes: let it refine")]
    EditsOnDevice,
    /// Displacement of a mesh without texture coordinates.
    #[error(
        "the mesh has no texture coordinates, which displacement looks up: give it some (vt in OBJ, TEXCOORD_0 in glTF)"
    )]
    NoTexcoords,
}
