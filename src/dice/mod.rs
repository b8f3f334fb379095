//! The limit surface as a mesh, on the CPU.
//!
//! One step of refinement turns every face into quads, the *facets*: one for each face corner. Each facet is evaluated on its own,
//! in parallel, at a grid of points as deep as it was asked for; neighbours of different depths are stitched.
//!
//! * **Facets.** Almost all are bicubic B-spline patches, which are evaluated directly. For every other *kind* of facet (its
//!   connectivity, and what is sharp) the sums that refine it are made once: three of its quarters are B-spline patches in turn, or
//!   all are, and so on as deep as is asked. Corners are limit points by limit masks.
//! * **Exactness.** Positions and normals are those of [`LimitSurface`](crate::limit::LimitSurface) but for rounding.
//! * **Edges are owned.** The deeper facet beside an edge writes its vertices, both index them: the mesh is closed where the control
//!   mesh is, with every vertex there once. Along infinitely sharp creases and seams of texture coordinates, vertices have *copies*
//!   with the same position.
//! * **Moving vertices.** [`Tessellation::update`] fills the same arrays again.
//!
//! ```
//! use ash_subdiv::{dice::{DiceOptions, Tessellation}, shape, topology::Topology};
//! let cube = shape("cube")?;
//! let mesh = Tessellation::<f32>::new(&Topology::new(&cube), &DiceOptions::fixed(3))?;
//! assert_eq!(mesh.quads().len(), 6 * 64);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bend;
mod bicubic;
mod bounds;
mod depth;
mod displace;
mod error;
mod evaluate;
mod faces;
mod fill;
mod finer;
mod kinds;
mod layout;
mod options;
mod patches;
mod place;
mod plan;
mod real;
mod sectors;
mod strays;
mod stream;
mod sums;
mod tessellation;
mod texcoords;

pub use error::DiceError;
pub use fill::VerticesMut;
pub use options::{Camera, Depth, DiceOptions, MAX_DEPTH};
pub use place::Place;
pub use plan::{Plan, Sizes};
pub use real::Real;
pub use stream::{Piece, Stream};
pub use tessellation::Tessellation;
