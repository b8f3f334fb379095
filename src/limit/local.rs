//! A face with the faces around it: all that the surface over the face depends on.

use crate::mesh::{Corner, Crease, CreaseMethod, MeshData};
use crate::topology::Topology;
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// The part of a mesh on which the surface over one face depends, as a mesh of its own.
///
/// The face is face 0. What the rules make of the rim of the part is not the surface's; none of it reaches face 0.
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
        let faces = neighbourhood(topology, face);
        let centre = mesh.position(mesh.face(face)[0]);
        let mut numbers = HashMap::new();
        let mut vertices = Vec::new();
        let mut data = MeshData {
            boundary: mesh.data().boundary,
            crease_method: mesh.data().crease_method,
            triangle_rule: mesh.data().triangle_rule,
            ..MeshData::default()
        };
        for &face in &faces {
            for &vertex in mesh.face(face) {
                let number = numbers.len() as u32;
                if *numbers.entry(vertex).or_insert(number) == number {
                    vertices.push(vertex);
                    data.positions.push((mesh.position(vertex) - centre).into());
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
        let size = data.face_sizes[0] as usize;
        data.face_vertices[..size].rotate_left(first);
        Self { origin: origin + centre, data, vertices }
    }
}

/// The face and all faces that share a vertex with it, as far as the rules look.
///
/// One ring of faces is enough to refine the face and one ring of faces around each of its children. Chaikin's
/// method looks further: whether an edge is sharp depends on the creases at its far end.
fn neighbourhood(topology: &Topology, face: u32) -> Vec<u32> {
    let mesh = topology.mesh();
    let rings = if mesh.data().crease_method == CreaseMethod::Chaikin { 2 } else { 1 };
    let mut faces = vec![face];
    let mut found: HashSet<u32> = [face].into();
    let mut done = 0;
    for _ in 0..rings {
        for inner in std::mem::replace(&mut done, faces.len())..faces.len() {
            for h in mesh.face_corners(faces[inner]) {
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
