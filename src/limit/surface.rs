//! The limit surface at any parameters.

use super::local::Local;
use super::masks::{corner_limit, dart_edge};
use super::refine::refine;
use super::sample::LimitSample;
use super::sharpness::is_semi_sharp;
use crate::blend::bicubic::regular_points;
use crate::blend::{Basis, Sample};
use crate::mesh::{ControlMesh, MeshError};
use crate::topology::{PatchKind, Topology, draws_face};
use glam::DVec3;
use std::sync::{Arc, OnceLock};

/// How often a face is quartered around a point before the point counts as the vertex it is so close to.
///
/// At every step the neighbourhood of a vertex shrinks to 0.655 of its size or less (0.55 around five faces, 0.5
/// around four), so what is cut off is at most 2e-12 of the edges there.
const MAX_DEPTH: u32 = 64;

/// Differences of larger coordinates need not be finite as f32, as those of every mesh must be.
const MAX_COORDINATE: f64 = 1e38;

/// The Catmull-Clark limit surface of a control mesh in f64, with OpenSubdiv's rules for boundaries, creases,
/// corners and triangles.
///
/// **Parameters.** A quad is a whole (`sub` -1): corner 0 is at (u, v) = (0, 0), corner 1 at (1, 0), corner 2 at
/// (1, 1), corner 3 at (0, 1). Any other face, triangles too, has a part around each corner k (`sub` k): (0, 0) is the
/// corner, (1, 0) the middle of the edge to corner k + 1, (1, 1) the centre of the face, (0, 1) the middle of the edge
/// from corner k - 1.
///
/// **Exactness.** The surface is refined around the point until the point lies on a bicubic B-spline patch, which is
/// then evaluated: no approximation but rounding. Positions are good to some 1e-15 of the mesh's largest coordinate,
/// derivatives and normals to some 1e-11 of their length however close to an extraordinary vertex. At a vertex the
/// limit masks are used.
///
/// **Exclusions.**
/// - Within 2^-64 of an extraordinary vertex in u and v the surface is taken to be at the vertex: an error of less than
///   2e-12 of the edges there.
/// - At an extraordinary vertex derivatives by u and v are zero or infinite. `du` and `dv` are tangents along the edges
///   of the face there, with the length of derivatives around four faces.
/// - Where there is no tangent plane the normal is a convention: at vertices inside the surface with two faces it is
///   zero; at corners with several faces (a cone, or sharp edges with several faces between them) the normal of the
///   edges of the control polygon; where a crease or boundary has four or more faces on a side Biermann et al.'s.
/// - Faces that are not drawn ([`LimitSurface::has_face`]) are evaluated all the same: holes as if they were none,
///   faces on a boundary without a rule ([`crate::mesh::BoundaryRule::None`]) with smooth boundary curves.
///
/// **Edits.** A mesh with [`Edit`](crate::mesh::Edit)s is refined as a whole down to the finest of them.
///
/// **Cost.** Refined neighbourhoods are kept, in a tree for each face that grows where points are asked for. Evaluate
/// from as many threads as you like. A step of refinement takes as long as there are faces around the face; a vertex
/// of valence n in all costs n * n.
///
/// ```
/// use ash_subdiv::{limit::LimitSurface, shape};
/// let cube = shape("cube")?;
/// let surface = LimitSurface::new(&cube)?;
/// let centre = surface.evaluate(0, -1, 0.5, 0.5);
/// assert!(centre.normal.dot(centre.position) > 0.0);
/// # Ok::<(), ash_subdiv::MeshError>(())
/// ```
pub struct LimitSurface {
    /// Surface of the mesh refined once, if there are edits.
    finer: Option<Box<LimitSurface>>,
    topology: Arc<Topology>,
    drawn: Vec<bool>,
    /// A face corner at each vertex.
    corners: Vec<(u32, u32)>,
    faces: Vec<OnceLock<Node>>,
}

impl LimitSurface {
    /// Nothing is refined yet.
    ///
    /// # Errors
    /// [`MeshError::TooFar`] if a coordinate is beyond 1e38.
    pub fn new(mesh: &ControlMesh) -> Result<Self, MeshError> {
        Self::over(&Arc::new(Topology::new(mesh)))
    }

    /// As [`LimitSurface::new`], of the mesh of a topology that there is.
    ///
    /// # Errors
    /// As [`LimitSurface::new`], and [`MeshError::TooLarge`] if a mesh has edits at levels to which it cannot be refined as a whole.
    pub fn over(topology: &Arc<Topology>) -> Result<Self, MeshError> {
        let mesh = topology.mesh();
        let positions = &mesh.data().positions;
        if let Some(vertex) = positions.iter().position(|p| p.iter().any(|x| x.abs() > MAX_COORDINATE)) {
            let (position, max) = (positions[vertex], MAX_COORDINATE);
            return Err(MeshError::TooFar { vertex: vertex as u32, position, max });
        }
        let finer = match mesh.edit_level() {
            0 => None,
            _ => Some(Box::new(Self::over(&Arc::new(Topology::new(&refine(topology)?.mesh)))?)),
        };
        let mut corners = vec![(0, 0); mesh.vertex_count()];
        // The first corner stays.
        for face in (0..mesh.face_count() as u32).rev() {
            for (k, &vertex) in mesh.face(face).iter().enumerate() {
                corners[vertex as usize] = (face, k as u32);
            }
        }
        let faces = (0..mesh.face_count()).map(|_| OnceLock::new()).collect();
        Ok(Self { finer, topology: topology.clone(), drawn: draws_face(topology), corners, faces })
    }

