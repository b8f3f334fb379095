//! What makes faces irregular, and for how many levels.

use super::options::AdaptiveOptions;
use crate::limit::is_semi_sharp;
use crate::mesh::{BoundaryRule, CreaseMethod, SHARPNESS_INFINITE};
use crate::named::named;
use crate::topology::{RingKind, Topology};

named! {
    /// Why a cell is refined.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
    #[non_exhaustive]
    pub enum Reason {
        /// A face with other than four corners, or a quad that touches one.
        NonQuad = "non-quad",
        /// A vertex with other than four faces; on a boundary or an infinitely sharp crease other than two on a side.
        ExtraordinaryVertex = "extraordinary vertex",
        /// A crease of finite sharpness that does not go straight on with the same sharpness, or two along one face.
        VaryingCrease = "varying crease",
        /// The end of a crease.
        Dart = "dart",
        /// A vertex of finite sharpness, three or more creases that meet, or a corner with several faces on a side.
        Corner = "corner",
        /// A crease of finite sharpness, with [`AdaptiveOptions::refine_creases`].
        Crease = "crease",
    }
}

/// What a vertex asks of the faces around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Class {
    /// Regular in all sectors between infinitely sharp edges, and nothing there is of finite sharpness.
    Plain,
    /// On a crease of finite, equal sharpness on both sides, straight through four quads.
    Crease,
    Feature(Feature),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Feature {
    /// What is irregular for ever.
    lasting: Option<Reason>,
    /// What is sharp.
    sharp: Option<Reason>,
    /// Whether the sectors around the vertex are those of the limit: nothing is of finite sharpness, and there is no dart.
    settled: bool,
    /// Whether something there is of finite sharpness.
    finite: bool,
}

impl Class {
    /// Why faces around the vertex are refined at a level.
    pub(super) fn reason(&self, level: u32, options: &AdaptiveOptions) -> Option<Reason> {
        let Self::Feature(feature) = self else { return None };
        let lasting = feature.lasting.filter(|_| level < options.depth);
        lasting.or(feature.sharp.filter(|_| level < options.sharp_depth()))
    }

    /// Whether something at the vertex is of finite sharpness.
    pub(super) fn is_finite(&self) -> bool {
        match self {
            Self::Plain => false,
            Self::Crease => true,
            Self::Feature(feature) => feature.finite,
        }
    }

    /// Whether nothing at the vertex is of finite sharpness, and it is no dart.
    pub(super) fn is_settled(&self) -> bool {
        match self {
            Self::Plain => true,
            Self::Crease => false,
            Self::Feature(feature) => feature.settled,
        }
    }
}

/// All faces around a vertex, with what is sharp there.
struct Fan {
    /// A spoke for each face.
    spokes: Vec<u32>,
    open: bool,
    quads: bool,
    /// The spokes inside that are infinitely sharp.
    infinite: Vec<usize>,
    /// The spokes inside that are of finite sharpness.
    finite: Vec<usize>,
    /// Sharpness of the vertex itself.
    tag: f32,
    /// Whether the rule for boundaries, or the tag, makes the vertex a corner for ever.
    pinned: bool,
}

impl Fan {
    fn new(topology: &Topology, half_edge: u32) -> Self {
        let (spokes, open) = topology.fan(half_edge);
        let inner = || (0..spokes.len()).skip(usize::from(open));
        let sharpness = |&i: &usize| topology.sharpness(spokes[i]);
        let infinite = inner().filter(|i| sharpness(i) >= SHARPNESS_INFINITE).collect();
        let finite = inner().filter(|i| is_semi_sharp(sharpness(i))).collect();
        let tag = topology.vertex_sharpness(topology.mesh_vertex(half_edge));
        let lone = open && spokes.len() == 1 && topology.mesh().data().boundary == BoundaryRule::EdgeAndCorner;
        let quads = spokes.iter().all(|&h| topology.face_size(h) == 4);
        Self { open, quads, infinite, finite, tag, pinned: lone || tag >= SHARPNESS_INFINITE, spokes }
    }

    /// Boundary edges and edges with a sharpness.
    fn sharp_edges(&self) -> usize {
        self.infinite.len() + self.finite.len() + if self.open { 2 } else { 0 }
    }

    fn is_dart(&self) -> bool {
        !self.open && self.infinite.len() == 1 && !self.pinned
    }

    fn has_finite_sharpness(&self) -> bool {
        !self.finite.is_empty() || is_semi_sharp(self.tag)
    }

    fn is_settled(&self) -> bool {
        !self.has_finite_sharpness() && !self.is_dart()
    }

    /// Whether each sector is regular once what is of finite sharpness is used up.
    fn is_regular(&self) -> bool {
        let (n, cuts) = (self.spokes.len(), self.infinite.len() + if self.open { 2 } else { 0 });
        if cuts < 2 {
            return self.quads && n == 4 && !self.pinned;
        }
        let faces = if cuts > 2 || self.pinned { 1 } else { 2 };
        let sectors = cuts - usize::from(self.open);
        // Sectors of equal length start at equal distances.
        let first = if self.open { 0 } else { self.infinite[0] };
        let starts = self.infinite.iter().enumerate();
        let is_even = |(i, &at): (usize, &usize)| at == first + faces * (i + usize::from(self.open));
        self.quads && n == faces * sectors && { starts }.all(is_even)
    }

