//! The schemes, each a way to approximate the Catmull-Clark surface by patches, one a face.
//!
//! A scheme is three things: a file beside this one with its construction and evaluation, a folder `glsl/schemes/NAME` with the same
//! as shaders, and its registration: its arms in this file, and its forms of patches in `form.rs` beside it. Regular faces are bicubic
//! patches in every scheme.

use super::fitted::Fit;
use super::form::{FormFacts, PatchForm};
use super::{FallbackRings, acc, fitted, gregory, pm};
use crate::blend::{Blend, CornerRings, Frame, Point, RingShape, RingValues, Sample, bicubic};
use crate::named::named;
use crate::topology::{PatchKind, RingKind, Topology};

named! {
    /// A way to approximate the Catmull-Clark surface by patches, one a face.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
    #[non_exhaustive]
    pub enum Scheme {
        /// Gregory patches for irregular faces ([`gregory`]): quads and triangles, boundaries, G1 everywhere.
        #[default]
        Gregory = "gregory",
        /// Gregory patches that are closer to the limit surface ([`fitted`]): the same points and evaluation, with other tangent
        /// lengths and transversals.
        GregoryFitted = "gregory-fitted",
        /// A geometry patch and two tangent patches for irregular faces ([`acc`]): quads only; the shading is smooth, the
        /// surface has a faint kink at the edges of irregular faces.
        Acc = "acc",
        /// Quartic pieces around the centre of each irregular face ([`pm`]): triangles, quads and pentagons, no boundaries or
        /// creases; G1.
        Pm = "pm",
        /// The Pm-patches of quads, as first published ([`pm`]): no triangles.
        CPatch = "c-patch",
    }
}

/// A face that a scheme has no patch for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("face {face}: the scheme {} has no patches for {what}: choose the scheme gregory, which has, or name it as fallback", scheme.name())]
pub struct Undefined {
    /// The scheme that was asked for.
    pub scheme: Scheme,
    /// The face, of the mesh that patches are made of.
    pub face: u32,
    /// Kind of the face, in the plural.
    pub what: &'static str,
}

impl Scheme {
    /// Kind of the patch that the scheme has for a face.
    ///
    /// # Errors
    /// [`Undefined`] says why it has none.
    pub fn check(self, topology: &Topology, face: u32) -> Result<PatchKind, Undefined> {
        let kind = topology.patch_kind(face);
        let what = match (kind, self) {
            (None, _) => Some("faces of six or more corners"),
            (Some(kind), _) if self.form(kind).is_none() => Some(match kind {
                PatchKind::Regular | PatchKind::IrregularQuad => "quads",
                PatchKind::Triangle => "triangles",
                PatchKind::Pentagon => "faces of five corners",
            }),
            (Some(PatchKind::Regular), _) => None,
            (_, Self::Pm | Self::CPatch) => pm_lacks(topology, face),
            _ => None,
        };
        match (kind, what) {
            (Some(kind), None) => Ok(kind),
            (_, what) => Err(Undefined { scheme: self, face, what: what.unwrap_or_default() }),
        }
    }

    /// The form of the scheme's patches for faces of a kind, if it has any.
    pub(crate) fn form(self, kind: PatchKind) -> Option<PatchForm> {
        Some(match (kind, self) {
            (PatchKind::Regular, _) => PatchForm::Bicubic,
            (PatchKind::IrregularQuad, Self::Gregory | Self::GregoryFitted) => PatchForm::GregoryQuad,
            (PatchKind::Triangle, Self::Gregory | Self::GregoryFitted) => PatchForm::GregoryTriangle,
            (PatchKind::IrregularQuad, Self::Acc) => PatchForm::AccQuad,
            (PatchKind::IrregularQuad, Self::Pm | Self::CPatch) => PatchForm::PmQuad,
            (PatchKind::Triangle, Self::Pm) => PatchForm::PmTriangle,
            (PatchKind::Pentagon, Self::Pm) => PatchForm::PmPentagon,
            _ => return None,
        })
    }

    /// What sets the forms of all its patches apart.
    fn facts(self) -> impl Iterator<Item = FormFacts> {
        PatchKind::ALL.into_iter().filter_map(move |kind| self.form(kind)).map(PatchForm::facts)
    }

    /// Whether the scheme has patches for faces of five corners; the others have such meshes refined.
    pub fn has_pentagons(self) -> bool {
        self.form(PatchKind::Pentagon).is_some()
    }

    /// Whether the scheme has patches that end adaptive subdivision around what is irregular:
    /// [`adaptive`](crate::adaptive).
    pub fn has_caps(self) -> bool {
        self.facts().any(|form| form.may_be_adaptive)
    }

    /// Control points that each corner of a patch owns; 0 if the scheme has no patches of the kind.
    pub fn owned(self, kind: PatchKind) -> usize {
        self.form(kind).map_or(0, |form| form.facts().owned)
    }

    /// Control points of a patch. One corner owns each.
    pub fn points(self, kind: PatchKind) -> usize {
        kind.corners() * self.owned(kind)
    }

