//! The schemes, each a way to approximate the Catmull-Clark surface by patches, one a face.
//!
//! A scheme is three things: a file beside this one with its construction and evaluation, its shaders
//! (`glsl/construct/NAME.tesc` for the two-stage construction, `glsl/evaluate/NAME.tese`), and its arms in the `match`es of
//! this file and of `renderer/stages.rs`. Regular faces are bicubic patches in every scheme.

use super::gregory::PatchCorner;
use super::{Blend, Frame, Point, RingValues, Sample, acc, bicubic, gregory, pm};
use crate::topology::{PatchKind, RingKind, Topology};

/// A way to approximate the Catmull-Clark surface by patches, one a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Scheme {
    /// Gregory patches for irregular faces ([`gregory`]): quads and triangles, boundaries, G1 everywhere.
    #[default]
    Gregory,
    /// A geometry patch and two tangent patches for irregular faces ([`acc`]): quads only; the shading is smooth, the
    /// surface has a faint kink at the edges of irregular faces.
    Acc,
    /// Quartic pieces around the centre of each irregular face ([`pm`]): quads and triangles, no boundaries or creases; G1.
    Pm,
    /// The Pm-patches of quads, as first published ([`pm`]): no triangles.
    CPatch,
}

/// A face that a scheme has no patch for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("face {face}: the scheme {} has no patches for {what}: choose the scheme gregory, which has", scheme.name())]
pub struct Undefined {
    /// The scheme that was asked for.
    pub scheme: Scheme,
    /// The face, of the mesh that patches are made of.
    pub face: u32,
    /// What the face is, in the plural.
    pub what: &'static str,
}

