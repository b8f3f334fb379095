//! How the neighbourhood of a vertex is refined, as weights of its one-ring: what a face that is subdivided on its own takes
//! from the faces around its corners.

use super::local::Local;
use super::refine::refine;
use super::sharpness::{LEVELS, children, is_semi_sharp};
use crate::blend::{Blend, Frame, RingValues, Row};
use crate::mesh::{ControlMesh, Corner, Crease, CreaseMethod, MeshData, MeshError, SHARPNESS_INFINITE};
use crate::topology::{RingKind, Topology};
use glam::DVec3;

/// All faces around a manifold vertex, whatever is sharp between them. Edges and faces count as in a
/// [`Ring`](crate::topology::Ring).
#[derive(Debug, Clone)]
pub(crate) struct Fan {
    /// One a face, from the vertex along edge i.
    pub half_edges: Vec<u32>,
    /// Whether the first and the last edge differ.
    pub open: bool,
    /// Sharpness of each edge; boundaries are infinitely sharp.
    pub sharpness: Vec<f32>,
    /// Sharpness of the vertex.
    pub vertex_sharpness: f32,
    method: CreaseMethod,
}

impl Fan {
    /// Number of edges.
    pub(crate) fn edges(&self) -> usize {
        self.half_edges.len() + usize::from(self.open)
    }

    /// The sharpness of each edge's piece at the vertex, at levels 1 to 3.
    pub(crate) fn evolution(&self) -> Vec<[f32; LEVELS]> {
        let mut evolution = vec![[0.0; LEVELS]; self.edges()];
        let mut sharpness = self.sharpness.clone();
        for level in 0..LEVELS {
            sharpness = children(self.method, &sharpness);
            evolution.iter_mut().zip(&sharpness).for_each(|(edge, &s)| edge[level] = s);
        }
        evolution
    }

    /// Whether all faces are alike, so that weights for one edge are those for every other when turned.
    pub(crate) fn is_rotational(&self) -> bool {
        !self.open && self.sharpness.iter().all(|&s| s == 0.0)
    }

    /// Whether the rules look at edges beyond the ring: Chaikin's, along what is semi-sharp.
    pub(crate) fn looks_further(&self) -> bool {
        self.method == CreaseMethod::Chaikin && self.sharpness.iter().any(|&s| is_semi_sharp(s))
    }
}

/// Points around a vertex as sums of its one-ring: unknown 0 is the vertex, then `a_0, d_0, a_1, d_1, ..`.
#[derive(Debug, Clone)]
pub(crate) struct FanRows {
    /// The vertex at levels 1 to 3.
    pub vertex: Vec<Row>,
    /// The next vertex along each edge, at levels 2 and 3.
    pub spokes: [Vec<Row>; 2],
    /// For levels 0 to 3, two tangents at the vertex, counter-clockwise: for each face, or once where they are the same for
    /// all.
    pub tangents: Vec<Vec<[Row; 2]>>,
}

/// The fans of a mesh of quads.
pub(crate) struct Fans<'t> {
    topology: &'t Topology,
}

impl<'t> Fans<'t> {
    pub(crate) fn new(topology: &'t Topology) -> Self {
        Self { topology }
    }

    /// The fan around the vertex from which a half-edge starts.
    pub(crate) fn around(&self, half_edge: u32) -> Fan {
        let topology = self.topology;
        let (half_edges, open) = topology.fan(half_edge);
        let end = open.then_some(SHARPNESS_INFINITE);
        let sharpness = half_edges.iter().map(|&h| topology.sharpness(h)).chain(end).collect();
        let vertex_sharpness = topology.vertex_sharpness(topology.mesh_vertex(half_edge));
        Fan { half_edges, open, sharpness, vertex_sharpness, method: topology.mesh().data().crease_method }
    }

    /// The weights of a fan. But for those that look further they depend on its number of faces, on whether it is open, and on
    /// what is sharp.
    pub(crate) fn rows(&self, fan: &Fan) -> Result<FanRows, MeshError> {
        if !fan.looks_further() {
            let topology = Topology::new(&ControlMesh::new(self.alone(fan))?);
            let rows = (0..topology.mesh().vertex_count() as u32).map(Row::unit).collect();
            return follow(topology, rows);
        }
        let start = fan.half_edges[0];
        let face = self.topology.face(start);
        let first = start as usize - self.topology.mesh().face_corners(face).start;
        let part = Local::cut(self.topology, face, first, DVec3::ZERO);
        let topology = Topology::new(&ControlMesh::new(part.data)?);
        let mut rows = vec![Row::default(); topology.mesh().vertex_count()];
        // A vertex that is there twice may be either.
        for (unknown, vertex) in ring_vertices(&topology).into_iter().enumerate() {
            rows[vertex as usize] = Row::unit(unknown as u32);
        }
        follow(topology, rows)
    }

