//! Meshes without the vertices that belong to no face.

use super::Polygons;

/// Rest of a mesh without some vertices.
#[derive(Debug)]
pub struct Kept {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    texcoords: Option<Vec<[f32; 2]>>,
    copies: (u32, Vec<u32>),
    quads: Vec<[u32; 4]>,
    triangles: Vec<[u32; 3]>,
}

impl Kept {
    /// Leaves out vertices, given in order, that no face names and of which no copy is kept. `None` if there are none.
    pub fn of(mesh: &Polygons, unused: &[u32]) -> Option<Self> {
        let number = |vertex: u32| vertex - unused.partition_point(|&other| other < vertex) as u32;
        let is_kept = |vertex: u32| unused.binary_search(&vertex).is_err();
        let (first, sources) = mesh.copies;
        let copies = (first..).zip(sources).filter(|(copy, _)| is_kept(*copy));
        (!unused.is_empty()).then(|| Self {
            positions: kept(mesh.positions, is_kept),
            normals: kept(mesh.normals, is_kept),
            texcoords: mesh.texcoords.map(|texcoords| kept(texcoords, is_kept)),
            copies: (number(first), copies.map(|(_, &source)| number(source)).collect()),
            quads: mesh.quads.iter().map(|quad| quad.map(number)).collect(),
            triangles: mesh.triangles.iter().map(|triangle| triangle.map(number)).collect(),
        })
    }

    /// To be written.
    pub fn polygons(&self) -> Polygons<'_> {
        Polygons {
            positions: &self.positions,
            normals: &self.normals,
            texcoords: self.texcoords.as_deref(),
            copies: (self.copies.0, &self.copies.1),
            quads: &self.quads,
            triangles: &self.triangles,
        }
    }
}

fn kept<V: Copy>(values: &[V], is_kept: impl Fn(u32) -> bool) -> Vec<V> {
    (0..).zip(values).filter(|(vertex, _)| is_kept(*vertex)).map(|(_, &value)| value).collect()
}
