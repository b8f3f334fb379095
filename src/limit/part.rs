//! One step of refinement of a part of a mesh.

use super::stencils::{MIN_LEN, Stencils};
use super::step::{Kind, Step, child_rules};
use crate::mesh::{Corner, Crease, MeshData};
use crate::topology::Topology;
use rayon::prelude::*;
use rustc_hash::FxBuildHasher;
use std::collections::HashMap;

/// The children of some face corners: [`refine_part`].
pub(crate) struct Part {
    /// A mesh of its own, whose face i is the child of the i-th corner, begins there, and has the parent's order of corners.
    /// Positions are left at zero.
    pub data: MeshData,
    /// Its vertices as sums of the coarse mesh's vertices and, numbered after these, of its own first vertices, the centres.
    pub rows: Stencils,
    /// The faces of five and more corners whose points are the first vertices.
    pub centres: Vec<u32>,
}

/// Refines what is around some face corners. Faces of many corners take part through their points, which are vertices
/// already: so rows stay short.
///
/// At the rim of the part tags may be missing, and rows are right as far as the coarse mesh is.
pub(crate) fn refine_part(topology: &Topology, half_edges: &[u32]) -> Part {
    let mut step = Step::new(topology);
    let mut numbers = vec![u32::MAX; step.vertex_count()];
    // Each vertex in the numbering of the whole refined mesh, and a corner that has a child with it.
    let mut vertices = Vec::with_capacity(half_edges.len());
    let mut see = |vertex: u32, h: u32| {
        let number = &mut numbers[vertex as usize];
        if *number == u32::MAX {
            *number = vertices.len() as u32;
            vertices.push((vertex, h));
        }
        *number
    };
    let mut centres = Vec::new();
    for &h in half_edges.iter().filter(|&&h| topology.face_size(h) > 4) {
        if see(step.face_vertex(h), h) as usize == centres.len() {
            centres.push(topology.face(h));
        }
    }
    let face_vertices = half_edges.iter().flat_map(|&h| step.child(h).map(|vertex| see(vertex, h))).collect();
    step.centres = centres.iter().copied().zip(topology.mesh().vertex_count() as u32..).collect();
    let step = step;
    let number = |vertex: u32| numbers[vertex as usize];
    let creases = half_edges.iter().flat_map(|&h| step.creases_at(h));
    let creases = creases.map(|crease| Crease { vertices: crease.vertices.map(number), ..crease }).collect();
    let corners = step.child_corners().into_iter().filter(|corner| number(corner.vertex) != u32::MAX);
    let corners = corners.map(|corner| Corner { vertex: number(corner.vertex), ..corner }).collect();
    let data = MeshData {
        positions: vec![[0.0; 3]; vertices.len()],
        face_sizes: vec![4; half_edges.len()],
        face_vertices,
        creases,
        corners,
        ..child_rules(topology)
    };
    let parts = vertices.par_chunks(4 * MIN_LEN).map(|vertices| PartRows::new(&step).rows(vertices));
    let rows = parts.collect::<Vec<_>>().into_iter().fold(Stencils::default(), Stencils::chain);
    Part { data, rows, centres }
}

/// Makes rows. Among quads, where nothing is sharp, weights are those of the first vertex of the kind.
struct PartRows<'s> {
    step: &'s Step<'s>,
    /// The weights of the points around, by kind and number of points.
    masks: HashMap<(u8, usize), Vec<f64>, FxBuildHasher>,
    around: Vec<u32>,
}

impl<'s> PartRows<'s> {
    fn new(step: &'s Step<'s>) -> Self {
        Self { step, masks: HashMap::default(), around: Vec::new() }
    }

    fn rows(mut self, vertices: &[(u32, u32)]) -> Stencils {
        let mut rows = Stencils::with_capacity(vertices.len(), 8 * vertices.len());
        for &(vertex, h) in vertices {
            let Some(kind) = self.look_around(vertex, h).filter(|_| self.is_distinct()) else {
                rows.push(self.step.row(vertex, h).weights().iter().copied());
                continue;
            };
            let Self { step, masks, around } = &mut self;
            let mask = masks.entry((kind, around.len())).or_insert_with(|| {
                let row = step.row(vertex, h);
                around.iter().map(|&vertex| row.weight(vertex)).collect()
            });
            rows.push(around.iter().copied().zip(mask.iter().copied()));
        }
        rows
    }

    /// Whether no vertex is there twice, as some are beside vertices with two faces; of many this is not asked.
    fn is_distinct(&self) -> bool {
        let around = &self.around;
        around.len() <= 64 && (1..around.len()).all(|i| !around[..i].contains(&around[i]))
    }

    /// Puts the vertices that a row depends on into `around`, in an order that is the same for all vertices of a kind. `None`
    /// if the weights need not be the same.
    fn look_around(&mut self, vertex: u32, h: u32) -> Option<u8> {
        let topology = self.step.topology;
        let at = |h: u32| topology.mesh_vertex(h);
        self.around.clear();
        match self.step.kind(vertex) {
            Kind::Vertex => {
                if !self.step.is_smooth(vertex) {
                    return None;
                }
                self.around.push(at(h));
                let mut spoke = h;
                loop {
                    let head = topology.next(spoke);
                    self.around.extend([at(head), at(topology.next(head))]);
                    let is_quad = topology.face_size(spoke) == 4;
                    spoke = topology.twin(topology.prev(spoke)).filter(|_| is_quad)?;
                    if spoke == h {
                        return Some(0);
                    }
                }
            }
            Kind::Edge(edge) => {
                let h = self.step.half_edge(edge);
                let twin = topology.twin(h)?;
                if topology.sharpness(h) > 0.0 || topology.face_size(h) != 4 || topology.face_size(twin) != 4 {
                    return None;
                }
                for h in [h, twin] {
                    let head = topology.next(topology.next(h));
                    self.around.extend([at(h), at(head), at(topology.next(head))]);
                }
                Some(1)
            }
            Kind::Face(face) => {
                let vertices = topology.mesh().face(face);
                self.around.extend_from_slice(vertices);
                (vertices.len() == 4).then_some(2)
            }
        }
    }
}
