//! What the corners of a patch take from their one-rings.

use super::ring::{Frame, RingValues};
use super::values::Blend;
use crate::topology::Topology;

/// What a corner of a patch takes from its one-ring.
#[derive(Debug)]
pub struct PatchCorner<'r, T> {
    /// The one-ring around the corner.
    pub ring: &'r RingValues<T>,
    /// Its limit point and tangents.
    pub frame: &'r Frame<T>,
    /// The ring edge that is the corner's plus edge; the next one is its minus edge.
    pub index: usize,
}

impl<T: Blend> PatchCorner<'_, T> {
    pub(crate) fn plus(&self) -> T {
        self.ring.edge_point(self.frame, self.index)
    }

    pub(crate) fn minus(&self) -> T {
        self.ring.edge_point(self.frame, self.minus_index())
    }

    pub(crate) fn minus_index(&self) -> usize {
        (self.index + 1) % self.ring.shape.edges()
    }
}

/// The one-rings around the corners of a patch, with their frames.
pub(crate) struct CornerRings<T> {
    /// Each with the ring edge that is the corner's plus edge.
    rings: Vec<(RingValues<T>, Frame<T>, usize)>,
}

impl<T: Blend> CornerRings<T> {
    /// The rings around the starts of `half_edges`, `vertex(v)` being the value at mesh vertex `v`. `frame` makes the frame of
    /// a ring, whose number in [`Topology::rings`] it is given.
    pub(crate) fn new(
        topology: &Topology,
        half_edges: impl Iterator<Item = u32>,
        vertex: impl Fn(u32) -> T,
        frame: impl Fn(&mut RingValues<T>, u32) -> Frame<T>,
    ) -> Self {
        let of_corner = |h| {
            let place = topology.place(h);
            let mut ring = RingValues::new(topology, &topology.rings()[place.ring as usize], &vertex);
            let frame = frame(&mut ring, place.ring);
            (ring, frame, place.index as usize)
        };
        Self { rings: half_edges.map(of_corner).collect() }
    }

    pub(crate) fn corners(&self) -> Vec<PatchCorner<'_, T>> {
        self.rings.iter().map(|(ring, frame, index)| PatchCorner { ring, frame, index: *index }).collect()
    }
}
