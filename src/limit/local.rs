//! A face with the faces around it: all that the surface over the face depends on.

use crate::mesh::{Corner, Crease, CreaseMethod, MeshData};
use crate::topology::Topology;
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// The part of a mesh on which the surface over one face depends, as a mesh of its own.
///
/// The face is face 0. What the rules make of the rim of the part is not the surface's; none of it reaches face 0.
#[derive(Debug, Clone)]
pub(crate) struct Local {
    /// To be added to the positions. They are relative to a vertex of the face, so that they keep their precision
    /// however small the face has become.
    pub(crate) origin: DVec3,
    pub(crate) data: MeshData,
    /// The vertices of the whole mesh, by the number that they have in the part.
    pub(crate) vertices: Vec<u32>,
}

impl Local {
    /// Cuts out `face` with its neighbourhood. Its corner `first` becomes corner 0.
    pub(crate) fn cut(topology: &Topology, face: u32, first: usize, origin: DVec3) -> Self {
        let mesh = topology.mesh();
        let centre = mesh.position(mesh.face(face)[0]);
        let mut local = Self::of_faces(topology, &neighbourhood(topology, face), centre);
        let size = local.data.face_sizes[0] as usize;
        local.data.face_vertices[..size].rotate_left(first);
        local.origin += origin;
        local
    }

    /// Cuts out some faces, which are numbered in this order. Positions are relative to `origin`.
    pub(crate) fn of_faces(topology: &Topology, faces: &[u32], origin: DVec3) -> Self {
        let mesh = topology.mesh();
        let mut numbers = HashMap::new();
        let mut vertices = Vec::new();
        let mut data = MeshData {
            boundary: mesh.data().boundary,
            crease_method: mesh.data().crease_method,
            triangle_rule: mesh.data().triangle_rule,
            ..MeshData::default()
        };
        for &face in faces {
            for &vertex in mesh.face(face) {
                let number = numbers.len() as u32;
                if *numbers.entry(vertex).or_insert(number) == number {
                    vertices.push(vertex);
                    data.positions.push((mesh.position(vertex) - origin).into());
                    let sharpness = topology.vertex_sharpness(vertex);
                    data.corners.extend((sharpness > 0.0).then_some(Corner { vertex: number, sharpness }));
                }
                data.face_vertices.push(numbers[&vertex]);
            }
            data.face_sizes.push(mesh.face(face).len() as u32);
        }
        for h in faces.iter().flat_map(|&face| mesh.face_corners(face)).map(|h| h as u32) {
            // Each edge inside the part once. A boundary edge is sharp without a tag.
            let sharpness = topology.sharpness(h);
            if sharpness > 0.0 && topology.twin(h).is_some_and(|twin| h < twin) {
                let vertices = [h, topology.next(h)].map(|h| numbers[&topology.mesh_vertex(h)]);
                data.creases.push(Crease { vertices, sharpness });
            }
        }
        Self { origin, data, vertices }
    }
}

/// The face and all faces that share a vertex with it, as far as the rules look.
///
/// One ring of faces is enough to refine the face and one ring of faces around each of its children. Chaikin's
/// method looks further: whether an edge is sharp depends on the creases at its far end.
fn neighbourhood(topology: &Topology, face: u32) -> Vec<u32> {
    let rings = if topology.mesh().data().crease_method == CreaseMethod::Chaikin { 2 } else { 1 };
    with_rings(topology, vec![face], rings)
}

/// Faces, each once, with `rings` rings of faces around them.
pub(crate) fn with_rings(topology: &Topology, mut faces: Vec<u32>, rings: usize) -> Vec<u32> {
    let mut found: HashSet<u32> = faces.iter().copied().collect();
    let mut done = 0;
    for _ in 0..rings {
        for inner in std::mem::replace(&mut done, faces.len())..faces.len() {
            for h in topology.mesh().face_corners(faces[inner]) {
                for_each_face_of_fan(topology, h as u32, |face| {
                    if found.insert(face) {
                        faces.push(face);
                    }
                });
            }
        }
    }
    faces
}

/// Walks around the vertex a half-edge starts from; where several fans touch there, around the half-edge's own.
fn for_each_face_of_fan(topology: &Topology, half_edge: u32, mut visit: impl FnMut(u32)) {
    let mut h = half_edge;
    while let Some(twin) = topology.twin(topology.prev(h)) {
        if twin == half_edge {
            return;
        }
        visit(topology.face(twin));
        h = twin;
    }
    // A boundary: the rest is on its other side.
    h = half_edge;
    while let Some(twin) = topology.twin(h) {
        h = topology.next(twin);
        visit(topology.face(h));
    }
}