    /// Where the control points that corner `k` owns stand among those of the patch, in the order in which shaders keep
    /// them.
    pub fn corner_slots(self, kind: PatchKind, k: usize) -> Vec<usize> {
        let n = kind.corners();
        match (kind, self) {
            (PatchKind::Regular, _) => bicubic::CORNER_SLOTS[k].to_vec(),
            (_, Self::Gregory | Self::GregoryFitted) => {
                vec![k, n + 2 * k, n + 2 * k + 1, 3 * n + 2 * k, 3 * n + 2 * k + 1]
            }
            (_, Self::Acc) => acc::corner_slots(k).to_vec(),
            (_, Self::Pm | Self::CPatch) => pm::corner_slots(n, k).to_vec(),
        }
    }

    /// The name of a control point in the scheme's paper.
    pub fn point_name(self, kind: PatchKind, number: usize) -> String {
        let n = kind.corners();
        match (kind, self) {
            (PatchKind::Regular, _) => bicubic::point_name(number),
            (_, Self::Gregory | Self::GregoryFitted) => gregory::point_name(n, number),
            (_, Self::Acc) => acc::point_name(number),
            (_, Self::Pm | Self::CPatch) => pm::point_name(n, number),
        }
    }

    /// Values that the shaders keep of the control points that a corner of a patch owns ([`Scheme::corner_slots`]). Where the scheme
    /// [shares the frame](Scheme::shares_frame), after the limit point: the edge points as seen from there; of quads, the inner
    /// point as seen from where these two lead to one after the other, of triangles as seen from the limit point; of Gregory
    /// patches, the way from that inner point to the other.
    ///
    /// GLSL twin: `CONTROL_POINT` in `glsl/lib/evaluate/patch.glsl`, which takes it back.
    pub(crate) fn kept<T: Blend>(self, kind: PatchKind, owned: &[T]) -> Vec<T> {
        if !self.shares_frame(kind) {
            return owned.to_vec();
        }
        let [p, plus, minus] = [0, 1, 2].map(|i| &owned[i]);
        let seen = |x: &T| T::sum([(1.0, x), (-1.0, p)]);
        let inner = |inner: &T| match kind {
            PatchKind::Triangle => seen(inner),
            _ => T::sum([(1.0, inner), (1.0, p), (-1.0, plus), (-1.0, minus)]),
        };
        let first = owned.get(3).map(inner);
        let last = owned.get(4).map(|last| T::sum([(1.0, last), (-1.0, &owned[3])]));
        [p.clone(), seen(plus), seen(minus)].into_iter().chain(first).chain(last).collect()
    }

    /// Tangent frame that the first stage of the two-stage construction makes of a one-ring. Regular rings have the same in all
    /// schemes, and so have all where some of the faces fall back ([`RingShape::fallback`](super::RingShape::fallback)).
    pub fn frame<T: Blend>(self, ring: &RingValues<T>) -> Frame<T> {
        match self {
            _ if ring.shape.fallback => ring.frame(),
            Self::Gregory => ring.frame(),
            Self::GregoryFitted => fitted::fitted_frame(ring, &Fit::GREGORY),
            Self::Acc => acc::acc_frame(ring),
            Self::Pm | Self::CPatch => pm::pm_frame(ring),
        }
    }

    /// The transversal of edge `j` of a ring whose frame is [`Scheme::frame`]: the scheme's own choice of
    /// [`RingValues::transversal`].
    pub fn transversal<T: Blend>(self, ring: &RingValues<T>, frame: &Frame<T>, j: usize) -> T {
        match self {
            Self::GregoryFitted => fitted::fitted_transversal(ring, frame, j, &Fit::GREGORY),
            _ => ring.transversal(j),
        }
    }

    /// The weights in it of [`RingValues::transversal`] and of the frame's tangent at a right angle to edge `j`.
    pub(crate) fn transversal_weights(self, shape: &RingShape, j: usize) -> [f64; 2] {
        match self {
            Self::GregoryFitted => Fit::GREGORY.transversal_weights(shape, j),
            _ => [1.0, 0.0],
        }
    }

    /// Whether the first three control points that a corner of a patch owns are the limit point of its [`Scheme::frame`] and
    /// the edge points at its plus and its minus edge ([`RingValues::edge_point`]): the boundary is then the same
    /// on both sides of an edge.
    pub fn shares_frame(self, kind: PatchKind) -> bool {
        self.form(kind).is_some_and(|form| form.facts().keeps_frame)
    }

    /// Whether patches of all kinds share what they have in common along edges to the last bit ([`Scheme::shares_frame`]).
    pub fn is_watertight(self) -> bool {
        self.facts().all(|form| form.keeps_frame)
    }

    /// The control points of the patch of one face, `vertex(v)` being the value at mesh vertex `v`. Orders are those of
    /// [`bicubic`] for regular faces, else of the scheme's own module.
    ///
    /// # Panics
    /// As [`Scheme::control_points_beside`].
    pub fn control_points<T: Blend>(
        self,
        topology: &Topology,
        face: u32,
        kind: PatchKind,
        vertex: impl Fn(u32) -> T,
    ) -> Vec<T> {
        let half_edges = topology.mesh().face_corners(face).map(|h| h as u32);
        self.control_points_beside(topology, kind, half_edges, &FallbackRings::default(), vertex)
    }

