//! The CPU twin: every patch of a mesh, constructed and evaluated on the host.

use super::{FaceOrigin, Notice, Patch, PatchPlan, Prepared, TableError, TableOptions, prepare_for};
use crate::adaptive::{self, AdaptiveOptions, DrawnBy};
use crate::blend::{Blend, Point, Sample, scalar, unit_normal};
use crate::mesh::ControlMesh;
use crate::patch::Scheme;
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
    leaves: Option<Leaves>,
}

/// The leaves of faces that are refined.
#[derive(Debug, Clone)]
struct Leaves {
    plan: adaptive::Plan,
    /// The place of each leaf's first control point among those of its root.
    starts: Vec<u32>,
    /// How many control points each root has.
    counts: Vec<u32>,
}

impl CpuSurface {
    /// The patches of a scheme, which has some for all faces, after `refine` steps of refinement or more.
    ///
    /// # Errors
    /// As [`CpuSurface::with_options`].
    pub fn new(mesh: &ControlMesh, scheme: Scheme, refine: u32) -> Result<Self, TableError> {
        Self::with_options(mesh, &TableOptions { scheme, refine, ..TableOptions::default() })
    }

    /// The patches that a model with these options has; of adaptive surfaces always those by faces.
    ///
    /// # Errors
    /// A refined mesh that cannot be addressed; faces that the scheme has no patch for; those of [`adaptive::Plan::new`], and
    /// [`TableError::NotAdaptive`].
    pub fn with_options(mesh: &ControlMesh, options: &TableOptions) -> Result<Self, TableError> {
        // The surface is the same, and so a face finds its leaves.
        let adaptive = options.adaptive.map(|adaptive| AdaptiveOptions { drawn_by: DrawnBy::Faces, ..adaptive });
        let (prepared, plan, adaptive) = prepare_for(mesh, &TableOptions { adaptive, ..*options })?;
        Ok(Self { prepared, plan, leaves: adaptive.map(Leaves::new) })
    }

    /// Patches that are planned.
    #[cfg(feature = "measure")]
    pub(crate) fn planned(prepared: Prepared, plan: PatchPlan) -> Self {
        Self { prepared, plan, leaves: None }
    }

    /// The patches, in the order of the tables.
    pub fn plan(&self) -> &PatchPlan {
        &self.plan
    }

    /// The mesh that the patches are of.
    pub fn prepared(&self) -> &Prepared {
        &self.prepared
    }

    /// The plan of adaptive subdivision, with [`TableOptions::adaptive`].
    pub fn adaptive(&self) -> Option<&adaptive::Plan> {
        self.leaves.as_ref().map(|leaves| &leaves.plan)
    }

    /// What a user will want to know about how the mesh is drawn.
    pub fn notices(&self) -> Vec<Notice> {
        self.prepared.notices(&self.plan)
    }

    /// Where each patch comes from.
    pub fn origins(&self) -> Vec<FaceOrigin> {
        self.plan.origins()
    }

    /// The control points of every patch, combined from `value` of each position: [`CpuSurface::points_of`].
    pub fn control_points<T: Blend + Send + Sync>(&self, value: impl Fn(DVec3) -> T) -> Vec<Vec<T>> {
        let vertices = self.vertices(value);
        self.plan.patches().par_iter().map(|&patch| self.points_of(patch, &vertices)).collect()
    }

    /// What control points are made of: `value` of each position of the prepared mesh ([`Prepared::whole`]), then the vertices of
    /// [`adaptive::Plan`].
    pub fn vertices<T: Blend + Send + Sync>(&self, value: impl Fn(DVec3) -> T) -> Vec<T> {
        let mesh = self.prepared.whole().mesh();
        let vertices: Vec<T> = (0..mesh.vertex_count() as u32).map(|vertex| value(mesh.position(vertex))).collect();
        match &self.leaves {
            Some(leaves) => leaves.plan.points(&vertices),
            None => vertices,
        }
    }

    /// The control points of a patch, with [`CpuSurface::vertices`]: those of its scheme; of a face that is refined those of its
    /// leaves, one leaf after the other in the order of its quadtree, or of its two quadtrees.
    pub fn points_of<T: Blend>(&self, patch: Patch, vertices: &[T]) -> Vec<T> {
        let Some(leaves) = self.leaves_of(patch) else {
            let vertex = |vertex: u32| vertices[vertex as usize].clone();
            return patch.control_points(self.prepared.topology(), self.plan.fallback_rings(), vertex);
        };
        let plan = &leaves.plan;
        let of_leaf = |leaf: u32| plan.control_points(&plan.leaves[leaf as usize], vertices);
        let [root, next] = self.prepared.roots(plan, &patch);
        let leaves = std::iter::once(root).chain((next != root).then_some(next)).flat_map(|root| plan.leaves_of(root));
        leaves.flat_map(of_leaf).collect()
    }

