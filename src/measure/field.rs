//! The error at every point of a uniform grid, to be shown where it is.

use super::surfaces::{Face, Surfaces, angle};
use crate::mesh::MeshError;
use crate::table::{CpuSurface, grid_parameters};

/// Quantity that an error is measured of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Distance between the points with the same parameters, in the mesh's own units.
    Position,
    /// Angle between the normals at the same parameters, in radians; 0 where either surface has none.
    Normal,
}

/// Errors of the patches of a surface against the limit surface: for each patch, in the order of
/// [`CpuSurface::plan`], the error at each of its [`grid_parameters`], `n` along a side.
///
/// On triangles and pentagons "the same parameters" are a convention, that of [`surface_errors`](super::surface_errors).
///
/// ```
/// use ash_subdiv::measure::{Quantity, error_field};
/// use ash_subdiv::{Scheme, shape, table::CpuSurface};
/// let cube = shape("cube")?;
/// let surface = CpuSurface::new(&cube, Scheme::Gregory, 0)?;
/// let field = error_field(&surface, Quantity::Position, 5)?;
/// // Corners are on the limit surface, centres are not.
/// assert!(field[0][0] < 1e-12 && field[0][12] > 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Coordinates beyond those of [`LimitSurface::new`](crate::limit::LimitSurface::new).
///
/// # Panics
/// If `n` is below 2.
pub fn error_field(surface: &CpuSurface, quantity: Quantity, n: u32) -> Result<Vec<Vec<f64>>, MeshError> {
    let patches = surface.plan().patches();
    let faces = patches.iter().map(|patch| Face::of(surface.prepared(), patch)).collect();
    let surfaces = Surfaces { topology: surface.prepared().whole(), faces, schemes: Vec::new() };
    let samples = surface.grid(&surface.control_points(|p| p), n);
    surfaces.for_each(|limit, patch| {
        let kind = patches[patch].kind;
        let error = |(&point, sample): (&[f64; 2], &crate::patch::Sample<_>)| {
            let truth = surfaces.limit(limit, patch, surfaces.faces[patch].parameters(point));
            match quantity {
                Quantity::Position => truth.position.distance(sample.position),
                Quantity::Normal => angle(truth.normal, sample.normal).unwrap_or(0.0),
            }
        };
        grid_parameters(kind, n).iter().zip(&samples[patch]).map(error).collect()
    })
}
