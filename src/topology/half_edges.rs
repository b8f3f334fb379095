//! Half-edges and what is known at each.

use super::ring::{Place, Ring};
use crate::mesh::{ControlMesh, NO_TWIN, SHARPNESS_INFINITE};

/// Sharpness from which on the patch schemes draw an edge or vertex as infinitely sharp. Below, it is smooth.
///
/// A patch a face cannot follow a crease of finite sharpness; refining the mesh first brings the surface closer.
pub const SHARP_FROM: f32 = 1.0;

/// How the faces of a [`ControlMesh`] hang together.
///
/// The unit is the *half-edge* `h`, which is also the number of a face corner: it runs from `vertex(h)` to
/// `vertex(next(h))` and has its face on the left.
///
/// A *vertex* here is manifold: a vertex of the mesh where several fans of faces touch in a point is split into one
/// for each fan ([`Topology::source`] leads back), all of which are corners, as in OpenSubdiv. A [`Ring`] is a sector
/// of a vertex between sharp edges: around most vertices there is just one.
///
/// # Panics
/// Methods that take the number of a half-edge, a face or a vertex may panic if there is none with that number.
#[derive(Debug, Clone)]
pub struct Topology {
    pub(super) mesh: ControlMesh,
    /// Whether all faces are quads: half-edge h is then corner h % 4 of face h / 4.
    pub(super) quads: bool,
    /// The face of each half-edge; empty where all faces are quads.
    pub(super) faces: Vec<u32>,
    /// The manifold vertex of each half-edge; empty where nothing had to be split.
    pub(super) vertices: Vec<u32>,
    /// The mesh vertices of the manifold vertices beyond `mesh.vertex_count()`.
    pub(super) split_sources: Vec<u32>,
    /// The vertices of the mesh that were split, in ascending order.
    pub(super) touching: Vec<u32>,
    pub(super) rings: Vec<Ring>,
    /// The ring of each half-edge, and the index of the half-edge in it.
    pub(super) places: Vec<Place>,
}

impl Topology {
    /// The mesh this is the topology of.
    pub fn mesh(&self) -> &ControlMesh {
        &self.mesh
    }

    /// Manifold vertices: those of the mesh, then those that splitting added.
    pub fn vertex_count(&self) -> usize {
        self.mesh.vertex_count() + self.split_sources.len()
    }

    /// Vertices that splitting added.
    pub fn split_count(&self) -> usize {
        self.split_sources.len()
    }

    /// The vertex of the mesh that a manifold vertex stands for, whose position it has.
    pub fn source(&self, vertex: u32) -> u32 {
        let count = self.mesh.vertex_count() as u32;
        if vertex < count { vertex } else { self.split_sources[(vertex - count) as usize] }
    }

    /// The manifold vertex a half-edge starts from.
    pub fn vertex(&self, half_edge: u32) -> u32 {
        if self.vertices.is_empty() { self.mesh_vertex(half_edge) } else { self.vertices[half_edge as usize] }
    }

    /// The vertex of the mesh a half-edge starts from.
    pub fn mesh_vertex(&self, half_edge: u32) -> u32 {
        self.mesh.data().face_vertices[half_edge as usize]
    }

    /// The face on the left of a half-edge.
    pub fn face(&self, half_edge: u32) -> u32 {
        if self.quads {
            return half_edge / 4;
        }
        self.faces[half_edge as usize]
    }

    /// The number of corners of the face on the left of a half-edge.
    pub fn face_size(&self, half_edge: u32) -> u32 {
        if self.quads {
            return 4;
        }
        self.mesh.data().face_sizes[self.face(half_edge) as usize]
    }

    /// The next half-edge around the face, counter-clockwise.
    pub fn next(&self, half_edge: u32) -> u32 {
        if self.quads {
            return half_edge & !3 | (half_edge + 1) & 3;
        }
        let offsets = self.mesh.face_offsets();
        let face = self.face(half_edge) as usize;
        if half_edge + 1 == offsets[face + 1] { offsets[face] } else { half_edge + 1 }
    }

