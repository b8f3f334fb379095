//! One-rings found by walking around every vertex once.

use super::half_edges::{SHARP_FROM, Topology};
use super::ring::{Place, Ring, RingKind};
use crate::mesh::{BoundaryRule, ControlMesh};

impl Topology {
    /// Walks the mesh once: linear in the number of face corners.
    pub fn new(mesh: &ControlMesh) -> Self {
        let sizes = &mesh.data().face_sizes;
        let quads = sizes.iter().all(|&size| size == 4);
        let faces = match quads {
            true => Vec::new(),
            false => (0..).zip(sizes).flat_map(|(face, &size)| std::iter::repeat_n(face, size as usize)).collect(),
        };
        let mut topology = Self {
            mesh: mesh.clone(),
            quads,
            faces,
            vertices: Vec::new(),
            split_sources: Vec::new(),
            touching: Vec::new(),
            rings: Vec::new(),
            places: Vec::new(),
        };
        RingBuilder::new(&topology).build().store(&mut topology);
        topology
    }
}

/// Walk around vertices: the topology that is read, and the rings found.
struct RingBuilder<'t> {
    topology: &'t Topology,
    /// Faces per mesh vertex.
    faces_at: Vec<u32>,
    found: Found,
}

struct Found {
    rings: Vec<Ring>,
    places: Vec<Place>,
    /// (half-edge, manifold vertex) where a fan is not the first at its mesh vertex.
    moved: Vec<(u32, u32)>,
    split_sources: Vec<u32>,
}

const NO_PLACE: Place = Place { ring: u32::MAX, index: 0 };

impl<'t> RingBuilder<'t> {
    fn new(topology: &'t Topology) -> Self {
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

    fn build(mut self) -> Found {
        let topology = self.topology;
        let vertex_count = topology.mesh.vertex_count();
        let mut has_fan = vec![false; vertex_count];
        let mut fan = Vec::new();
        for half_edge in 0..topology.mesh.corner_count() as u32 {
            if self.found.places[half_edge as usize] != NO_PLACE {
                continue;
            }
            let closed = !topology.walk(half_edge, &mut fan);
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

    /// Cuts a fan at its sharp edges.
    fn split_into_rings(&mut self, source: u32, fan: &mut [u32], closed: bool) {
        let topology = self.topology;
        let is_cut = |h: &u32| topology.is_sharp(*h);
        let inner_cuts = fan.iter().filter(|h| is_cut(h)).count();
        let cuts = if closed { inner_cuts } else { inner_cuts + 2 };
        let tagged = topology.mesh.vertex_sharpness(source) >= SHARP_FROM;
        let lone_corner = !closed && fan.len() == 1 && topology.mesh.data().boundary == BoundaryRule::EdgeAndCorner;
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
    fn store(self, topology: &mut Topology) {
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
