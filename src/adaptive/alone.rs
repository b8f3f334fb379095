//! Limit positions at vertices that no mask covers: of finite sharpness, and darts.

use super::caps::Around;
use super::feature::has_finite_sharpness;
use crate::blend::{Blend, RingValues, Row};
use crate::limit::{dart_edge, dart_frame, refine_part};
use crate::mesh::{ControlMesh, Corner, Crease, MeshData, MeshError};
use crate::topology::Topology;
use std::collections::HashMap;

/// The faces around a vertex as a mesh of their own, in which each begins there: all that the vertex's limit depends on, by
/// the uniform method.
#[derive(PartialEq, Eq, Hash)]
pub(super) struct Alone {
    face_sizes: Vec<u32>,
    face_vertices: Vec<u32>,
    /// The bits of the sharpness of the vertex, and of each edge from it that has faces on both sides, with its other end.
    vertex_sharpness: u32,
    edges: Vec<(u32, u32)>,
}

impl Alone {
    /// What is around the vertex from which a half-edge starts, and its vertices' numbers.
    pub(super) fn new(around: &Around, h: u32) -> (Self, Vec<u32>) {
        let topology = around.topology;
        let fan = topology.fan(h).0;
        let (mut numbers, mut vertices) = (HashMap::new(), Vec::new());
        let face_sizes: Vec<u32> = fan.iter().map(|&spoke| topology.face_size(spoke)).collect();
        let mut face_vertices = Vec::new();
        for (&spoke, &size) in fan.iter().zip(&face_sizes) {
            for h in std::iter::successors(Some(spoke), |&h| Some(topology.next(h))).take(size as usize) {
                let vertex = topology.mesh_vertex(h);
                face_vertices.push(*numbers.entry(vertex).or_insert_with(|| {
                    vertices.push(around.first_vertex + vertex);
                    vertices.len() as u32 - 1
                }));
            }
        }
        let inner = fan.iter().filter(|&&spoke| topology.twin(spoke).is_some());
        let edge = |&h: &u32| (numbers[&topology.mesh_vertex(topology.next(h))], topology.sharpness(h).to_bits());
        let vertex_sharpness = topology.vertex_sharpness(topology.mesh_vertex(h)).to_bits();
        (Self { face_sizes, face_vertices, vertex_sharpness, edges: inner.map(edge).collect() }, vertices)
    }

    /// The limit as a sum of the vertices here: refined until nothing at the vertex is of finite sharpness, masks tell it.
    pub(super) fn limit(&self, topology: &Topology) -> Result<Row, MeshError> {
        let crease = |&(end, bits): &(u32, u32)| Crease { vertices: [0, end], sharpness: f32::from_bits(bits) };
        let count = self.face_vertices.iter().max().map_or(0, |&last| last + 1);
        let data = MeshData {
            positions: vec![[0.0; 3]; count as usize],
            face_sizes: self.face_sizes.clone(),
            face_vertices: self.face_vertices.clone(),
            creases: self.edges.iter().map(crease).collect(),
            corners: vec![Corner { vertex: 0, sharpness: f32::from_bits(self.vertex_sharpness) }],
            boundary: topology.mesh().data().boundary,
            triangle_rule: topology.mesh().data().triangle_rule,
            ..MeshData::default()
        };
        let mut rows: Vec<Row> = (0..count).map(Row::unit).collect();
        let mut mesh = ControlMesh::new(data)?;
        let mut steps = 0;
        loop {
            let topology = Topology::new(&mesh);
            if steps > 0 && !has_finite_sharpness(&topology, 0) {
                let ring = &topology.rings()[topology.place(0).ring as usize];
                let values = RingValues::new(&topology, ring, |v| rows[v as usize].clone());
                let dart = dart_edge(&topology, ring);
                return Ok(dart.map_or_else(|| values.frame(), |sharp| dart_frame(&values, sharp)).p);
            }
            let face_starts = mesh.face_offsets()[..mesh.face_count()].to_vec();
            let part = refine_part(&topology, &face_starts, |face| mesh.face(face).len() > 4, |vertex| vertex)?;
            let coarse = std::mem::take(&mut rows);
            for (piece, row) in part.rows.iter().flat_map(|piece| (0..piece.len()).map(move |row| (piece, row))) {
                // Centres, numbered after the coarse vertices, come first.
                let value =
                    |vertex: u32| coarse.get(vertex as usize).unwrap_or_else(|| &rows[vertex as usize - coarse.len()]);
                rows.push(Row::sum(piece.row(row).map(|(vertex, weight)| (weight, value(vertex)))));
            }
            mesh = part.mesh;
            steps += 1;
        }
    }
}
