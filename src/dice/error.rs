use super::options::MAX_DEPTH;
use crate::mesh::MeshError;

/// Why a mesh is not tessellated.
#[allow(missing_docs, reason = "the messages say it")]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiceError {
    #[error(
        "depth {depth}: a mesh is subdivided once at least, and {MAX_DEPTH} times at most: choose 1 to {MAX_DEPTH}"
    )]
    BadDepth { depth: u32 },
    #[error("depths are given for {given} facets, but the mesh has {facets}, one a face corner")]
    DepthCount { given: usize, facets: usize },
    #[error("{what} {value}: give a number above zero")]
    NotPositive { what: &'static str, value: f64 },
    #[error("the tessellation has {count} {what}, of which {max} can be addressed: choose a lesser depth")]
    TooLarge { what: &'static str, count: u64, max: u64 },
    #[error("{what} are given for {given} vertices, but there are {count}")]
    Count { what: &'static str, given: usize, count: usize },
    #[error("the mesh has no texture coordinates, by which a height map is read: add some")]
    NoTexcoords,
    #[error("the mesh has no face that is drawn: all of them are holes, or touch a boundary that is not drawn")]
    NothingDrawn,
    #[error(transparent)]
    Mesh(#[from] MeshError),
}
