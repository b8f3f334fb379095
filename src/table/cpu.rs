//! The CPU twin: every patch of a mesh, constructed and evaluated on the host.

use super::{FaceOrigin, Notice, PatchPlan, Prepared, TableError, prepare_patches};
use crate::blend::{Blend, Point, Sample, scalar};
use crate::mesh::ControlMesh;
use crate::patch::{Fallback, Scheme};
use crate::topology::PatchKind;
use glam::DVec3;
use rayon::prelude::*;

/// The patches of a mesh on the CPU, in the order in which the two-stage construction stores them.
///
/// ```
/// use ash_subdiv::{Scheme, shape, table::CpuSurface};
/// let torus = shape("torus")?;
/// let surface = CpuSurface::new(&torus, Scheme::Gregory, 0)?;
/// let points = surface.control_points(|position| position);
/// let samples = surface.grid(&points, 5);
/// assert_eq!(samples[0].len(), 25);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct CpuSurface {
    prepared: Prepared,
    plan: PatchPlan,
}

impl CpuSurface {
    /// Prepares `mesh` as [`prepare_patches`] does, with at least `refine` steps of refinement.
    ///
    /// # Errors
    /// A refined mesh that cannot be addressed; faces that the scheme has no patch for.
    pub fn new(mesh: &ControlMesh, scheme: Scheme, refine: u32) -> Result<Self, TableError> {
        Self::with_fallback(mesh, scheme, Fallback::Refuse, refine)
    }

    /// As [`CpuSurface::new`], but for what becomes of faces that the scheme has no patch for.
    ///
    /// # Errors
    /// As [`CpuSurface::new`].
    pub fn with_fallback(
        mesh: &ControlMesh,
        scheme: Scheme,
        fallback: Fallback,
        refine: u32,
    ) -> Result<Self, TableError> {
        let (prepared, plan) = prepare_patches(mesh, scheme, fallback, refine)?;
        Ok(Self { prepared, plan })
    }

    /// The patches, in the order of the tables.
    pub fn plan(&self) -> &PatchPlan {
        &self.plan
    }

    /// The mesh that the patches are of.
    pub fn prepared(&self) -> &Prepared {
        &self.prepared
    }

    /// What a user will want to know about how the mesh is drawn.
    pub fn notices(&self) -> Vec<Notice> {
        self.prepared.notices(&self.plan)
    }

    /// Where each patch comes from.
    pub fn origins(&self) -> Vec<FaceOrigin> {
        self.plan.origins()
    }

    /// The control points of every patch, combined from `value` of each position.
    pub fn control_points<T: Blend + Send>(&self, value: impl Fn(DVec3) -> T + Sync) -> Vec<Vec<T>> {
        let (mesh, topology) = (self.prepared.mesh(), self.prepared.topology());
        let of_patch = |patch: &super::Patch| {
            patch.control_points(topology, self.plan.fallback_rings(), |vertex| value(mesh.position(vertex)))
        };
        self.plan.patches().par_iter().map(of_patch).collect()
    }

    /// Every patch at the parameters of [`grid_parameters`].
    ///
    /// # Panics
    /// If `points` are not those of all patches, or `n` is below 2.
    pub fn grid<P: Point>(&self, points: &[Vec<P>], n: u32) -> Vec<Vec<Sample<P>>> {
        assert_eq!(points.len(), self.plan.patches().len(), "control points of every patch");
        let grids = PatchKind::ALL.map(|kind| grid_parameters(kind, n));
        let patches = self.plan.patches().par_iter().zip(points);
        let scalar = scalar::<P>;
        let sample = |(patch, points): (&super::Patch, &Vec<P>)| {
            let parameters = grids[patch.kind as usize].iter();
            parameters.map(|&[u, v]| patch.scheme.evaluate(patch.kind, points, scalar(u), scalar(v))).collect()
        };
        patches.map(sample).collect()
    }
}

/// A grid of parameters on a patch, `n` along each side.
///
/// Quads: `n * n` of them, number `j * n + i` at u = i / (n - 1), v = j / (n - 1). Triangles, and pieces of pentagons: `n (n + 1) / 2`, in rows
/// r = 0..n with u = 1 - r / (n - 1), in each row w = k / (n - 1) for k = 0..=r; given are (u, v).
///
/// # Panics
/// If `n` is below 2.
pub fn grid_parameters(kind: PatchKind, n: u32) -> Vec<[f64; 2]> {
    assert!(n >= 2, "a grid has at least two samples along a side");
    let at = |i: u32| f64::from(i) / f64::from(n - 1);
    if kind.is_triangular() {
        (0..n).flat_map(|r| (0..=r).map(move |k| [at(n - 1 - r), at(r - k)])).collect()
    } else {
        (0..n).flat_map(|j| (0..n).map(move |i| [at(i), at(j)])).collect()
    }
}
