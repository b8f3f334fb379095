//! Patch schemes: how control points come from control vertices, and how a patch is evaluated from them.
//!
//! Every construction is linear in the control vertices, and is written once over values that can be [`Blend`]ed:
//! with [`DVec3`](glam::DVec3) it gives reference control points, with [`Vec3`](glam::Vec3) those of the CPU path,
//! with [`Row`] the weights of a stencil. Every function of a surface here has a GLSL twin of the same name.
//!
//! Parameters: a quad with corners `V_0..V_3` has `V_0` at (u, v) = (0, 0), `V_1` at (1, 0), `V_2` at (1, 1) and `V_3`
//! at (0, 1). A triangle has barycentric (u, v, w), u = 1 at `V_0`, v = 1 at `V_1`, w = 1 at `V_2`. Normals point to
//! the side from which the corners are counter-clockwise. At corner k the *plus* edge leads to corner k + 1, the
//! *minus* edge to corner k - 1.

pub mod bicubic;
mod blend;
pub mod gregory;
mod point;
mod ring;

pub use blend::{Blend, Row};
pub(crate) use point::scalar;
pub use point::{Point, Sample};
pub use ring::{Frame, RingShape, RingValues};

use crate::topology::{PatchKind, Topology};

/// A way to approximate the Catmull-Clark surface by patches, one a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Scheme {
    /// Gregory patches for irregular faces ([`gregory`]), bicubic patches for regular ones ([`bicubic`]).
    #[default]
    Gregory,
}

impl Scheme {
    /// Every scheme.
    pub const ALL: [Self; 1] = [Self::Gregory];

    /// As the program calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gregory => "gregory",
        }
    }
}

/// The control points of the patch of one face, `vertex(v)` being the value at mesh vertex `v`.
///
/// 16 for [`PatchKind::Regular`] (see [`bicubic`]), 20 and 15 for the others (see [`gregory`]).
///
/// # Panics
/// If `kind` is not the face's own ([`Topology::patch_kind`]), or a face beside it has more than four corners.
pub fn control_points<T: Blend>(topology: &Topology, face: u32, kind: PatchKind, vertex: impl Fn(u32) -> T) -> Vec<T> {
    let half_edges = topology.mesh().face_corners(face);
    let rings: Vec<_> = half_edges
        .clone()
        .map(|h| {
            let place = topology.place(h as u32);
            let ring = RingValues::new(topology, &topology.rings()[place.ring as usize], &vertex);
            let frame = ring.frame();
            (ring, frame, place.index as usize)
        })
        .collect();
    let corners: Vec<_> =
        rings.iter().map(|(ring, frame, index)| gregory::PatchCorner { ring, frame, index: *index }).collect();
    match (kind, <&[_; 4]>::try_from(corners.as_slice())) {
        (PatchKind::Regular, Ok(corners)) => bicubic::bicubic_points(corners).into(),
        _ => gregory::gregory_points(&corners),
    }
}

/// A patch evaluated at parameters: (u, v) of a quad, the first two barycentric coordinates of a triangle.
///
/// # Panics
/// If there are not as many points as the kind of patch has.
pub fn evaluate<P: Point>(kind: PatchKind, points: &[P], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    const COUNT: &str = "a patch has the control points of its kind";
    match kind {
        PatchKind::Regular => bicubic::evaluate_bicubic(points.try_into().expect(COUNT), u, v),
        PatchKind::IrregularQuad => gregory::evaluate_gregory_quad(points.try_into().expect(COUNT), u, v),
        PatchKind::Triangle => gregory::evaluate_gregory_triangle(points.try_into().expect(COUNT), u, v),
    }
}