    /// Whether a crease goes straight through four quads, equally sharp on both sides.
    fn is_crease(&self, topology: &Topology) -> bool {
        let [a, b] = self.finite[..] else { return false };
        let plain = !self.open && self.quads && self.spokes.len() == 4 && self.infinite.is_empty() && self.tag == 0.0;
        plain && b == a + 2 && topology.sharpness(self.spokes[a]) == topology.sharpness(self.spokes[b])
    }
}

/// The class of the vertex from which a half-edge starts.
pub(super) fn classify(topology: &Topology, half_edge: u32) -> Class {
    if is_plain(topology, half_edge) {
        return Class::Plain;
    }
    let fan = Fan::new(topology, half_edge);
    if fan.is_crease(topology) {
        return Class::Crease;
    }
    let (settled, regular) = (fan.is_settled(), fan.is_regular());
    if settled && regular {
        return Class::Plain;
    }
    let is_corner = fan.pinned || fan.tag > 0.0 || fan.sharp_edges() > 2;
    let sharp = match fan.sharp_edges() {
        _ if is_corner => Some(Reason::Corner),
        1 => Some(Reason::Dart),
        _ if settled => None,
        _ => Some(Reason::VaryingCrease),
    };
    let lasting = match (fan.quads, regular) {
        (false, _) => Some(Reason::NonQuad),
        (_, true) => None,
        // Corners with several faces on a side are sharp for ever.
        _ if fan.pinned || fan.infinite.len() + if fan.open { 2 } else { 0 } > 2 => None,
        _ => Some(Reason::ExtraordinaryVertex),
    };
    Class::Feature(Feature { lasting, sharp, settled, finite: fan.has_finite_sharpness() })
}

/// Whether a look at one ring tells that the vertex from which a half-edge starts is [`Class::Plain`].
fn is_plain(topology: &Topology, half_edge: u32) -> bool {
    let ring = &topology.rings()[topology.place(half_edge).ring as usize];
    let vertex = topology.mesh_vertex(half_edge);
    if !ring.is_regular() || topology.touches(vertex) {
        return false;
    }
    let data = topology.mesh().data();
    if data.creases.is_empty() && data.corners.is_empty() {
        // There is one ring around the vertex.
        return true;
    }
    let is_smooth = ring.kind == RingKind::Smooth && topology.vertex_sharpness(vertex) == 0.0;
    is_smooth && topology.ring_half_edges(ring).all(|h| topology.sharpness(h) == 0.0)
}

/// Whether something at the vertex from which a half-edge starts is of finite sharpness.
pub(super) fn has_finite_sharpness(topology: &Topology, half_edge: u32) -> bool {
    Fan::new(topology, half_edge).has_finite_sharpness()
}

/// How a quad can be drawn as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    Regular,
    /// With a crease along the edge of a half-edge.
    SingleCrease {
        half_edge: u32,
        sharpness: f32,
    },
    Irregular,
}

/// The shape of a quad whose corners have the classes `class(half_edge)`.
pub(super) fn shape(topology: &Topology, face: u32, class: impl Fn(u32) -> Class) -> Shape {
    let corners = topology.mesh().face_corners(face).map(|h| h as u32);
    let is_sound = |h: u32| match class(h) {
        Class::Plain | Class::Crease => true,
        Class::Feature(feature) => feature.settled && topology.rings()[topology.place(h).ring as usize].is_regular(),
    };
    if !corners.clone().all(is_sound) {
        return Shape::Irregular;
    }
    let mut creases = corners.filter(|&h| is_semi_sharp(topology.sharpness(h)));
    match (creases.next(), creases.next()) {
        (None, _) => Shape::Regular,
        (Some(half_edge), None) => Shape::SingleCrease { half_edge, sharpness: topology.sharpness(half_edge) },
        _ => Shape::Irregular,
    }
}

/// Whether the crease along a half-edge, whose ends are [`Class::Crease`], is constant as far as refinement must know: by
/// Chaikin's method an edge further, else leaves beside it would meet leaves two levels finer.
pub(super) fn is_constant(topology: &Topology, half_edge: u32) -> bool {
    if topology.mesh().data().crease_method == CreaseMethod::Uniform {
        return true;
    }
    // The next edge of the crease, from the end of one.
    let straight_on = |h: u32| {
        let left = topology.twin(topology.next(h))?;
        Some(topology.next(left))
    };
    let goes_on = |h: u32| {
        let beyond = straight_on(h)?;
        let end = topology.twin(beyond).unwrap_or(topology.next(beyond));
        Some(classify(topology, end) == Class::Crease)
    };
    let twin = topology.twin(half_edge);
    goes_on(half_edge) == Some(true) && twin.and_then(goes_on) == Some(true)
}
