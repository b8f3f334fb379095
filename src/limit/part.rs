//! One step of refinement of a part of a mesh.

use super::masked::MaskedRows;
use super::stencils::MIN_LEN;
use super::step::{Kind, Step, child_rules};
use crate::mesh::{ControlMesh, Corner, Crease, MeshData, MeshError, NO_TWIN};
use crate::topology::Topology;
use rayon::prelude::*;

/// Vertices around one whose weights are looked up at most.
const MANY: usize = 64;

/// The children of some face corners: [`refine_part`].
pub(crate) struct Part {
    /// A mesh of its own, whose face i is the child of the i-th corner, begins there, and has the parent's order of corners.
    /// Positions are left at zero.
    pub mesh: ControlMesh,
    /// Its vertices as sums of the coarse mesh's vertices and, numbered after these, of its own first vertices, the centres. In
    /// pieces, one after the other.
    pub rows: Vec<MaskedRows>,
    /// The faces whose points are the first vertices.
    pub centres: Vec<u32>,
}

/// Refines what is around some face corners. Faces with a centre, as those of many corners should have, take part through their
/// points, which are vertices already: so rows stay short. Rows have `number(v)` in the place of vertex v.
///
/// At the rim of the part tags may be missing, and rows are right as far as the coarse mesh is.
///
/// # Errors
/// [`MeshError::TooLarge`].
pub(crate) fn refine_part(
    topology: &Topology,
    half_edges: &[u32],
    has_centre: impl Fn(u32) -> bool,
    number: impl Fn(u32) -> u32 + Sync,
) -> Result<Part, MeshError> {
    let mut step = Step::new(topology);
    let mut numbers = vec![u32::MAX; step.vertex_count()];
    // Each vertex in the numbering of the whole refined mesh, and a corner that has a child with it.
    let mut vertices = Vec::with_capacity(2 * half_edges.len());
    let mut see = |vertex: u32, h: u32| {
        let number = &mut numbers[vertex as usize];
        if *number == u32::MAX {
            *number = vertices.len() as u32;
            vertices.push((vertex, h));
        }
        *number
    };
    let mut centres = Vec::new();
    for &h in half_edges.iter().filter(|&&h| has_centre(topology.face(h))) {
        if see(step.face_vertex(h), h) as usize == centres.len() {
            centres.push(topology.face(h));
        }
    }
    let mut face_vertices = Vec::with_capacity(4 * half_edges.len());
    half_edges.iter().for_each(|&h| face_vertices.extend(step.child(h).map(|vertex| see(vertex, h))));
    step.centres = centres.iter().copied().zip(topology.mesh().vertex_count() as u32..).collect();
    let step = step;
    let data = MeshData { positions: vec![[0.0; 3]; vertices.len()], face_vertices, ..child_rules(topology) };
    let mesh = part_mesh(&step, half_edges, data, |vertex| numbers[vertex as usize])?;
    let rows = vertices.par_chunks(4 * MIN_LEN).map(|vertices| {
        let mut rows = PartRows::new(&step).rows(vertices);
        rows.indices.iter_mut().for_each(|vertex| *vertex = number(*vertex));
        rows
    });
    Ok(Part { mesh, rows: rows.collect(), centres })
}

/// The mesh of a part, which needs no search for what its parent knows. `number` tells the vertices of the whole refined mesh
/// in the part's own numbers.
fn part_mesh(
    step: &Step,
    half_edges: &[u32],
    mut data: MeshData,
    number: impl Fn(u32) -> u32,
) -> Result<ControlMesh, MeshError> {
    let topology = step.topology;
    let mut children = vec![NO_TWIN; topology.mesh().corner_count()];
    half_edges.iter().zip(0..).for_each(|(&h, child)| children[h as usize] = child);
    let at = |h: Option<u32>, corner: u32| match h.map_or(NO_TWIN, |h| children[h as usize]) {
        NO_TWIN => NO_TWIN,
        child => 4 * child + corner,
    };
    // What lies beyond each edge of a child: next to the vertex the children of the faces across, inside the face its others.
    let beyond = |&h: &u32| {
        let (next, prev) = (topology.next(h), topology.prev(h));
        let across = topology.twin(h).map(|twin| topology.next(twin));
        [at(across, 3), at(Some(next), 2), at(Some(prev), 1), at(topology.twin(prev), 0)]
    };
    let twins: Vec<[u32; 4]> = half_edges.par_iter().with_min_len(MIN_LEN).map(beyond).collect();

    let mut sharpness = Vec::new();
    for (child, &h) in half_edges.iter().enumerate().filter(|_| step.has_sharp_edges()) {
        for (corner, crease) in step.creases_at(h) {
            sharpness.resize(4 * half_edges.len(), 0.0);
            sharpness[4 * child + corner] = crease.sharpness;
            data.creases.push(Crease { vertices: crease.vertices.map(&number), ..crease });
        }
    }
    let corners = step.child_corners().into_iter().filter(|corner| number(corner.vertex) != u32::MAX);
    data.corners = corners.map(|corner| Corner { vertex: number(corner.vertex), ..corner }).collect();
    ControlMesh::of_quads(data, twins.into_flattened(), sharpness)
}

/// Makes rows. Among quads, where nothing is sharp, weights are those of the first vertex of the kind.
struct PartRows<'s> {
    step: &'s Step<'s>,
    /// The mask of the points around, by kind and number of points.
    masks: [[Option<u32>; MANY + 1]; 3],
    around: Vec<u32>,
}

impl<'s> PartRows<'s> {
    fn new(step: &'s Step<'s>) -> Self {
        Self { step, masks: [[None; MANY + 1]; 3], around: Vec::new() }
    }

    fn rows(mut self, vertices: &[(u32, u32)]) -> MaskedRows {
        let mut rows = MaskedRows::default();
        for &(vertex, h) in vertices {
            let Some(kind) = self.look_around(vertex, h).filter(|_| self.is_distinct()) else {
                rows.push_row(&self.step.row(vertex, h));
                continue;
            };
            let Self { step, masks, around } = &mut self;
            let mask = *masks[kind][around.len()].get_or_insert_with(|| {
                let row = step.row(vertex, h);
                rows.weights.number(around.iter().map(|&vertex| row.weight(vertex)))
            });
            rows.push(around.iter().copied(), mask);
        }
        rows
    }

    /// Whether no vertex is there twice, as some are beside vertices with two faces; of many this is not asked.
    fn is_distinct(&self) -> bool {
        let around = &self.around;
        around.len() <= MANY && (1..around.len()).all(|i| !around[..i].contains(&around[i]))
    }

    /// Puts the vertices that a row depends on into `around`, in an order that is the same for all vertices of a kind. `None`
    /// if the weights need not be the same.
    fn look_around(&mut self, vertex: u32, h: u32) -> Option<usize> {
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