    /// Whether the face is part of the surface, but for holes that edits make in it: no hole and, under [`crate::mesh::BoundaryRule::None`], on no boundary.
    pub fn has_face(&self, face: u32) -> bool {
        self.drawn[face as usize]
    }

    /// The parts of a face: -1 for a quad, else the corners.
    pub fn subs(&self, face: u32) -> std::ops::Range<i32> {
        match self.topology.mesh().face(face).len() {
            4 => -1..0,
            size => 0..size as i32,
        }
    }

    /// The surface over a face at (u, v), which are clamped to 0..=1.
    ///
    /// # Panics
    /// If there is no such face, or `sub` is not among its [`LimitSurface::subs`].
    pub fn evaluate(&self, face: u32, sub: i32, u: f64, v: f64) -> LimitSample {
        let subs = self.subs(face);
        assert!(subs.contains(&sub), "face {face} has parts {subs:?}, not {sub}");
        let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        if let Some(finer) = &self.finer {
            let first = self.topology.mesh().face_corners(face).start as u32;
            return match sub {
                -1 => finer.evaluate_quarter(first, u, v),
                _ => finer.evaluate(first + sub as u32, -1, u, v),
            };
        }
        let root =
            get_or_set(&self.faces[face as usize], || Node::new(Local::cut(&self.topology, face, 0, DVec3::ZERO)));
        let start = if sub < 0 { root } else { root.child(sub as usize) };
        start.evaluate(u, v)
    }

    /// The surface over a quad of the mesh of which this one was refined, whose first child is `first`.
    fn evaluate_quarter(&self, first: u32, u: f64, v: f64) -> LimitSample {
        let k = quadrant(u, v);
        let (a, b) = (2.0 * u, 2.0 * v);
        // Child k begins at corner k.
        let [a, b] = [[a, b], [b, 2.0 - a], [2.0 - a, 2.0 - b], [2.0 - b, a]][k];
        let mut sample = self.evaluate(first + k as u32, -1, a, b);
        (sample.du, sample.dv) = turned_back(k, 2.0 * sample.du, 2.0 * sample.dv);
        sample
    }

    /// Limit point and normal of a control vertex.
    ///
    /// Where the normals of its faces differ (at creases and corners), or fans of faces touch in the vertex, those of
    /// the first face with this vertex.
    ///
    /// # Panics
    /// If there is no such vertex.
    pub fn limit_vertex(&self, vertex: u32) -> Sample<DVec3> {
        let (face, k) = self.corners[vertex as usize];
        let sample = match self.topology.mesh().face(face).len() {
            4 => {
                let [u, v] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][k as usize];
                self.evaluate(face, -1, u, v)
            }
            _ => self.evaluate(face, k as i32, 0.0, 0.0),
        };
        Sample { position: sample.position, normal: sample.normal }
    }
}

/// A face at some level of refinement, with what the surface over it depends on.
struct Node {
    /// To be added to all positions.
    origin: DVec3,
    shape: Shape,
}

enum Shape {
    /// Bezier points ([`crate::patch::bicubic`]).
    Regular(Box<[DVec3; 16]>),
    Irregular(Box<Irregular>),
}

struct Irregular {
    /// The face is face 0.
    topology: Topology,
    refined: OnceLock<Topology>,
    /// Children of a quad by quadrant, corner k of child k being corner k of the face.
    children: Box<[OnceLock<Node>]>,
}

/// As `OnceLock::get_or_init`, but without a lock while `make` runs: it may call into rayon, which may take up another
/// sample of the same face meanwhile on the same thread. What is made twice is the same.
fn get_or_set<T>(cell: &OnceLock<T>, make: impl Fn() -> T) -> &T {
    match cell.get() {
        Some(value) => value,
        None => {
            let value = make();
            cell.get_or_init(|| value)
        }
    }
}

/// Parts and refinements of a mesh that was checked are sound, and [`LimitSurface::new`] has seen to the coordinates.
const SOUND: &str = "a part of a control mesh is a control mesh";