    /// A patch with these control points at the parameters (u, v), by which a refined face finds its leaf. GLSL twin:
    /// `evaluate_spot` in `glsl/lib/evaluate/leaves.glsl`.
    ///
    /// On its edges, too, the face asks its own leaves, where shaders ask those of the edge's owner. The two differ by rounding, but
    /// for positions next to an end cap that does not have the crease of finite sharpness beside it, and for normals where several
    /// faces meet whose caps have different ones.
    ///
    /// # Panics
    /// If `points` are not those of [`CpuSurface::points_of`].
    pub fn evaluate<P: Point>(&self, patch: Patch, points: &[P], u: f64, v: f64) -> Sample<P> {
        let Some(leaves) = self.leaves_of(patch) else {
            return patch.scheme.evaluate(patch.kind, points, scalar::<P>(u), scalar::<P>(v));
        };
        let [root, next] = self.prepared.roots(&leaves.plan, &patch);
        match patch.is_wedge().then(|| in_wedge(u, v)) {
            None => leaves.evaluate(root, points, u, v),
            Some((false, u, v)) => leaves.evaluate(root, points, u, v),
            Some((true, u, v)) => leaves.evaluate(next, &points[leaves.counts[root as usize] as usize..], u, v),
        }
    }

    /// The first root of a patch that is refined, with these control points, at (u, v): also where a wedge does not have it.
    #[cfg(feature = "measure")]
    pub(crate) fn evaluate_root<P: Point>(&self, patch: Patch, points: &[P], u: f64, v: f64) -> Sample<P> {
        let leaves = self.leaves_of(patch).expect("the patch is refined");
        leaves.evaluate(self.prepared.roots(&leaves.plan, &patch)[0], points, u, v)
    }

    /// The leaves, if the patch is a face that is refined.
    fn leaves_of(&self, patch: Patch) -> Option<&Leaves> {
        self.leaves.as_ref().filter(|_| patch.refined)
    }

    /// Every patch at the parameters of [`grid_parameters`].
    ///
    /// # Panics
    /// If `points` are not those of all patches, or `n` is below 2.
    pub fn grid<P: Point>(&self, points: &[Vec<P>], n: u32) -> Vec<Vec<Sample<P>>> {
        assert_eq!(points.len(), self.plan.patches().len(), "control points of every patch");
        let grids = PatchKind::ALL.map(|kind| grid_parameters(kind, n));
        let patches = self.plan.patches().par_iter().zip(points);
        let sample = |(&patch, points): (&Patch, &Vec<P>)| {
            let parameters = grids[patch.kind as usize].iter();
            parameters.map(|&[u, v]| self.evaluate(patch, points, u, v)).collect()
        };
        patches.map(sample).collect()
    }
}

impl Leaves {
    fn new(plan: adaptive::Plan) -> Self {
        let (mut starts, mut counts) = (vec![0; plan.leaves.len()], Vec::with_capacity(plan.roots.len()));
        for root in 0..plan.roots.len() as u32 {
            let mut start = 0;
            for leaf in plan.leaves_of(root) {
                starts[leaf as usize] = start;
                start += plan.leaves[leaf as usize].kind.points() as u32;
            }
            counts.push(start);
        }
        Self { plan, starts, counts }
    }

    /// A root at (u, v), whose control points come first.
    fn evaluate<P: Point>(&self, root: u32, points: &[P], u: f64, v: f64) -> Sample<P> {
        let (leaf, u, v) = self.plan.locate(root, u, v);
        let kind = self.plan.leaves[leaf as usize].kind;
        let [position, du, dv] = kind.evaluate(&points[self.starts[leaf as usize] as usize..][..kind.points()], u, v);
        Sample { position, normal: unit_normal(du, dv, P::default()) }
    }
}

/// Where a point of a wedge is, by its first two barycentric coordinates: whether in the root around the end of the wedge's edge, and
/// (u, v) there. Each root has half of the wedge, which is half of the root. GLSL twin: `wedge_spot` in
/// `glsl/lib/evaluate/leaves.glsl`.
pub(crate) fn in_wedge(x: f64, y: f64) -> (bool, f64, f64) {
    let z = 1.0 - x - y;
    if x >= y { (false, 2.0 * y + z, z) } else { (true, z, 2.0 * x + z) }
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
