//! ACC patches: Loop and Schaefer, *Approximating Catmull-Clark Subdivision Surfaces with Bicubic Patches* (2008), as in
//! patch_maths C. Quads only.
//!
//! A bicubic geometry patch, and two tangent patches whose cross product is a continuous normal field: the geometry
//! alone is only C0 across the edges of irregular faces. 32 control points: the 16 of the geometry, row-major with rows
//! along u; then for each corner k the vectors `t_k+, t_k-` (derivatives at the corner along its plus and minus edge)
//! and `x_k+, x_k-` (inner control vectors, near corner k, of the derivative across those edges, pointing inwards).

use crate::blend::bicubic::{self, CORNER_SLOTS};
use crate::blend::{
    Basis, Blend, Frame, PatchCorner, Point, RingValues, Sample, cubic, scalar, tangent_scale, unit_normal,
};
use crate::topology::RingKind;

/// Control points of a patch.
pub const POINTS: usize = 32;

/// The limit point and the tangent frame without the factor lambda: `t = 3 (e - p)` with `e` the frame's edge point.
///
/// Beside smooth rings these are the frames of Gregory patches.
pub fn acc_frame<T: Blend>(ring: &RingValues<T>) -> Frame<T> {
    let Frame { p, a, b } = ring.frame();
    if ring.shape.kind != RingKind::Smooth {
        return Frame { p, a, b };
    }
    let scale = 1.0 / (2.0 * tangent_scale(ring.shape.faces()));
    Frame { p, a: T::sum([(scale, &a)]), b: T::sum([(scale, &b)]) }
}

/// Where the points that corner k owns stand: `b` at the corner, along its plus and minus edge and inside, then
/// `t+, t-, x+, x-`.
pub fn corner_slots(k: usize) -> [usize; 8] {
    let [corner, plus, minus, inner] = CORNER_SLOTS[k];
    [corner, plus, minus, inner, 16 + 4 * k, 17 + 4 * k, 18 + 4 * k, 19 + 4 * k]
}

/// The name of a control point.
pub(super) fn point_name(number: usize) -> String {
    match number.checked_sub(16) {
        None => bicubic::point_name(number),
        Some(k) => format!("{}{}{}", if k % 4 < 2 { 't' } else { 'x' }, k / 4, if k % 2 == 0 { '+' } else { '-' }),
    }
}

/// The control points of the quad with these corners, whose frames are [`acc_frame`]s.
///
/// GLSL twin: `glsl/schemes/acc/scheme_points.glsl`.
pub fn acc_points<T: Blend>(corners: &[PatchCorner<T>; 4]) -> Vec<T> {
    let mut points = vec![T::default(); POINTS];
    let cosines = corners.each_ref().map(|c| c.ring.shape.cosine());
    let inner = corners.each_ref().map(|c| c.ring.acc_inner(c.index));
    let middle = corners.each_ref().map(|c| [c.index, c.minus_index()].map(|j| c.ring.acc_edge(j)));
    // The points of the geometry along the edges. Where a face falls back, the curve is the frame's.
    let along: [[T; 2]; 4] = std::array::from_fn(|k| {
        let corner = &corners[k];
        if corner.ring.shape.fallback { [corner.plus(), corner.minus()] } else { middle[k].clone() }
    });
    for (k, corner) in corners.iter().enumerate() {
        let [p, plus, minus, inside, ..] = corner_slots(k);
        points[p] = corner.frame.p.clone();
        points[plus] = along[k][0].clone();
        points[minus] = along[k][1].clone();
        points[inside] = inner[k].clone();
        let tangents = [corner.plus(), corner.minus()].map(|e| T::sum([(3.0, &e), (-3.0, &corner.frame.p)]));
        let ends = [((k + 1) % 4, 1), ((k + 3) % 4, 0)];
        for (side, (tangent, (far, far_side))) in tangents.into_iter().zip(ends).enumerate() {
            let (near_edge, far_edge) = (&along[k][side], &along[far][far_side]);
            points[18 + 4 * k + side] = T::sum([
                (2.0 * cosines[k], far_edge),
                (-2.0 * cosines[k], near_edge),
                (-cosines[far] / 3.0, &tangent),
                (3.0, &inner[k]),
                (-3.0, &middle[k][side]),
            ]);
            points[16 + 4 * k + side] = tangent;
        }
    }
    points
}