impl Node {
    fn new(local: Local) -> Self {
        let topology = Topology::new(&ControlMesh::new(local.data).expect(SOUND));
        let mesh = topology.mesh();
        let mut corners = mesh.face_corners(0);
        let is_plain = |h: usize| {
            let ring = &topology.rings()[topology.place(h as u32).ring as usize];
            dart_edge(&topology, ring).is_none() && !is_semi_sharp_at(&topology, h as u32)
        };
        let shape = if topology.patch_kind(0) == Some(PatchKind::Regular) && corners.all(is_plain) {
            Shape::Regular(Box::new(regular_points(&topology, 0, |v| mesh.position(v))))
        } else {
            let children = (0..mesh.face(0).len()).map(|_| OnceLock::new()).collect();
            Shape::Irregular(Box::new(Irregular { topology, refined: OnceLock::new(), children }))
        };
        Self { origin: local.origin, shape }
    }

    fn child(&self, k: usize) -> &Self {
        let Shape::Irregular(irregular) = &self.shape else { unreachable!("regular faces are evaluated as they are") };
        let refined = get_or_set(&irregular.refined, || Topology::new(&refine(&irregular.topology).expect(SOUND).mesh));
        // Child k begins at corner k; that of a quad is turned so that u and v run as in its parent.
        let first = if irregular.children.len() == 4 { (4 - k) % 4 } else { 0 };
        get_or_set(&irregular.children[k], || Self::new(Local::cut(refined, k as u32, first, self.origin)))
    }

    /// The surface over a quad.
    fn evaluate(&self, mut u: f64, mut v: f64) -> LimitSample {
        let mut node = self;
        let mut scale = 1.0;
        for depth in 0.. {
            let local = match &node.shape {
                Shape::Regular(points) => Some(evaluate_regular(points, u, v)),
                Shape::Irregular(irregular) => irregular.evaluate_corner(u, v, depth >= MAX_DEPTH),
            };
            if let Some(mut sample) = local {
                sample.position += node.origin;
                sample.du *= scale;
                sample.dv *= scale;
                return sample;
            }
            node = node.child(quadrant(u, v));
            let half = |t: f64| if t < 0.5 { 2.0 * t } else { 2.0 * t - 1.0 };
            (u, v) = (half(u), half(v));
            scale *= 2.0;
        }
        unreachable!("the depth is limited")
    }
}

/// The corner of a quad that (u, v) is closest to.
fn quadrant(u: f64, v: f64) -> usize {
    match (u < 0.5, v < 0.5) {
        (true, true) => 0,
        (false, true) => 1,
        (false, false) => 2,
        (true, false) => 3,
    }
}

impl Irregular {
    /// The limit at a corner, if (u, v) is one or `closest` asks for the closest one, and masks can tell it.
    fn evaluate_corner(&self, u: f64, v: f64, closest: bool) -> Option<LimitSample> {
        let is_end = |t: f64| t == 0.0 || t == 1.0;
        let is_corner = is_end(u) && is_end(v);
        if !(is_corner || closest) {
            return None;
        }
        let k = quadrant(u, v);
        let topology = &self.topology;
        let ring = &topology.rings()[topology.place(k as u32).ring as usize];
        if !ring.quads || is_semi_sharp_at(topology, k as u32) {
            return None;
        }
        let mut limit = corner_limit(topology, k as u32);
        // Tangents along the plus and the minus edge of corner k.
        let (plus, minus) = (limit.du, limit.dv);
        (limit.du, limit.dv) = turned_back(k, plus, minus);
        Some(limit)
    }
}

/// Along u and v of a quad, of vectors along the edges from corner k: to the next corner and to the one before.
fn turned_back(k: usize, plus: DVec3, minus: DVec3) -> (DVec3, DVec3) {
    [(plus, minus), (-minus, plus), (-plus, -minus), (minus, -plus)][k]
}

/// Whether the vertex that a half-edge starts from, or an edge there, has a sharpness that refinement will use up.
pub(crate) fn is_semi_sharp_at(topology: &Topology, half_edge: u32) -> bool {
    let edges = topology.fan(half_edge).0;
    is_semi_sharp(topology.vertex_sharpness(topology.mesh_vertex(half_edge)))
        || edges.into_iter().any(|h| is_semi_sharp(topology.sharpness(h)))
}

fn evaluate_regular(points: &[DVec3; 16], u: f64, v: f64) -> LimitSample {
    let (bu, bv) = (Basis::new::<DVec3>(u), Basis::new::<DVec3>(v));
    let sum = |bu: &[f64; 4], bv: &[f64; 4]| {
        let row = |i: usize| (0..4).map(|j| bv[j] * points[4 * i + j]).sum::<DVec3>();
        (0..4).map(|i| bu[i] * row(i)).sum::<DVec3>()
    };
    // Of the points to the derivative.
    let slope = |[a, b, c]: [f64; 3]| [-a, a - b, b - c, c].map(|x| 3.0 * x);
    let (du, dv) = (sum(&slope(bu.slope), &bv.value), sum(&bu.value, &slope(bv.slope)));
    LimitSample { position: sum(&bu.value, &bv.value), du, dv, normal: du.cross(dv).normalize_or_zero() }
}
