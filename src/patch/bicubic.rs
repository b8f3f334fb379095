//! Regular faces: bicubic Bezier patches that equal the Catmull-Clark limit surface.
//!
//! 16 control points, row-major 4 x 4: point `4 i + j` has index i along u and j along v.

use super::gregory::PatchCorner;
use super::point::{scalar, unit_normal};
use super::{Blend, Point, Sample};

/// Control points of a patch.
pub const POINTS: usize = 16;

/// Where corner k's point, plus edge point, minus edge point and face point stand among the 16.
pub const CORNER_SLOTS: [[usize; 4]; 4] = [[0, 4, 1, 5], [12, 13, 8, 9], [15, 11, 14, 10], [3, 2, 7, 6]];

/// The Bezier points of a regular quad, from its four corners.
///
/// Corner and edge points are those of the rings, as for every other patch; the inner point of a corner is
/// `(4 v + 2 a + 2 b + d) / 9` with the vertices of the face itself, at a boundary too.
///
/// GLSL twin: `glsl/lib/bicubic_points.glsl`.
pub fn bicubic_points<T: Blend>(corners: &[PatchCorner<T>; 4]) -> [T; 16] {
    let mut points: [T; 16] = std::array::from_fn(|_| T::default());
    for (k, corner) in corners.iter().enumerate() {
        let centre = |step: usize| &corners[(k + step) % 4].ring.centre;
        let inner =
            T::sum([(4.0 / 9.0, centre(0)), (2.0 / 9.0, centre(1)), (2.0 / 9.0, centre(3)), (1.0 / 9.0, centre(2))]);
        for (slot, point) in
            CORNER_SLOTS[k].into_iter().zip([corner.frame.p.clone(), corner.plus(), corner.minus(), inner])
        {
            points[slot] = point;
        }
    }
    points
}

/// A bicubic Bezier patch at (u, v).
///
/// GLSL twin: `glsl/lib/evaluate_bicubic.glsl`.
pub fn evaluate_bicubic<P: Point>(points: &[P; 16], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    let corner = |slots: [usize; 4]| {
        let [p, plus, minus, inner] = slots.map(|slot| points[slot]);
        TensorCorner { p, plus: plus - p, minus: minus - p, inner: inner - p }
    };
    evaluate_tensor(&CORNER_SLOTS.map(corner), u, v)
}

/// The cubic Bernstein polynomials at a parameter.
pub(crate) struct Basis<S> {
    pub value: [S; 4],
    /// The quadratic polynomials: of the differences of the points they make a third of the derivative.
    pub slope: [S; 3],
}

impl<S: num_traits::Float> Basis<S> {
    /// In the symmetric form: at t and 1 - t the same numbers in reverse order, to the bit.
    ///
    /// GLSL twin: `cubic_basis` in `glsl/lib/patch.glsl`.
    pub(crate) fn new<P: Point<Scalar = S>>(t: S) -> Self {
        let [one, two, three] = [1.0, 2.0, 3.0].map(scalar::<P>);
        let s = one - t;
        Self {
            value: [(s * s) * s, three * (s * s) * t, three * (t * t) * s, (t * t) * t],
            slope: [s * s, two * (s * t), t * t],
        }
    }
}

/// The sum that both directions along an edge evaluate to the same bits.
fn symmetric_sum<P: Point>(weights: &[P::Scalar; 4], points: &[P; 4]) -> P {
    (points[0] * weights[0] + points[3] * weights[3]) + (points[1] * weights[1] + points[2] * weights[2])
}

pub(crate) fn cubic<P: Point>(basis: &Basis<P::Scalar>, points: &[P; 4]) -> P {
    symmetric_sum(&basis.value, points)
}

/// A third of the derivative along a cubic: from its ends `near` and `far` to the points beside them, and between these. From
/// either end the same but for its sign.
///
/// GLSL twin: `edge_slope` in `glsl/lib/patch.glsl`.
pub(crate) fn edge_slope<P: Point>(slope: &[P::Scalar; 3], near: P, middle: P, far: P) -> P {
    (near * slope[0] - far * slope[2]) + middle * slope[1]
}

/// What a corner of a tensor-product patch owns: its point and, as seen from there, those along its plus and its minus edge,
/// and inside.
#[derive(Clone, Copy)]
pub(crate) struct TensorCorner<P> {
    pub p: P,
    pub plus: P,
    pub minus: P,
    pub inner: P,
}

/// A 4 x 4 tensor-product Bezier patch at (u, v), u from the first corner to the second.
///
/// The row of points beside an edge is the row of the edge and vectors from there, so that slopes across an edge are made of
/// those vectors alone: with points, they would be differences of nearly equal numbers where a patch is small and far from
/// the origin.
///
/// GLSL twin: `evaluate_tensor` in `glsl/lib/patch.glsl`.
pub(crate) fn evaluate_tensor<P: Point>(corners: &[TensorCorner<P>; 4], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    let (bu, bv) = (Basis::new::<P>(u), Basis::new::<P>(v));
    let [a, b, c, d] = corners;
    // From a to b, and from d to c.
    let (x1, x2) = (a.p + a.plus, b.p + b.minus);
    let (y1, y2) = (d.p + d.minus, c.p + c.plus);
    let (x, y) = (cubic(&bu, &[a.p, x1, x2, b.p]), cubic(&bu, &[d.p, y1, y2, c.p]));
    // From those edges inwards.
    let (v1, v2) = (a.inner - a.plus, b.inner - b.minus);
    let (w1, w2) = (d.inner - d.minus, c.inner - c.plus);
    let (x_in, y_in) = (cubic(&bu, &[a.minus, v1, v2, b.plus]), cubic(&bu, &[d.plus, w1, w2, c.minus]));
    let (x_beside, y_beside) = (x + x_in, y + y_in);
    let position = cubic(&bv, &[x, x_beside, y_beside, y]);

    // A third of the derivatives.
    let dv = edge_slope(&bv.slope, x_in, y_beside - x_beside, y_in);
    let dx = edge_slope(&bu.slope, a.plus, x2 - x1, b.minus);
    let dy = edge_slope(&bu.slope, d.minus, y2 - y1, c.plus);
    let dx_in = ((v1 - a.minus) * bu.slope[0] + (v2 - v1) * bu.slope[1]) + (b.plus - v2) * bu.slope[2];
    let dy_in = ((w1 - d.plus) * bu.slope[0] + (w2 - w1) * bu.slope[1]) + (c.minus - w2) * bu.slope[2];
    let at = bv.value;
    let du = (dx * (at[0] + at[1]) + dx_in * at[1]) + (dy * (at[2] + at[3]) + dy_in * at[2]);
    Sample { position, normal: unit_normal(du, dv, (c.p - a.p).cross(d.p - b.p)) }
}