impl Scheme {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Gregory, Self::Acc, Self::Pm, Self::CPatch];

    /// As the program calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gregory => "gregory",
            Self::Acc => "acc",
            Self::Pm => "pm",
            Self::CPatch => "c-patch",
        }
    }

    /// Tells whether the scheme has a patch for a face.
    ///
    /// # Errors
    /// [`Undefined`] says why it has none.
    pub fn check(self, topology: &Topology, face: u32, kind: PatchKind) -> Result<(), Undefined> {
        let what = match (kind, self) {
            (PatchKind::Regular, _) | (_, Self::Gregory) => None,
            (PatchKind::Triangle, Self::Acc | Self::CPatch) => Some("triangles"),
            (_, Self::Acc) => None,
            (_, Self::Pm | Self::CPatch) => pm_lacks(topology, face),
        };
        what.map_or(Ok(()), |what| Err(Undefined { scheme: self, face, what }))
    }

    /// How many control points each corner of a patch owns.
    pub fn owned(self, kind: PatchKind) -> usize {
        match (kind, self) {
            (PatchKind::Regular, _) => 4,
            (_, Self::Gregory) => 5,
            (_, Self::Acc) => 8,
            (_, Self::Pm | Self::CPatch) => 6,
        }
    }

    /// How many control points the corners of some kind of patch own, at most.
    pub fn most_owned(self) -> usize {
        PatchKind::ALL.into_iter().map(|kind| self.owned(kind)).max().unwrap_or(0)
    }

    /// How many control points a patch has. Each is owned by one corner.
    pub fn points(self, kind: PatchKind) -> usize {
        kind.corners() * self.owned(kind)
    }

    /// Where the control points that corner `k` owns stand among those of the patch, in the order in which shaders keep
    /// them.
    pub fn corner_slots(self, kind: PatchKind, k: usize) -> Vec<usize> {
        let n = kind.corners();
        match (kind, self) {
            (PatchKind::Regular, _) => bicubic::CORNER_SLOTS[k].to_vec(),
            (_, Self::Gregory) => vec![k, n + 2 * k, n + 2 * k + 1, 3 * n + 2 * k, 3 * n + 2 * k + 1],
            (_, Self::Acc) => acc::corner_slots(k).to_vec(),
            (_, Self::Pm | Self::CPatch) => pm::corner_slots(n, k).to_vec(),
        }
    }

    /// What the first stage of the two-stage construction makes of a one-ring. For regular rings it is the same in all
    /// schemes.
    pub fn frame<T: Blend>(self, ring: &RingValues<T>) -> Frame<T> {
        match self {
            Self::Gregory => ring.frame(),
            Self::Acc => acc::acc_frame(ring),
            Self::Pm | Self::CPatch => pm::pm_frame(ring),
        }
    }

    /// The control points of the patch of one face, `vertex(v)` being the value at mesh vertex `v`. Orders are those of
    /// [`bicubic`] for regular faces, else of the scheme's own module.
    ///
    /// # Panics
    /// If `kind` is not the face's own ([`Topology::patch_kind`]), a face beside it has more than four corners, or the
    /// scheme is not defined there ([`Scheme::check`]).
    pub fn control_points<T: Blend>(
        self,
        topology: &Topology,
        face: u32,
        kind: PatchKind,
        vertex: impl Fn(u32) -> T,
    ) -> Vec<T> {
        let half_edges = topology.mesh().face_corners(face);
        let rings: Vec<_> = half_edges
            .clone()
            .map(|h| {
                let place = topology.place(h as u32);
                let ring = RingValues::new(topology, &topology.rings()[place.ring as usize], &vertex);
                let frame = self.frame(&ring);
                (ring, frame, place.index as usize)
            })
            .collect();
        let corners: Vec<_> =
            rings.iter().map(|(ring, frame, index)| PatchCorner { ring, frame, index: *index }).collect();
        let four = || <&[_; 4]>::try_from(corners.as_slice()).expect("the patch is a quad");
        match (kind, self) {
            (PatchKind::Regular, _) => bicubic::bicubic_points(four()).into(),
            (_, Self::Gregory) => gregory::gregory_points(&corners),
            (_, Self::Acc) => acc::acc_points(four()),
            (_, Self::Pm | Self::CPatch) => pm::pm_points(&corners),
        }
    }

    /// A patch evaluated at parameters: (u, v) of a quad, the first two barycentric coordinates of a triangle.
    ///
    /// # Panics
    /// If there are not as many points as [`Scheme::points`] says.
    pub fn evaluate<P: Point>(self, kind: PatchKind, points: &[P], u: P::Scalar, v: P::Scalar) -> Sample<P> {
        const COUNT: &str = "a patch has the control points of its kind";
        match (kind, self) {
            (PatchKind::Regular, _) => bicubic::evaluate_bicubic(points.try_into().expect(COUNT), u, v),
            (PatchKind::IrregularQuad, Self::Gregory) => {
                gregory::evaluate_gregory_quad(points.try_into().expect(COUNT), u, v)
            }
            (PatchKind::Triangle, Self::Gregory) => {
                gregory::evaluate_gregory_triangle(points.try_into().expect(COUNT), u, v)
            }
            (_, Self::Acc) => acc::evaluate_acc(points.try_into().expect(COUNT), u, v),
            (PatchKind::IrregularQuad, Self::Pm | Self::CPatch) => {
                pm::evaluate_pm_quad(points.try_into().expect(COUNT), u, v)
            }
            (PatchKind::Triangle, Self::Pm | Self::CPatch) => {
                pm::evaluate_pm_triangle(points.try_into().expect(COUNT), u, v)
            }
        }
    }
}

/// Why Pm-patches are not defined on a face, if they are not.
fn pm_lacks(topology: &Topology, face: u32) -> Option<&'static str> {
    topology.mesh().face_corners(face).find_map(|h| {
        let ring = topology.rings()[topology.place(h as u32).ring as usize];
        match ring.kind {
            RingKind::Smooth if ring.faces < 3 => Some("faces at a vertex with two faces"),
            RingKind::Smooth => None,
            _ => Some("irregular faces at a boundary, crease or corner"),
        }
    })
}