    /// The previous half-edge around the face.
    pub fn prev(&self, half_edge: u32) -> u32 {
        if self.quads {
            return half_edge & !3 | (half_edge + 3) & 3;
        }
        let offsets = self.mesh.face_offsets();
        let face = self.face(half_edge) as usize;
        if half_edge == offsets[face] { offsets[face + 1] - 1 } else { half_edge - 1 }
    }

    /// The half-edge on the other side, `None` on a boundary.
    pub fn twin(&self, half_edge: u32) -> Option<u32> {
        let twin = self.mesh.twins()[half_edge as usize];
        (twin != NO_TWIN).then_some(twin)
    }

    /// The sharpness of a half-edge's edge, as it was authored: see [`ControlMesh::sharpness`].
    pub fn sharpness(&self, half_edge: u32) -> f32 {
        self.mesh.sharpness(half_edge)
    }

    /// The sharpness of a vertex of the mesh: as it was authored, [`SHARPNESS_INFINITE`] where several fans of faces touch.
    pub fn vertex_sharpness(&self, vertex: u32) -> f32 {
        if self.touches(vertex) { SHARPNESS_INFINITE } else { self.mesh.vertex_sharpness(vertex) }
    }

    /// Whether several fans of faces touch in a vertex of the mesh.
    pub fn touches(&self, vertex: u32) -> bool {
        self.touching.binary_search(&vertex).is_ok()
    }

    /// Whether the patch schemes draw an edge sharp: a crease of [`SHARP_FROM`] or more. A boundary is not a crease.
    pub fn is_sharp(&self, half_edge: u32) -> bool {
        self.twin(half_edge).is_some() && self.sharpness(half_edge) >= SHARP_FROM
    }

    /// Whether the faces on both sides of an edge are neighbours in the one-rings of both its ends, as they are along smooth
    /// edges; at a dart the edge is sharp, and both faces are in one ring all the same. True for boundaries.
    pub fn is_within_rings(&self, half_edge: u32) -> bool {
        let ring = |h: u32| self.place(h).ring;
        self.twin(half_edge)
            .is_none_or(|twin| ring(half_edge) == ring(self.next(twin)) && ring(twin) == ring(self.next(half_edge)))
    }

    /// All one-rings.
    pub fn rings(&self) -> &[Ring] {
        &self.rings
    }

    /// Where a face corner stands in its ring.
    pub fn place(&self, half_edge: u32) -> Place {
        self.places[half_edge as usize]
    }

    /// The half-edges of a ring that start from its vertex, counter-clockwise, one a face.
    pub fn ring_half_edges(&self, ring: &Ring) -> impl Iterator<Item = u32> + '_ {
        let mut half_edge = ring.start;
        (0..ring.faces).map(move |i| {
            if i > 0 {
                // The builder walked this way, so the twin is there.
                half_edge = self.mesh.twins()[self.prev(half_edge) as usize];
            }
            half_edge
        })
    }

    /// The half-edges around the vertex from which one starts, counter-clockwise: whatever is sharp between them, from the boundary
    /// if there is one, and whether there is.
    pub(crate) fn fan(&self, half_edge: u32) -> (Vec<u32>, bool) {
        let mut fan = Vec::new();
        let open = self.walk(half_edge, &mut fan);
        (fan, open)
    }

    /// Puts the half-edges of [`Topology::fan`] in the place of what is in `fan`.
    pub(super) fn walk(&self, half_edge: u32, fan: &mut Vec<u32>) -> bool {
        fan.clear();
        let mut at = half_edge;
        loop {
            fan.push(at);
            match self.twin(self.prev(at)) {
                Some(next) if next == half_edge => return false,
                Some(next) => at = next,
                None => break,
            }
        }
        let ahead = fan.len();
        at = half_edge;
        while let Some(twin) = self.twin(at) {
            at = self.next(twin);
            fan.push(at);
        }
        fan[ahead..].reverse();
        fan.rotate_left(ahead);
        true
    }
}
