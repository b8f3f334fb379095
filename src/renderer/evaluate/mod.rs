//! Evaluations: each a file, which [`path`](path::path) finds.

mod check;
mod compute;
mod drawn;
mod geometry;
mod indices;
mod instanced;
mod path;
mod recorder;
pub(crate) mod subdivision;
mod tessellation;
mod two_pass;
mod uniform_grid;

pub(crate) use check::check_evaluation;
pub(crate) use drawn::{Asked, Drawn};
pub(crate) use indices::SharedIndices;
#[cfg(all(feature = "measure", feature = "headless"))]
pub(crate) use indices::topology;
pub(crate) use path::path;
pub(crate) use recorder::{Bound, DrawnGroup, Place, PlacedInstances, Recorder};
pub(crate) use uniform_grid::{BoundUniformGrid, UniformGrid, UniformGridPipelines};