    /// As [`Scheme::control_points`], in a mesh some of whose faces fall back, and given the half-edges of all corners of
    /// the patch, in order: those of the face, from any of them on.
    ///
    /// # Panics
    /// If `kind` is not the face's own ([`Topology::patch_kind`]), a face beside it has more corners than the scheme
    /// has patches for, or the scheme is not defined there ([`Scheme::check`]).
    pub fn control_points_beside<T: Blend>(
        self,
        topology: &Topology,
        kind: PatchKind,
        half_edges: impl Iterator<Item = u32>,
        fallback: &FallbackRings,
        vertex: impl Fn(u32) -> T,
    ) -> Vec<T> {
        let rings = CornerRings::new(topology, half_edges, vertex, |ring, number| {
            ring.shape.fallback = fallback.contains(number);
            self.frame(ring)
        });
        let corners = rings.corners();
        let four = || <&[_; 4]>::try_from(corners.as_slice()).expect("the patch is a quad");
        match (kind, self) {
            (PatchKind::Regular, _) => bicubic::bicubic_points(four()).into(),
            (_, Self::Gregory | Self::GregoryFitted) => {
                gregory::gregory_points(&corners, |corner, j| self.transversal(corner.ring, corner.frame, j))
            }
            (_, Self::Acc) => acc::acc_points(four()),
            (_, Self::Pm | Self::CPatch) => pm::pm_points(&corners),
        }
    }

    /// A patch evaluated at parameters: (u, v) of a quad, the first two barycentric coordinates of a triangle. A piece of a
    /// pentagon is a triangle of its first corner, the next, and the centre of the face.
    ///
    /// # Panics
    /// If there are not as many points as [`Scheme::points`] says.
    pub fn evaluate<P: Point>(self, kind: PatchKind, points: &[P], u: P::Scalar, v: P::Scalar) -> Sample<P> {
        const COUNT: &str = "a patch has the control points of its kind";
        match (kind, self) {
            (PatchKind::Regular, _) => bicubic::evaluate_bicubic(points.try_into().expect(COUNT), u, v),
            (PatchKind::IrregularQuad, Self::Gregory | Self::GregoryFitted) => {
                gregory::evaluate_gregory_quad(points.try_into().expect(COUNT), u, v)
            }
            (PatchKind::Triangle, Self::Gregory | Self::GregoryFitted) => {
                gregory::evaluate_gregory_triangle(points.try_into().expect(COUNT), u, v)
            }
            (_, Self::Acc) => acc::evaluate_acc(points.try_into().expect(COUNT), u, v),
            (PatchKind::IrregularQuad, Self::Pm | Self::CPatch) => {
                pm::evaluate_pm_quad(points.try_into().expect(COUNT), u, v)
            }
            (PatchKind::Triangle, Self::Pm | Self::CPatch) => {
                pm::evaluate_pm_triangle(points.try_into().expect(COUNT), u, v)
            }
            (PatchKind::Pentagon, _) => pm::evaluate_pm_pentagon(points.try_into().expect(COUNT), u, v),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_own_every_point_once() {
        for scheme in Scheme::ALL {
            let forms = PatchKind::ALL.into_iter().filter_map(|kind| Some((kind, scheme.form(kind)?.facts())));
            for (kind, form) in forms {
                assert_eq!(form.corners, kind.corners(), "{scheme:?} {kind:?}");
                let mut slots: Vec<usize> = (0..form.corners).flat_map(|k| scheme.corner_slots(kind, k)).collect();
                slots.sort_unstable();
                assert!(slots.into_iter().eq(0..scheme.points(kind)), "{scheme:?} {kind:?}");
            }
        }
    }

    #[test]
    fn points_have_the_names_of_the_paper() {
        let of = |scheme, kind| (0..Scheme::points(scheme, kind)).map(move |i| scheme.point_name(kind, i));
        let names = |scheme, kind| of(scheme, kind).collect::<Vec<_>>().join(" ");
        assert_eq!(
            names(Scheme::Gregory, PatchKind::Triangle),
            "p0 p1 p2 e0+ e0- e1+ e1- e2+ e2- f0+ f0- f1+ f1- f2+ f2-"
        );
        assert!(names(Scheme::Gregory, PatchKind::IrregularQuad).ends_with("e3+ e3- f0+ f0- f1+ f1- f2+ f2- f3+ f3-"));
        assert!(names(Scheme::Pm, PatchKind::Regular).starts_with("b00 b01 b02 b03 b10"));
        assert!(
            names(Scheme::Acc, PatchKind::IrregularQuad)
                .ends_with("b33 t0+ t0- x0+ x0- t1+ t1- x1+ x1- t2+ t2- x2+ x2- t3+ t3- x3+ x3-")
        );
        let pm = names(Scheme::Pm, PatchKind::Pentagon);
        assert!(pm.starts_with("v0 v1 v2 v3 v4 t0+ t0- t1+") && pm.ends_with("b112_3 b112_4"), "{pm}");
    }
}
