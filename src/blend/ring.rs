//! One-rings with values at their vertices, and what every corner of a Gregory patch takes from them.

use super::values::Blend;
use crate::topology::{Ring, RingKind, Topology};
use std::f64::consts::TAU;

/// The connectivity of a one-ring, without the values: what all of its weights depend on.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct RingShape {
    /// The rule for its limit point and tangents.
    pub kind: RingKind,
    /// Whether the first and the last edge differ: always for [`RingKind::Crease`], never for [`RingKind::Smooth`].
    pub open: bool,
    /// For each face of the ring, whether it is a triangle (else a quad).
    pub triangles: Vec<bool>,
    /// Whether the edges have the curves of Gregory patches, whichever scheme draws the faces: one of
    /// [`FallbackRings`](crate::patch::FallbackRings).
    pub fallback: bool,
}

impl RingShape {
    /// The shape of a ring of `topology` whose faces are triangles and quads, or for Pm-patches pentagons, which then count as
    /// quads.
    pub fn of(topology: &Topology, ring: &Ring) -> Self {
        let triangles = if ring.quads {
            vec![false; ring.faces as usize]
        } else {
            topology.ring_half_edges(ring).map(|h| topology.face_size(h) == 3).collect()
        };
        Self { kind: ring.kind, open: ring.open, triangles, fallback: false }
    }

    /// Number of faces.
    pub fn faces(&self) -> usize {
        self.triangles.len()
    }

    /// Number of edges: as many as faces, and one more if the ring is open.
    pub fn edges(&self) -> usize {
        self.faces() + usize::from(self.open)
    }

    /// The angle between neighbouring edges in the tangent plane, in turns: a full turn shared by the faces of a
    /// smooth ring, half a turn along a crease, a quarter turn in a corner between sharp edges.
    fn turns_between_edges(&self) -> (usize, usize) {
        match (self.kind, self.open) {
            (RingKind::Smooth, _) | (RingKind::Corner, false) => (1, self.faces()),
            (RingKind::Crease, _) => (1, 2 * self.faces()),
            (RingKind::Corner, true) => (1, 4 * self.faces()),
        }
    }

    /// Cosine and sine of the angle from edge 0 to edge `j` in the tangent plane.
    pub fn edge_direction(&self, j: usize) -> [f64; 2] {
        let (num, den) = self.turns_between_edges();
        cos_sin(2 * num * j, 2 * den)
    }

    /// `cos_k` of patch_maths B: the cosine of the angle between neighbouring edges.
    pub fn cosine(&self) -> f64 {
        self.edge_direction(1)[0]
    }

    /// Whether [`RingValues::edge_point`] is the frame's: everywhere but in a corner, which is a cone.
    pub fn has_frame(&self) -> bool {
        self.kind != RingKind::Corner
    }
}

/// Cosine and sine of `num / den` turns, exact at quarter turns, so that opposite edges get opposite numbers.
fn cos_sin(num: usize, den: usize) -> [f64; 2] {
    let num = num % den;
    if (4 * num).is_multiple_of(den) {
        return [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][4 * num / den];
    }
    let (sin, cos) = (TAU * num as f64 / den as f64).sin_cos();
    [cos, sin]
}

/// A one-ring of quads and triangles with a value at each vertex.
#[derive(Debug, Clone)]
pub struct RingValues<T> {
    /// What the weights depend on.
    pub shape: RingShape,
    /// At the vertex itself.
    pub centre: T,
    /// `a_j`, at the other end of edge j.
    pub edges: Vec<T>,
    /// `d_i`, at the vertex of quad i opposite the centre; of a pentagon the middle of the far edge. Not used for triangles.
    pub diagonals: Vec<T>,
}

/// The limit point of a ring and its tangent frame: `e_j = p + a cos(phi_j) + b sin(phi_j)`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Frame<T> {
    /// The limit point.
    pub p: T,
    /// From `p` to the edge point of edge 0.
    pub a: T,
    /// The tangent at a right angle to `a` in the plane of parameters, counter-clockwise.
    pub b: T,
}

impl<T> RingValues<T> {
    /// The ring with the values of `vertex(h)`, at the vertex from which half-edge `h` starts, and of `opposite(h)` as
    /// diagonal of the face in which `h` starts from the opposite vertex, or of a pentagon its far edge.
    pub(crate) fn collect(
        topology: &Topology,
        ring: &Ring,
        vertex: impl Fn(u32) -> T,
        opposite: impl Fn(u32) -> T,
    ) -> Self {
        let mut edges = Vec::with_capacity(ring.edges() as usize);
        let mut diagonals = Vec::with_capacity(ring.faces as usize);
        let mut last = ring.start;
        for h in topology.ring_half_edges(ring) {
            let head = topology.next(h);
            edges.push(vertex(head));
            diagonals.push(opposite(topology.next(head)));
            last = h;
        }
        if ring.open {
            edges.push(vertex(topology.prev(last)));
        }
        let centre = vertex(ring.start);
        Self { shape: RingShape::of(topology, ring), centre, edges, diagonals }
    }
}

