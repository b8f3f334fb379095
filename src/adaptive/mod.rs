//! Feature-adaptive subdivision: which faces refine where, and the leaves that remain, as plain arrays.
//!
//! After Niessner, Loop, Meyer and DeRose 2012, with the creases of Niessner, Loop and Greiner 2012 (patch_maths F and G):
//! faces around *features* (extraordinary vertices, faces that are no quads, darts, corners, creases whose sharpness varies) are
//! refined, level by level. What is left are *leaves*, cells of a quadtree over each face's (u, v): bicubic B-spline patches,
//! with a crease along one edge or without, which are the limit surface itself; and around features at the last level end caps,
//! Gregory patches.
//!
//! **Parameters.** As [`LimitSurface`](crate::limit::LimitSurface) has them: a quad is one *root*, a face of another size has a
//! root of level 1 for each corner.
//!
//! **Exactness.** [`LeafKind::Regular`] and [`LeafKind::SingleCrease`] are the limit surface but for rounding, whatever the
//! depth. A [`LeafKind::Cap`] is the chosen scheme's patch of a face that is refined as often as its level says. It goes
//! through the limits of its corners, also at darts and where sharpness is finite (there not by Chaikin's method); but for that
//! it draws sharpness as the scheme does ([`SHARP_FROM`](crate::topology::SHARP_FROM)).
//!
//! **Neighbours.** Across an edge two leaves differ by at most one level while both depths of [`AdaptiveOptions`] are the same.
//! Two rules see to that, and refine more than the surface needs:
//! * all faces around a feature are refined, also those beyond an infinitely sharp crease;
//! * by Chaikin's method, a single crease has to be constant one edge further.
//!
//! Exceptions: faces other than quads are refined at depth 0 too, so their leaves of level 1 meet end caps of level 0; with two
//! depths, caps at the lesser one meet cells up to the greater.

mod alone;
mod build;
mod caps;
mod counts;
mod crease;
mod error;
mod evaluate;
mod feature;
mod few;
mod finish;
mod grids;
mod leaves;
mod level;
mod look;
mod numbering;
mod options;
mod plan;
mod rows;

pub(crate) use caps::POINTS as CAP_POINTS;
pub use counts::LevelCounts;
pub use error::AdaptiveError;
pub use feature::Reason;
pub(crate) use grids::{fill, grid, is_boundary};
pub use options::{AdaptiveOptions, DrawnBy, MAX_DEPTH, Sums};
pub use plan::{LEAF, Leaf, LeafKind, Plan, RefinedCell, Root};
pub use rows::{Block, Mask, Rows};
