//! Bezier curves and tensor products of them, whose sums are the same to the bit from either end.

use super::point::{Point, Sample, scalar, unit_normal};

/// The cubic Bernstein polynomials at a parameter.
pub(crate) struct Basis<S> {
    pub value: [S; 4],
    /// The quadratic polynomials: of the differences of the points they make a third of the derivative.
    pub slope: [S; 3],
}

impl<S: num_traits::Float> Basis<S> {
    /// In the symmetric form: at t and 1 - t the same numbers in reverse order, to the bit.
    ///
    /// GLSL twin: `cubic_basis` in `glsl/lib/evaluate/patch.glsl`.
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

/// A cubic Bezier curve by its ends and, as seen from either, the point beside it: what the ends count is the sum of two
/// Bernstein polynomials.
pub(crate) struct CurveBasis<S> {
    /// Of the ends.
    ends: [S; 2],
    /// Of the points beside them.
    beside: [S; 2],
    /// Of a third of the derivative: of the point beside the first end, of the way from end to end, of the point beside the
    /// second.
    slope: [S; 3],
}

impl<S: num_traits::Float> CurveBasis<S> {
    /// At t and 1 - t the same numbers, in reverse order and with other signs, to the bit.
    ///
    /// GLSL twin: `curve_basis` in `glsl/lib/evaluate/patch.glsl`.
    pub(crate) fn new<P: Point<Scalar = S>>(t: S) -> Self {
        let [one, two, three] = [1.0, 2.0, 3.0].map(scalar::<P>);
        let s = one - t;
        let (ss, tt, s3, t3) = (s * s, t * t, three * s, three * t);
        let between = two * (s * t);
        Self {
            ends: [ss * (s + t3), tt * (t + s3)],
            beside: [ss * t3, tt * s3],
            slope: [ss - between, between, between - tt],
        }
    }
}

/// A point of a curve: a sum that both directions along an edge evaluate to the same bits. Of the ends, and between them the points
/// beside as seen from there.
///
/// GLSL twin: `curve_point` in `glsl/lib/evaluate/patch.glsl`.
pub(crate) fn curve_point<P: Point>(at: &CurveBasis<P::Scalar>, [p0, beside0, beside1, p1]: [P; 4]) -> P {
    (p0 * at.ends[0] + p1 * at.ends[1]) + (beside0 * at.beside[0] + beside1 * at.beside[1])
}

/// A third of the derivative there. From either end the same but for its sign.
///
/// GLSL twin: `curve_slope` in `glsl/lib/evaluate/patch.glsl`.
pub(crate) fn curve_slope<P: Point>(at: &CurveBasis<P::Scalar>, [p0, beside0, beside1, p1]: [P; 4]) -> P {
    (p1 - p0) * at.slope[1] + (beside0 * at.slope[0] + beside1 * at.slope[2])
}

/// What [`curve_point`] takes of a cubic's Bezier points.
pub(crate) fn seen_from_ends<P: Point>([p0, e0, e1, p1]: [P; 4]) -> [P; 4] {
    [p0, e0 - p0, e1 - p1, p1]
}

/// What a corner of a tensor-product patch has.
#[derive(Clone, Copy)]
pub(crate) struct TensorCorner<P> {
    p: P,
    /// As seen from `p`.
    plus: P,
    /// Likewise.
    minus: P,
    /// The inner point as seen from where `plus` and `minus` lead to one after the other.
    twist: P,
}

impl<P: Point> TensorCorner<P> {
    /// Of a corner and, as seen from there, the points along its plus and its minus edge, and inside.
    pub(crate) fn new(p: P, plus: P, minus: P, inner: P) -> Self {
        Self { p, plus, minus, twist: inner - (plus + minus) }
    }
}

/// A 4 x 4 tensor-product Bezier patch at (u, v), u from the first corner to the second.
///
/// By its edges along u, and by what lies inwards from them: so slopes across an edge are made of vectors alone. With points, they
/// would be differences of nearly equal numbers where a patch is small and far from the origin.
///
/// GLSL twin: `evaluate_tensor` in `glsl/lib/evaluate/patch.glsl`.
pub(crate) fn evaluate_tensor<P: Point>(corners: &[TensorCorner<P>; 4], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    let [position, du, dv] = tensor_derivatives(corners, u, v);
    let [a, b, c, d] = corners;
    Sample { position, normal: unit_normal(du, dv, (c.p - a.p).cross(d.p - b.p)) }
}

/// Position and thirds of the derivatives by u and v.
pub(crate) fn tensor_derivatives<P: Point>(corners: &[TensorCorner<P>; 4], u: P::Scalar, v: P::Scalar) -> [P; 3] {
    let (at_u, at_v) = (CurveBasis::new::<P>(u), CurveBasis::new::<P>(v));
    let [a, b, c, d] = corners;
    // From a to b, inwards from there, inwards from d to c, and there.
    let curves = [
        [a.p, a.plus, b.minus, b.p],
        [a.minus, a.twist, b.twist, b.plus],
        [d.plus, d.twist, c.twist, c.minus],
        [d.p, d.minus, c.plus, c.p],
    ];
    let points = curves.map(|curve| curve_point(&at_u, curve));
    let (position, dv) = (curve_point(&at_v, points), curve_slope(&at_v, points));
    let du = curve_point(&at_v, curves.map(|curve| curve_slope(&at_u, curve)));
    [position, du, dv]
}
