//! Vertices of a file in which each has one texture coordinate and one normal.

use crate::mesh::ControlMesh;
use std::collections::HashMap;

/// A vertex for each texture coordinate and normal that a vertex of the mesh has.
pub(super) struct Split {
    pub positions: Vec<[f64; 3]>,
    pub texcoords: Option<Vec<[f32; 2]>>,
    pub normals: Option<Vec<[f32; 3]>>,
    /// One a face corner.
    pub vertices: Vec<u32>,
}

impl Split {
    /// Vertices are numbered as faces reach them.
    pub(super) fn new(mesh: &ControlMesh) -> Self {
        let data = mesh.data();
        let mut split = Self {
            positions: Vec::new(),
            texcoords: data.texcoords.as_ref().map(|_| Vec::new()),
            normals: data.normals.as_ref().map(|_| Vec::new()),
            vertices: Vec::with_capacity(mesh.corner_count()),
        };
        let mut numbers: HashMap<(u32, [u32; 2], [u32; 3]), u32> = HashMap::new();
        for (corner, &vertex) in data.face_vertices.iter().enumerate() {
            let texcoord = data.texcoords.as_ref().map(|values| values.values[values.indices[corner] as usize]);
            let normal = data.normals.as_ref().map(|values| values.values[values.indices[corner] as usize]);
            let key =
                (vertex, texcoord.unwrap_or_default().map(f32::to_bits), normal.unwrap_or_default().map(f32::to_bits));
            let number = *numbers.entry(key).or_insert_with(|| {
                split.positions.push(data.positions[vertex as usize]);
                split.texcoords.iter_mut().for_each(|values| values.extend(texcoord));
                split.normals.iter_mut().for_each(|values| values.extend(normal));
                split.positions.len() as u32 - 1
            });
            split.vertices.push(number);
        }
        split
    }
}