impl<T> RingValues<T> {
    /// The ring with other values.
    pub(crate) fn map<U>(&self, value: impl Fn(&T) -> U) -> RingValues<U> {
        RingValues {
            shape: self.shape.clone(),
            centre: value(&self.centre),
            edges: self.edges.iter().map(&value).collect(),
            diagonals: self.diagonals.iter().map(&value).collect(),
        }
    }
}

impl<T> Frame<T> {
    /// The frame with other values.
    pub(crate) fn map<U>(&self, value: impl Fn(&T) -> U) -> Frame<U> {
        Frame { p: value(&self.p), a: value(&self.a), b: value(&self.b) }
    }
}

impl<T: Blend> RingValues<T> {
    /// The ring with the value of `vertex(v)` at mesh vertex `v`.
    pub fn new(topology: &Topology, ring: &Ring, vertex: impl Fn(u32) -> T) -> Self {
        let at = |h: u32| vertex(topology.mesh_vertex(h));
        let opposite = |h: u32| match topology.face_size(h) {
            5 => T::sum([(0.5, &at(h)), (0.5, &at(topology.next(h)))]),
            _ => at(h),
        };
        Self::collect(topology, ring, at, opposite)
    }

    fn edge(&self, j: usize) -> &T {
        &self.edges[j % self.edges.len()]
    }

    /// `m_j = (v + a_j) / 2`.
    fn add_midpoint(&self, sum: &mut T, weight: f64, j: usize) {
        sum.add_scaled(0.5 * weight, &self.centre);
        sum.add_scaled(0.5 * weight, self.edge(j));
    }

    /// `c_i`, the mean of the vertices of face i.
    fn add_centroid(&self, sum: &mut T, weight: f64, i: usize) {
        let share = if self.shape.triangles[i] { weight / 3.0 } else { weight / 4.0 };
        sum.add_scaled(share, &self.centre);
        sum.add_scaled(share, self.edge(i));
        if !self.shape.triangles[i] {
            sum.add_scaled(share, &self.diagonals[i]);
        }
        sum.add_scaled(share, self.edge(i + 1));
    }

    /// Limit point and tangent frame (Loop et al. 2009, sections 3.2, 3.3 and 4.6; patch_maths A and B).
    ///
    /// At a corner `a` and `b` are zero: see [`RingValues::edge_point`].
    ///
    /// Along a crease the rings on both sides give the same bits for `p`, and `a` but for its sign.
    pub fn frame(&self) -> Frame<T> {
        match self.shape.kind {
            RingKind::Smooth => self.smooth_frame(),
            RingKind::Crease => self.crease_frame(),
            RingKind::Corner => Frame { p: self.centre.clone(), ..Frame::default() },
        }
    }

    fn smooth_frame(&self) -> Frame<T> {
        let faces = self.shape.faces();
        let n = faces as f64;
        let mut frame = Frame::<T>::default();
        frame.p.add_scaled((n - 3.0) / (n + 5.0), &self.centre);
        let limit = 4.0 / (n * (n + 5.0));
        // e_j = p + (2/3) lambda q_j with q_j from patch_maths A; the angle i - j is taken apart into i and j.
        let cos_half = cos_sin(1, 2 * faces)[0];
        let sigma = 1.0 / (4.0 + cos_half * cos_half).sqrt();
        let scale = 2.0 / 3.0 * tangent_scale(faces) * 2.0 / n;
        let (at_midpoint, at_centroid) = (scale * (1.0 - sigma * cos_half), scale * 2.0 * sigma);
        for i in 0..faces {
            self.add_midpoint(&mut frame.p, limit, i);
            self.add_centroid(&mut frame.p, limit, i);
            let edge = cos_sin(2 * i, 2 * faces);
            let face = cos_sin(2 * i + 1, 2 * faces);
            for (axis, tangent) in [&mut frame.a, &mut frame.b].into_iter().enumerate() {
                self.add_midpoint(tangent, at_midpoint * edge[axis], i);
                self.add_centroid(tangent, at_centroid * face[axis], i);
            }
        }
        frame
    }