    /// The fan as a mesh, in which it starts with half-edge 0.
    fn alone(&self, fan: &Fan) -> MeshData {
        let faces = fan.half_edges.len();
        let edge = |i: usize| 1 + 2 * (i % fan.edges()) as u32;
        let crease = |(i, &sharpness): (usize, &f32)| Crease { vertices: [0, edge(i)], sharpness };
        let inner = if fan.open { 1..faces } else { 0..faces };
        let creases = fan.sharpness.iter().enumerate().filter(|(i, s)| inner.contains(i) && **s > 0.0);
        let corner = Corner { vertex: 0, sharpness: fan.vertex_sharpness };
        MeshData {
            positions: vec![[0.0; 3]; 1 + faces + fan.edges()],
            face_sizes: vec![4; faces],
            face_vertices: (0..faces).flat_map(|i| [0, edge(i), 2 + 2 * i as u32, edge(i + 1)]).collect(),
            creases: creases.map(crease).collect(),
            corners: if fan.vertex_sharpness > 0.0 { vec![corner] } else { Vec::new() },
            boundary: self.topology.mesh().data().boundary,
            crease_method: fan.method,
            ..MeshData::default()
        }
    }
}

/// The vertex from which half-edge 0 starts, and those around it, in the order of the unknowns.
fn ring_vertices(topology: &Topology) -> Vec<u32> {
    let (half_edges, open) = topology.fan(0);
    let vertex = |h| topology.mesh_vertex(h);
    let mut vertices = vec![vertex(0)];
    for &h in &half_edges {
        let head = topology.next(h);
        vertices.extend([vertex(head), vertex(topology.next(head))]);
    }
    vertices.extend(half_edges.last().filter(|_| open).map(|&h| vertex(topology.prev(h))));
    vertices
}

/// Refines a mesh and follows the vertex from which half-edge 0 starts: in each refined mesh half-edge 0 starts from its child,
/// along the child of the same edge. `rows` are the vertices of the mesh.
fn follow(mut topology: Topology, mut rows: Vec<Row>) -> Result<FanRows, MeshError> {
    let mut of_fan = FanRows { vertex: Vec::new(), spokes: Default::default(), tangents: Vec::new() };
    for level in 0..=LEVELS {
        of_fan.tangents.push(tangents(&topology, &rows));
        if level > 0 {
            of_fan.vertex.push(rows[topology.mesh_vertex(0) as usize].clone());
        }
        if level > 1 {
            let edges = ring_vertices(&topology).into_iter().skip(1).step_by(2);
            of_fan.spokes[level - 2] = edges.map(|vertex| rows[vertex as usize].clone()).collect();
        }
        if level < LEVELS {
            let refined = refine(&topology)?;
            let mut next = vec![Row::default(); refined.mesh.vertex_count()];
            let fine = Topology::new(&refined.mesh);
            for vertex in ring_vertices(&fine) {
                let stencil = &refined.stencils;
                let terms = stencil.offsets[vertex as usize] as usize..stencil.offsets[vertex as usize + 1] as usize;
                let terms = stencil.weights[terms.clone()].iter().zip(&stencil.indices[terms]);
                next[vertex as usize] = Row::sum(terms.map(|(&weight, &index)| (weight, &rows[index as usize])));
            }
            (topology, rows) = (fine, next);
        }
    }
    Ok(of_fan)
}

/// Tangents at the vertex from which half-edge 0 starts, from each face, or one pair where they are the same from all.
fn tangents(topology: &Topology, rows: &[Row]) -> Vec<[Row; 2]> {
    let (half_edges, _) = topology.fan(0);
    let mut of_faces = Vec::with_capacity(half_edges.len());
    let mut last: Option<(u32, RingValues<Row>, Frame<Row>)> = None;
    for &h in &half_edges {
        let place = topology.place(h);
        let (_, values, frame) = match last.take() {
            Some(known) if known.0 == place.ring => last.insert(known),
            _ => {
                let ring = &topology.rings()[place.ring as usize];
                let values = RingValues::new(topology, ring, |v| rows[v as usize].clone());
                let frame = values.frame();
                last.insert((place.ring, values, frame))
            }
        };
        let edge = |j| values.edge_vector(frame, j);
        let j = place.index as usize;
        of_faces.push(match values.shape.kind {
            RingKind::Corner => [edge(j), edge(j + 1)],
            RingKind::Smooth | RingKind::Crease => [frame.a.clone(), frame.b.clone()],
        });
        if values.shape.kind != RingKind::Corner && values.shape.faces() == half_edges.len() {
            break;
        }
    }
    of_faces
}
