//! Ordered one-rings, found by walking around every vertex once.

use super::{Place, SHARP_FROM, Topology};

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

/// What the walk finds, beside the topology it reads.
pub(super) struct RingBuilder<'t> {
    topology: &'t Topology,
    /// How many faces there are at each mesh vertex.
    faces_at: Vec<u32>,
    found: Found,
}

pub(super) struct Found {
    rings: Vec<Ring>,
    places: Vec<Place>,
    /// (half-edge, manifold vertex) where a fan is not the first at its mesh vertex.
    moved: Vec<(u32, u32)>,
    split_sources: Vec<u32>,
}

const NO_PLACE: Place = Place { ring: u32::MAX, index: 0 };

impl<'t> RingBuilder<'t> {
    pub(super) fn new(topology: &'t Topology) -> Self {
        let corners = topology.mesh.corner_count();
        let found = Found {
            rings: Vec::with_capacity(topology.mesh.vertex_count()),
            places: vec![NO_PLACE; corners],
            moved: Vec::new(),
            split_sources: Vec::new(),
        };
        let mut faces_at = vec![0; topology.mesh.vertex_count()];
        for &vertex in &topology.mesh.data().face_vertices {
            faces_at[vertex as usize] += 1;
        }
        Self { topology, faces_at, found }
    }

    pub(super) fn build(mut self) -> Found {
        let topology = self.topology;
        let vertex_count = topology.mesh.vertex_count();
        let mut has_fan = vec![false; vertex_count];
        let mut fan = Vec::new();
        for half_edge in 0..topology.mesh.corner_count() as u32 {
            if self.found.places[half_edge as usize] != NO_PLACE {
                continue;
            }
            let closed = self.walk(half_edge, &mut fan);
            let source = topology.mesh_vertex(half_edge);
            if std::mem::replace(&mut has_fan[source as usize], true) {
                let vertex = (vertex_count + self.found.split_sources.len()) as u32;
                self.found.split_sources.push(source);
                self.found.moved.extend(fan.iter().map(|&h| (h, vertex)));
            }
            self.split_into_rings(source, &mut fan, closed);
        }
        self.found
    }

    /// Collects the half-edges of the fan around the start of `first`, counter-clockwise, from the boundary if there
    /// is one. Tells whether the fan is closed.
    fn walk(&self, first: u32, fan: &mut Vec<u32>) -> bool {
        let topology = self.topology;
        fan.clear();
        let mut start = first;
        let closed = loop {
            match topology.twin(start) {
                None => break false,
                Some(twin) => start = topology.next(twin),
            }
            if start == first {
                break true;
            }
        };
        let mut half_edge = start;
        loop {
            fan.push(half_edge);
            match topology.twin(topology.prev(half_edge)) {
                Some(next) if next != start => half_edge = next,
                _ => break,
            }
        }
        closed
    }

    /// Cuts a fan at its sharp edges.
    fn split_into_rings(&mut self, source: u32, fan: &mut [u32], closed: bool) {
        let topology = self.topology;
        let is_cut = |h: &u32| topology.is_sharp(*h);
        let inner_cuts = fan.iter().filter(|h| is_cut(h)).count();
        let cuts = if closed { inner_cuts } else { inner_cuts + 2 };
        let tagged = topology.mesh.vertex_sharpness(source) >= SHARP_FROM;
        let lone_corner = !closed && fan.len() == 1 && topology.interpolates_corners();
        let touches = fan.len() < self.faces_at[source as usize] as usize;
        let kind = match cuts {
            _ if tagged || lone_corner || touches => RingKind::Corner,
            0 | 1 => RingKind::Smooth,
            2 => RingKind::Crease,
            _ => RingKind::Corner,
        };
        // A dart does not cut: both sides of its edge are one smooth ring. At a corner every sharp edge cuts.
        if closed && (inner_cuts == 0 || kind == RingKind::Smooth) {
            self.push_ring(fan, kind, false);
            return;
        }
        if closed {
            let first_cut = fan.iter().position(is_cut).unwrap_or(0);
            fan.rotate_left(first_cut);
        }
        let mut rest = &*fan;
        while !rest.is_empty() {
            let end = rest[1..].iter().position(is_cut).map_or(rest.len(), |at| at + 1);
            let (sector, tail) = rest.split_at(end);
            self.push_ring(sector, kind, true);
            rest = tail;
        }
    }

    fn push_ring(&mut self, half_edges: &[u32], kind: RingKind, open: bool) {
        let topology = self.topology;
        let ring = self.found.rings.len() as u32;
        for (index, &half_edge) in half_edges.iter().enumerate() {
            self.found.places[half_edge as usize] = Place { ring, index: index as u32 };
        }
        self.found.rings.push(Ring {
            start: half_edges[0],
            faces: half_edges.len() as u32,
            kind,
            open,
            quads: half_edges.iter().all(|&h| topology.face_size(h) == 4),
        });
    }
}

impl Found {
    pub(super) fn store(self, topology: &mut Topology) {
        topology.rings = self.rings;
        topology.places = self.places;
        topology.touching = self.split_sources.clone();
        topology.touching.sort_unstable();
        topology.touching.dedup();
        topology.split_sources = self.split_sources;
        if !self.moved.is_empty() {
            topology.vertices = topology.mesh.data().face_vertices.clone();
            for (half_edge, vertex) in self.moved {
                topology.vertices[half_edge as usize] = vertex;
            }
        }
    }
}
