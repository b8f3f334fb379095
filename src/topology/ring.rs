//! Ordered one-rings.

/// The rule by which a ring's limit point and tangents are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RingKind {
    /// Inside the surface, all around the vertex. A dart (one sharp edge) counts as smooth.
    Smooth,
    /// Between two boundary or sharp edges that run smoothly through the vertex.
    Crease,
    /// The surface passes through the control vertex itself: a tagged corner, three or more sharp edges, the only
    /// face at a boundary vertex (under [`crate::mesh::BoundaryRule::EdgeAndCorner`]), or a vertex in which several
    /// fans of faces touch, which stay together that way.
    Corner,
}

/// The ordered one-ring of a vertex, or the sector of it between two sharp edges.
///
/// Edges and faces count counter-clockwise, face `i` between edges `i` and `i + 1`. A closed ring of `n` faces has
/// `n` edges; an open one has `faces + 1`, the first and the last of which are boundary or sharp edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ring {
    /// The half-edge of edge 0, with face 0 on its left.
    pub start: u32,
    /// Number of faces.
    pub faces: u32,
    /// The rule for its limit point and tangents.
    pub kind: RingKind,
    /// Whether the first and the last edge differ.
    pub open: bool,
    /// Whether all faces are quads.
    pub quads: bool,
}

impl Ring {
    /// Number of edges.
    pub fn edges(&self) -> u32 {
        self.faces + u32::from(self.open)
    }

    /// Whether a quad whose four rings are so is a bicubic B-spline patch (with mirrored ghost vertices outside).
    pub fn is_regular(&self) -> bool {
        let faces = match (self.kind, self.open) {
            (RingKind::Smooth, _) => 4,
            (RingKind::Crease, _) => 2,
            (RingKind::Corner, true) => 1,
            (RingKind::Corner, false) => return false,
        };
        self.quads && self.faces == faces
    }
}

/// Where a face corner stands in its vertex's one-ring: its face is ring face `index`, its *plus* edge (to the next
/// corner of the face) ring edge `index`, its *minus* edge ring edge `index + 1`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Index into [`Topology::rings`](super::Topology::rings).
    pub ring: u32,
    /// Index of the face in the ring.
    pub index: u32,
}