    /// Along the crease half the chord of its neighbours; across it Biermann et al.'s tangent.
    fn crease_frame(&self) -> Frame<T> {
        let faces = self.shape.faces();
        let (first, last) = (self.edge(0), self.edge(faces));
        // The ends first: the ring on the other side of the crease has them the other way round, and the same sum.
        let p = T::sum([(1.0 / 6.0, first), (1.0 / 6.0, last), (4.0 / 6.0, &self.centre)]);
        let a = T::sum([(1.0 / 6.0, first), (-1.0 / 6.0, last)]);
        let mut b = T::default();
        if faces == 1 {
            // A smooth boundary through a vertex with one face. The edge points do not take part in b.
            b = T::sum([(1.0 / 3.0, first), (1.0 / 3.0, last), (-2.0 / 3.0, &self.centre)]);
            return Frame { p, a, b };
        }
        let [cos, sin] = cos_sin(1, 2 * faces);
        let scale = 1.0 / (3.0 * (3.0 * faces as f64 + cos));
        b.add_scaled(-4.0 * sin * scale, &self.centre);
        let ends = -(1.0 + 2.0 * cos) * ((1.0 + cos) / (1.0 - cos)).sqrt() * scale;
        b.add_scaled(ends, first);
        b.add_scaled(ends, last);
        for j in 1..faces {
            b.add_scaled(4.0 * cos_sin(j, 2 * faces)[1] * scale, self.edge(j));
        }
        for i in 0..faces {
            // d_i := 4 c_i - v - a_i - a_{i+1}, so that a triangle acts through its centroid.
            let weight = (cos_sin(i, 2 * faces)[1] + cos_sin(i + 1, 2 * faces)[1]) * scale;
            self.add_centroid(&mut b, 4.0 * weight, i);
            for value in [&self.centre, self.edge(i), self.edge(i + 1)] {
                b.add_scaled(-weight, value);
            }
        }
        Frame { p, a, b }
    }

    /// The edge point `e_j`: the second Bezier point of the curve along edge j.
    ///
    /// Around a corner each edge goes straight at its neighbour: there is no common tangent plane to keep.
    pub fn edge_point(&self, frame: &Frame<T>, j: usize) -> T {
        T::sum([(1.0, &frame.p), (1.0, &self.edge_vector(frame, j))])
    }

    /// [`RingValues::edge_point`] as seen from the limit point.
    ///
    /// GLSL twin: `edge_vector` in `glsl/lib/construct/rings.glsl`.
    pub fn edge_vector(&self, frame: &Frame<T>, j: usize) -> T {
        if self.shape.has_frame() {
            let [cos, sin] = self.shape.edge_direction(j);
            T::sum([(cos, &frame.a), (sin, &frame.b)])
        } else {
            T::sum([(1.0 / 3.0, self.edge(j)), (-1.0 / 3.0, &self.centre)])
        }
    }

    /// The vector across edge `j` at this vertex, from right to left: `(3/2) (e_{j+1} - e_{j-1})`, with the edge point that an
    /// open ring lacks beyond its ends mirrored. `w0` and, negated, `w3` of patch_maths B.
    pub fn across(&self, frame: &Frame<T>, j: usize) -> T {
        let edges = self.edges.len();
        let j = j % edges;
        let edge = |j: usize| self.edge_vector(frame, j % edges);
        let cosine = self.shape.cosine();
        if self.shape.open && j == 0 {
            T::sum([(3.0, &edge(1)), (-3.0 * cosine, &edge(0))])
        } else if self.shape.open && j == edges - 1 {
            T::sum([(-3.0, &edge(j - 1)), (3.0 * cosine, &edge(j))])
        } else {
            T::sum([(1.5, &edge(j + 1)), (-1.5, &edge(j + edges - 1))])
        }
    }

    /// `r_j`, the transversal of edge j at this vertex, from the face on its right to the face on its left
    /// (Loop et al. 2009, section 3.4; at the ends of an open ring with a mirrored ghost row, section 4.6).
    pub fn transversal(&self, j: usize) -> T {
        let (faces, mut r) = (self.shape.faces(), T::default());
        let j = j % self.edges.len();
        let third = 1.0 / 3.0;
        if self.shape.open && j == 0 {
            self.add_midpoint(&mut r, 2.0 * third, 1);
            r.add_scaled(-2.0 * third, &self.centre);
            self.add_centroid(&mut r, 4.0 * third, 0);
            self.add_midpoint(&mut r, -4.0 * third, 0);
        } else if self.shape.open && j == faces {
            r.add_scaled(2.0 * third, &self.centre);
            self.add_midpoint(&mut r, -2.0 * third, faces - 1);
            self.add_midpoint(&mut r, 4.0 * third, faces);
            self.add_centroid(&mut r, -4.0 * third, faces - 1);
        } else {
            let before = (j + faces - 1) % faces;
            self.add_midpoint(&mut r, third, j + 1);
            self.add_midpoint(&mut r, -third, before);
            self.add_centroid(&mut r, 2.0 * third, j);
            self.add_centroid(&mut r, -2.0 * third, before);
        }
        r
    }
}

/// The subdominant eigenvalue of Catmull-Clark subdivision around a vertex with `n` faces.
pub(crate) fn tangent_scale(n: usize) -> f64 {
    let (cos, cos_half) = (cos_sin(1, n)[0], cos_sin(1, 2 * n)[0]);
    (5.0 + cos + cos_half * (18.0 + 2.0 * cos).sqrt()) / 16.0
}