impl<T: Blend> RingValues<T> {
    /// The inner point of face i at this vertex: `(n v + 2 a + 2 b + d) / (n + 5)`, n the number of edges around an
    /// interior vertex, twice the faces at a boundary or crease, 4 in a corner.
    ///
    /// A triangle acts through its centroid: `d := 4 c - v - a - b`.
    fn acc_inner(&self, i: usize) -> T {
        let faces = self.shape.faces();
        let n = match (self.shape.kind, self.shape.open) {
            (RingKind::Corner, true) => 4.0 * faces as f64,
            (_, true) => 2.0 * faces as f64,
            (_, false) => faces as f64,
        };
        let i = i % faces;
        let edges = self.edges.len();
        let mut point = T::default();
        let (a, b) = (&self.edges[i], &self.edges[(i + 1) % edges]);
        point.add_scaled(n / (n + 5.0), &self.centre);
        point.add_scaled(2.0 / (n + 5.0), a);
        point.add_scaled(2.0 / (n + 5.0), b);
        if self.shape.triangles[i] {
            for value in [&self.centre, a, b] {
                point.add_scaled(1.0 / (3.0 * (n + 5.0)), value);
            }
        } else {
            point.add_scaled(1.0 / (n + 5.0), &self.diagonals[i]);
        }
        point
    }

    /// The point between the faces of edge j: the mean of the inner points on both sides; on a boundary or sharp edge that
    /// of the cubic curve.
    fn acc_edge(&self, j: usize) -> T {
        if self.shape.open && (j == 0 || j == self.shape.faces()) {
            return T::sum([(2.0 / 3.0, &self.centre), (1.0 / 3.0, &self.edges[j])]);
        }
        let before = (j + self.shape.faces() - 1) % self.shape.faces();
        T::sum([(0.5, &self.acc_inner(before)), (0.5, &self.acc_inner(j))])
    }
}

/// A patch at (u, v): the geometry, with the cross product of the tangent patches as its normal.
///
/// GLSL twin: `glsl/schemes/acc/scheme_evaluate.glsl`.
pub fn evaluate_acc<P: Point>(points: &[P; POINTS], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    let three = scalar::<P>(3.0);
    let b = |i: usize, j: usize| points[4 * i + j];
    let t = |k: usize| [points[16 + 4 * k], points[17 + 4 * k], points[18 + 4 * k], points[19 + 4 * k]];
    let [[t0p, t0m, x0p, x0m], [t1p, t1m, x1p, x1m], [t2p, t2m, x2p, x2m], [t3p, t3m, x3p, x3m]] = [0, 1, 2, 3].map(t);
    let minus = |x: P| P::default() - x;
    // du[j]: the quadratic along u of column j; dv[i]: that along v of row i.
    let du = [[t0p, minus(t1m)], [x0m, minus(x1p)], [x3p, minus(x2m)], [t3m, minus(t2p)]];
    let dv = [[t0m, minus(t3p)], [x0p, minus(x3m)], [x1m, minus(x2p)], [t1p, minus(t2m)]];
    let (bu, bv) = (Basis::new::<P>(u), Basis::new::<P>(v));
    let columns: [P; 4] = std::array::from_fn(|j| cubic(&bu, &[b(0, j), b(1, j), b(2, j), b(3, j)]));
    let along_u: [P; 4] = std::array::from_fn(|j| quadratic(du[j][0], (b(2, j) - b(1, j)) * three, du[j][1], u));
    let along_v: [P; 4] = std::array::from_fn(|i| quadratic(dv[i][0], (b(i, 2) - b(i, 1)) * three, dv[i][1], v));
    let diagonals = (b(3, 3) - b(0, 0)).cross(b(0, 3) - b(3, 0));
    Sample {
        position: cubic(&bv, &columns),
        normal: unit_normal(cubic(&bv, &along_u), cubic(&bu, &along_v), diagonals),
    }
}

/// A quadratic Bezier curve.
fn quadratic<P: Point>(x0: P, x1: P, x2: P, t: P::Scalar) -> P {
    let (two, s) = (scalar::<P>(2.0), scalar::<P>(1.0) - t);
    (x0 * (s * s) + x2 * (t * t)) + x1 * (two * (s * t))
}
