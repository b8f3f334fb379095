//! A face with the faces around it: all that the surface over the face depends on.

use crate::mesh::{ControlMesh, Corner, Crease, CreaseMethod, MeshData, NO_TWIN, SHARPNESS_INFINITE};
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// The sharpness of edges and vertices that have any.
pub(super) struct Tags {
    edges: HashMap<[u32; 2], f32>,
    vertices: HashMap<u32, f32>,
}

impl Tags {
    pub(super) fn new(data: &MeshData) -> Self {
        let key = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let mut tags = Self {
            edges: data.creases.iter().map(|c| (key(c.vertices), c.sharpness)).collect(),
            vertices: data.corners.iter().map(|c| (c.vertex, c.sharpness)).collect(),
        };
        tags.edges.retain(|_, sharpness| *sharpness > 0.0);
        tags.vertices.retain(|_, sharpness| *sharpness > 0.0);
        tags
    }

    /// Makes vertices infinitely sharp.
    pub(super) fn sharpen(&mut self, vertices: impl IntoIterator<Item = u32>) {
        self.vertices.extend(vertices.into_iter().map(|v| (v, SHARPNESS_INFINITE)));
    }

    pub(super) fn has_edges(&self) -> bool {
        !self.edges.is_empty()
    }

    pub(super) fn vertex(&self, vertex: u32) -> Option<f32> {
        self.vertices.get(&vertex).copied()
    }

    pub(super) fn edge(&self, a: u32, b: u32) -> Option<f32> {
        self.edges.get(&[a.min(b), a.max(b)]).copied()
    }
}

/// The part of a mesh on which the surface over one face depends, as a mesh of its own.
///
/// The face is face 0. What the rules make of the rim of the part is not the surface's; none of it reaches face 0.
pub(super) struct Local {
    /// To be added to the positions. They are relative to a vertex of the face, so that they keep their precision
    /// however small the face has become.
    pub(super) origin: DVec3,
    pub(super) data: MeshData,
}

impl Local {
    /// Cuts out `face` with its neighbourhood. Its corner `first` becomes corner 0.
    pub(super) fn cut(mesh: &ControlMesh, tags: &Tags, face: u32, first: usize, origin: DVec3) -> Self {
        let faces = neighbourhood(mesh, face);
        let centre = mesh.position(mesh.face(face)[0]);
        let mut numbers = HashMap::new();
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
                    data.positions.push((mesh.position(vertex) - centre).into());
                    let sharpness = tags.vertex(vertex);
                    data.corners.extend(sharpness.map(|sharpness| Corner { vertex: number, sharpness }));
                }
                data.face_vertices.push(numbers[&vertex]);
            }
            data.face_sizes.push(mesh.face(face).len() as u32);
        }
        if tags.has_edges() {
            for h in faces.iter().flat_map(|&face| mesh.face_corners(face)) {
                // Each edge inside the part once. A boundary edge is sharp without a tag.
                let twin = mesh.twins()[h];
                if twin == NO_TWIN || (twin as usize) < h {
                    continue;
                }
                let ends = [mesh.data().face_vertices[h], mesh.data().face_vertices[next(mesh, h as u32) as usize]];
                let sharpness = tags.edge(ends[0], ends[1]);
                let vertices = ends.map(|v| numbers[&v]);
                data.creases.extend(sharpness.map(|sharpness| Crease { vertices, sharpness }));
            }
        }
        let size = data.face_sizes[0] as usize;
        data.face_vertices[..size].rotate_left(first);
        Self { origin: origin + centre, data }
    }
}

/// The face and all faces that share a vertex with it, as far as the rules look.
///
/// One ring of faces is enough to refine the face and one ring of faces around each of its children. Chaikin's
/// method looks further: whether an edge is sharp depends on the creases at its far end.
fn neighbourhood(mesh: &ControlMesh, face: u32) -> Vec<u32> {
    let rings = if mesh.data().crease_method == CreaseMethod::Chaikin { 2 } else { 1 };
    let mut faces = vec![face];
    let mut found: HashSet<u32> = [face].into();
    let mut done = 0;
    for _ in 0..rings {
        for inner in std::mem::replace(&mut done, faces.len())..faces.len() {
            for h in mesh.face_corners(faces[inner]) {
                for_each_face_of_fan(mesh, h as u32, |face| {
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
fn for_each_face_of_fan(mesh: &ControlMesh, half_edge: u32, mut visit: impl FnMut(u32)) {
    let twins = mesh.twins();
    let mut h = half_edge;
    loop {
        h = twins[prev(mesh, h) as usize];
        if h == half_edge {
            return;
        }
        if h == NO_TWIN {
            break;
        }
        visit(face_of(mesh, h));
    }
    // A boundary: the rest is on its other side.
    h = half_edge;
    while twins[h as usize] != NO_TWIN {
        h = next(mesh, twins[h as usize]);
        visit(face_of(mesh, h));
    }
}

fn face_of(mesh: &ControlMesh, half_edge: u32) -> u32 {
    mesh.face_offsets().partition_point(|&offset| offset <= half_edge) as u32 - 1
}

fn next(mesh: &ControlMesh, half_edge: u32) -> u32 {
    let corners = mesh.face_corners(face_of(mesh, half_edge));
    if half_edge as usize + 1 == corners.end { corners.start as u32 } else { half_edge + 1 }
}

fn prev(mesh: &ControlMesh, half_edge: u32) -> u32 {
    let corners = mesh.face_corners(face_of(mesh, half_edge));
    if half_edge as usize == corners.start { corners.end as u32 - 1 } else { half_edge - 1 }
}
