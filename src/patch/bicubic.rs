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
/// GLSL twin: `glsl/construct/regular.tesc`.
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
    evaluate_tensor(&std::array::from_fn(|i| std::array::from_fn(|j| points[4 * i + j])), u, v)
}

/// The cubic Bernstein polynomials and their derivatives at a parameter.
pub(crate) struct Basis<S> {
    pub value: [S; 4],
    pub derivative: [S; 4],
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
            derivative: [
                -(three * (s * s)),
                three * (s * s) - three * (two * (s * t)),
                three * (two * (s * t)) - three * (t * t),
                three * (t * t),
            ],
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

/// A 4 x 4 tensor-product Bezier patch at (u, v), rows along u.
///
/// Derivatives are taken of the points as seen from the first one: they are differences of nearly equal numbers where a
/// patch is small and far from the origin. Positions are not: an edge must get the same bits from both of its patches.
///
/// GLSL twin: `evaluate_tensor` in `glsl/lib/patch.glsl`.
pub(crate) fn evaluate_tensor<P: Point>(points: &[[P; 4]; 4], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    let (bu, bv) = (Basis::new::<P>(u), Basis::new::<P>(v));
    let near = points.map(|row| row.map(|x| x - points[0][0]));
    // First along u: the points and u-derivatives of a cubic in v.
    let along = |weights: &[P::Scalar; 4], points: &[[P; 4]; 4]| -> [P; 4] {
        std::array::from_fn(|j| symmetric_sum(weights, &[points[0][j], points[1][j], points[2][j], points[3][j]]))
    };
    let position = symmetric_sum(&bv.value, &along(&bu.value, points));
    let du = symmetric_sum(&bv.value, &along(&bu.derivative, &near));
    let dv = symmetric_sum(&bv.derivative, &along(&bu.value, &near));
    let diagonals = near[3][3].cross(near[0][3] - near[3][0]);
    Sample { position, normal: unit_normal(du, dv, diagonals) }
}
