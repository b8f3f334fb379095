//! Evaluations besides the tessellation stages.

mod check;
mod indices;
mod lattice;
pub(crate) mod subdivision;

pub(crate) use check::check_evaluation;
#[cfg(all(feature = "measure", feature = "headless"))]
pub(crate) use indices::topology;
pub(crate) use lattice::{BoundLattice, Lattice, LatticePipelines};
