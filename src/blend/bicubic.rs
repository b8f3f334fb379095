//! Regular faces: bicubic Bezier patches that equal the Catmull-Clark limit surface.
//!
//! 16 control points, row-major 4 x 4: point `4 i + j` has index i along u and j along v.

use super::bezier::{TensorCorner, evaluate_tensor};
use super::corner::{CornerRings, PatchCorner};
use super::point::{Point, Sample};
use super::values::Blend;
use crate::topology::Topology;

/// Control points of a patch.
pub const POINTS: usize = 16;

/// Where corner k's point, plus edge point, minus edge point and face point stand among the 16.
pub const CORNER_SLOTS: [[usize; 4]; 4] = [[0, 4, 1, 5], [12, 13, 8, 9], [15, 11, 14, 10], [3, 2, 7, 6]];

/// The Bezier points of a regular quad, from its four corners.
///
/// Corner and edge points are those of the rings, as for every other patch; the inner point of a corner is
/// `(4 v + 2 a + 2 b + d) / 9` with the vertices of the face itself, at a boundary too.
///
/// GLSL twin: `glsl/schemes/bicubic/scheme_points.glsl`.
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

/// The name of a control point: its row and its column.
pub(crate) fn point_name(number: usize) -> String {
    format!("b{}{}", number / 4, number % 4)
}

/// [`bicubic_points`] of a regular face of a mesh, `vertex(v)` being the value at mesh vertex `v`.
///
/// # Panics
/// If the face is not regular.
pub(crate) fn regular_points<T: Blend>(topology: &Topology, face: u32, vertex: impl Fn(u32) -> T) -> [T; 16] {
    let half_edges = topology.mesh().face_corners(face).map(|h| h as u32);
    let rings = CornerRings::new(topology, half_edges, vertex, |ring, _| ring.frame());
    bicubic_points(rings.corners().as_slice().try_into().expect("a quad has four corners"))
}

/// A bicubic Bezier patch at (u, v).
///
/// GLSL twin: `glsl/schemes/bicubic/scheme_evaluate.glsl`.
pub fn evaluate_bicubic<P: Point>(points: &[P; 16], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    let corner = |slots: [usize; 4]| {
        let [p, plus, minus, inner] = slots.map(|slot| points[slot]);
        TensorCorner::new(p, plus - p, minus - p, inner - p)
    };
    evaluate_tensor(&CORNER_SLOTS.map(corner), u, v)
}
