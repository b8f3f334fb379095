//! One step of Catmull-Clark refinement of positions and tags: any face sizes, boundaries, semi-sharp creases and corners,
//! both crease methods and both triangle rules (patch_maths A).

use super::sharpness::{children, decrement, edge_weight, parent_weight};
use super::stencils::{MIN_LEN, Stencils};
use crate::blend::{Blend, Row};
use crate::mesh::{BoundaryRule, Corner, Crease, MeshData, SHARPNESS_INFINITE, TriangleRule};
use crate::topology::Topology;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxBuildHasher;
use std::collections::HashMap;

/// The refined mesh without what it has by face corner, and without holes; its positions as sums of the coarse mesh's.
pub(super) fn refine_vertices(topology: &Topology) -> (MeshData, Stencils) {
    let step = Step::new(topology);
    let stencils = Stencils::new(step.rows());
    let mesh = topology.mesh();
    let coarse: Vec<DVec3> = mesh.data().positions.iter().map(|&p| p.into()).collect();
    let corners = mesh.corner_count();
    let refined = MeshData {
        positions: stencils.apply(&coarse).into_iter().map(Into::into).collect(),
        face_sizes: vec![4; corners],
        face_vertices: (0..corners as u32).flat_map(|h| step.child(h)).collect(),
        creases: step.child_creases(),
        corners: step.child_corners(),
        ..child_rules(topology)
    };
    (refined, stencils)
}

/// Origin of a vertex of the refined mesh: a vertex, an edge or a face of the coarse one.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    Vertex,
    Edge(u32),
    Face(u32),
}

/// The rule at a vertex, by what is sharp there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rule {
    /// Nothing or one edge (a dart) is sharp.
    Smooth,
    /// Two edges are sharp: their half-edges' far vertices.
    Crease([u32; 2]),
    Corner,
}

/// An edge end that is sharp: seen from one vertex.
#[derive(Clone, Copy)]
struct SharpEnd {
    /// The vertex of the mesh at the other end.
    far: u32,
    sharpness: f32,
    /// Sharpness left in the child edge at this vertex.
    child: f32,
}

/// The rules of a refined mesh.
pub(super) fn child_rules(topology: &Topology) -> MeshData {
    let data = topology.mesh().data();
    MeshData {
        boundary: data.boundary,
        crease_method: data.crease_method,
        // After one step there are no triangles.
        triangle_rule: TriangleRule::CatmullClark,
        ..MeshData::default()
    }
}

pub(super) struct Step<'t> {
    pub(super) topology: &'t Topology,
    /// The edge of each half-edge.
    edges: Vec<u32>,
    /// A half-edge of each edge.
    edge_half_edges: Vec<u32>,
    /// The sharp edge ends, by manifold vertex, each with its edge.
    sharp_ends: Vec<(u32, SharpEnd)>,
    /// Where those of each manifold vertex start, and after the last vertex their number.
    sharp_starts: Vec<u32>,
    /// Sharpness of the manifold vertices.
    vertex_sharpness: Vec<f32>,
    /// Faces whose point rows take as an unknown of its own.
    pub(super) centres: HashMap<u32, u32, FxBuildHasher>,
}

impl<'t> Step<'t> {
    pub(super) fn new(topology: &'t Topology) -> Self {
        let corners = topology.mesh().corner_count() as u32;
        let mut edges = vec![0; corners as usize];
        let mut edge_half_edges = Vec::new();
        for h in 0..corners {
            edges[h as usize] = match topology.twin(h) {
                Some(twin) if twin < h => edges[twin as usize],
                _ => {
                    edge_half_edges.push(h);
                    edge_half_edges.len() as u32 - 1
                }
            };
        }
        let mut step = Self {
            topology,
            edges,
            edge_half_edges,
            sharp_ends: Vec::new(),
            sharp_starts: vec![0; topology.vertex_count() + 1],
            vertex_sharpness: vec![0.0; topology.vertex_count()],
            centres: HashMap::default(),
        };
        step.find_sharp_ends();
        step.find_sharp_vertices();
        step
    }

    /// Number of vertices of the refined mesh.
    pub(super) fn vertex_count(&self) -> usize {
        self.topology.vertex_count() + self.edge_half_edges.len() + self.topology.mesh().face_count()
    }

    /// The child of a face corner.
    pub(super) fn child(&self, h: u32) -> [u32; 4] {
        [self.topology.vertex(h), self.edge_vertex(h), self.face_vertex(h), self.edge_vertex(self.topology.prev(h))]
    }

    /// The row of a vertex of the child of a face corner.
    pub(super) fn row(&self, vertex: u32, h: u32) -> Row {
        match self.kind(vertex) {
            Kind::Vertex => self.vertex_row(h),
            Kind::Edge(edge) => self.edge_row(edge),
            Kind::Face(face) => self.mean_row(face),
        }
    }

    /// Origin of a vertex of the refined mesh.
    pub(super) fn kind(&self, vertex: u32) -> Kind {
        let first_edge = self.topology.vertex_count() as u32;
        let first_face = first_edge + self.edge_half_edges.len() as u32;
        match vertex {
            _ if vertex < first_edge => Kind::Vertex,
            _ if vertex < first_face => Kind::Edge(vertex - first_edge),
            _ => Kind::Face(vertex - first_face),
        }
    }

    /// Whether nothing at a manifold vertex is sharp.
    pub(super) fn is_smooth(&self, vertex: u32) -> bool {
        self.ends_at(vertex).is_empty() && self.vertex_sharpness[vertex as usize] == 0.0
    }

    /// A half-edge of an edge.
    pub(super) fn half_edge(&self, edge: u32) -> u32 {
        self.edge_half_edges[edge as usize]
    }

    /// Whether there are any.
    pub(super) fn has_sharp_edges(&self) -> bool {
        !self.sharp_ends.is_empty()
    }

    /// The creases along the two edges of a face corner's child that meet there, with the half-edges' places in the child.
    pub(super) fn creases_at(&self, h: u32) -> impl Iterator<Item = (usize, Crease)> {
        let vertex = self.topology.vertex(h);
        [(0, h), (3, self.topology.prev(h))].into_iter().filter_map(move |(corner, edge)| {
            // A boundary edge is sharp without a tag.
            let sharpness = self.child_sharpness(self.edges[edge as usize], vertex);
            let is_tag = sharpness > 0.0 && self.topology.twin(edge).is_some();
            is_tag.then_some((corner, Crease { vertices: [vertex, self.edge_vertex(edge)], sharpness }))
        })
    }

    pub(super) fn edge_vertex(&self, h: u32) -> u32 {
        self.topology.vertex_count() as u32 + self.edges[h as usize]
    }

    pub(super) fn face_vertex(&self, h: u32) -> u32 {
        (self.topology.vertex_count() + self.edge_half_edges.len()) as u32 + self.topology.face(h)
    }

    /// The manifold vertices at the two ends of an edge.
    fn ends(&self, edge: u32) -> [u32; 2] {
        let h = self.edge_half_edges[edge as usize];
        [self.topology.vertex(h), self.topology.vertex(self.topology.next(h))]
    }

    /// The sharp ends of edges at a manifold vertex.
    fn ends_at(&self, vertex: u32) -> &[(u32, SharpEnd)] {
        let vertex = vertex as usize;
        &self.sharp_ends[self.sharp_starts[vertex] as usize..self.sharp_starts[vertex + 1] as usize]
    }

    fn find_sharp_ends(&mut self) {
        let topology = self.topology;
        let mut found = Vec::new();
        for (edge, &h) in (0..).zip(&self.edge_half_edges) {
            let sharpness = topology.sharpness(h);
            if sharpness > 0.0 {
                let [a, b] = self.ends(edge);
                for (near, far) in [(a, b), (b, a)] {
                    found.push((near, (edge, SharpEnd { far: topology.source(far), sharpness, child: 0.0 })));
                    self.sharp_starts[near as usize + 1] += 1;
                }
            }
        }
        // Edges at a vertex keep their order.
        found.sort_by_key(|&(near, _)| near);
        for vertex in 1..self.sharp_starts.len() {
            self.sharp_starts[vertex] += self.sharp_starts[vertex - 1];
        }
        for ends in found.chunk_by_mut(|a, b| a.0 == b.0) {
            let sharpness: Vec<f32> = ends.iter().map(|(_, (_, end))| end.sharpness).collect();
            let children = children(topology.mesh().data().crease_method, &sharpness);
            ends.iter_mut().zip(children).for_each(|((_, (_, end)), child)| end.child = child);
        }
        self.sharp_ends = found.into_iter().map(|(_, end)| end).collect();
    }

    fn find_sharp_vertices(&mut self) {
        let topology = self.topology;
        let corners_are_sharp = topology.mesh().data().boundary == BoundaryRule::EdgeAndCorner;
        for h in 0..topology.mesh().corner_count() as u32 {
            let lone = topology.twin(h).is_none() && topology.twin(topology.prev(h)).is_none();
            let sharpness = match lone && corners_are_sharp {
                true => SHARPNESS_INFINITE,
                false => topology.vertex_sharpness(topology.mesh_vertex(h)),
            };
            if sharpness > 0.0 {
                self.vertex_sharpness[topology.vertex(h) as usize] = sharpness;
            }
        }
    }

    fn rows(&self) -> Vec<Row> {
        let topology = self.topology;
        let mut start = vec![u32::MAX; topology.vertex_count()];
        for h in 0..topology.mesh().corner_count() as u32 {
            let first = &mut start[topology.vertex(h) as usize];
            *first = (*first).min(h);
        }
        let vertices = start.into_par_iter().with_min_len(MIN_LEN).map(|h| self.vertex_row(h));
        let edges =
            (0..self.edge_half_edges.len() as u32).into_par_iter().with_min_len(MIN_LEN).map(|e| self.edge_row(e));
        let faces =
            (0..topology.mesh().face_count() as u32).into_par_iter().with_min_len(MIN_LEN).map(|f| self.mean_row(f));
        vertices.chain(edges).chain(faces).collect()
    }

    fn unit(&self, half_edge: u32) -> Row {
        Row::unit(self.topology.mesh_vertex(half_edge))
    }

    /// The face point, as other rows take it.
    fn face_row(&self, face: u32) -> Row {
        let centre = self.centres.get(&face);
        centre.map_or_else(|| self.mean_row(face), |&centre| Row::unit(centre))
    }

    fn mean_row(&self, face: u32) -> Row {
        let vertices = self.topology.mesh().face(face);
        let mut row = Row::default();
        for &vertex in vertices {
            row.add_scaled(1.0 / vertices.len() as f64, &Row::unit(vertex));
        }
        row
    }

    fn edge_row(&self, edge: u32) -> Row {
        let topology = self.topology;
        let h = self.edge_half_edges[edge as usize];
        let (from, to) = (self.unit(h), self.unit(topology.next(h)));
        let sharp = Row::sum([(0.5, &from), (0.5, &to)]);
        let Some(twin) = topology.twin(h) else { return sharp };
        let sharpness = topology.sharpness(h);
        let children = self.ends(edge).map(|vertex| self.child_sharpness(edge, vertex));
        let weight = f64::from(edge_weight(topology.mesh().data().crease_method, sharpness, children));
        if weight == 1.0 {
            return sharp;
        }
        let (left, right) = (self.face_row(topology.face(h)), self.face_row(topology.face(twin)));
        let face_weight = self.edge_face_weight(h, twin);
        let end_weight = 0.5 - face_weight;
        let smooth = [(end_weight, &from), (end_weight, &to), (face_weight, &left), (face_weight, &right)];
        let smooth = Row::sum(smooth);
        if weight == 0.0 { smooth } else { Row::sum([(weight, &sharp), (1.0 - weight, &smooth)]) }
    }

    /// The weight of each face point in a smooth edge point: 1/4, more next to triangles under OpenSubdiv's smooth
    /// triangle rule (0.47 stands for a triangle).
    fn edge_face_weight(&self, h: u32, twin: u32) -> f64 {
        if self.topology.mesh().data().triangle_rule == TriangleRule::CatmullClark {
            return 0.25;
        }
        let weight = |h: u32| if self.topology.face_size(h) == 3 { 0.470 } else { 0.25 };
        0.5 * (weight(h) + weight(twin))
    }

    fn child_sharpness(&self, edge: u32, vertex: u32) -> f32 {
        self.ends_at(vertex).iter().find(|(e, _)| *e == edge).map_or(0.0, |(_, end)| end.child)
    }

    fn vertex_row(&self, half_edge: u32) -> Row {
        let vertex = self.topology.vertex(half_edge);
        let ends = self.ends_at(vertex);
        let sharpness = self.vertex_sharpness[vertex as usize];
        let rule = |sharpness: f32, of: fn(&SharpEnd) -> f32| {
            let sharp: Vec<u32> = ends.iter().filter(|(_, e)| of(e) > 0.0).map(|(_, e)| e.far).collect();
            match *sharp {
                _ if sharpness > 0.0 => Rule::Corner,
                [] | [_] => Rule::Smooth,
                [a, b] => Rule::Crease([a, b]),
                _ => Rule::Corner,
            }
        };
        let parent = rule(sharpness, |e| e.sharpness);
        let child = rule(decrement(sharpness), |e| e.child);
        let row = self.masked(half_edge, parent);
        if parent == Rule::Smooth || std::mem::discriminant(&parent) == std::mem::discriminant(&child) {
            return row;
        }
        let edges: Vec<(f32, f32)> = ends.iter().map(|(_, e)| (e.sharpness, e.child)).collect();
        let weight = f64::from(parent_weight(self.topology.mesh().data().crease_method, &edges, sharpness));
        Row::sum([(weight, &row), (1.0 - weight, &self.masked(half_edge, child))])
    }

    fn masked(&self, half_edge: u32, rule: Rule) -> Row {
        let centre = self.unit(half_edge);
        match rule {
            Rule::Corner => centre,
            Rule::Crease([a, b]) => Row::sum([(0.75, &centre), (0.125, &Row::unit(a)), (0.125, &Row::unit(b))]),
            Rule::Smooth => {
                let topology = self.topology;
                let mut around = vec![half_edge];
                let mut at = half_edge;
                while let Some(next) = topology.twin(topology.prev(at)) {
                    if next == half_edge {
                        break;
                    }
                    around.push(next);
                    at = next;
                }
                let n = around.len() as f64;
                let mut row = Row::default();
                row.add_scaled((n - 2.0) / n, &centre);
                for h in around {
                    row.add_scaled(1.0 / (n * n), &self.unit(topology.next(h)));
                    row.add_scaled(1.0 / (n * n), &self.face_row(topology.face(h)));
                }
                row
            }
        }
    }

    fn child_creases(&self) -> Vec<Crease> {
        let mut creases = Vec::new();
        for (edge, &h) in self.edge_half_edges.iter().enumerate() {
            let edge = edge as u32;
            if self.topology.twin(h).is_none() || self.topology.sharpness(h) == 0.0 {
                continue;
            }
            for vertex in self.ends(edge) {
                let sharpness = self.child_sharpness(edge, vertex);
                if sharpness > 0.0 {
                    creases.push(Crease { vertices: [vertex, self.edge_vertex(h)], sharpness });
                }
            }
        }
        creases
    }

    pub(super) fn child_corners(&self) -> Vec<Corner> {
        // In the refined mesh touching fans are apart: from now on a tag keeps them together.
        let sharpness = |vertex| decrement(self.topology.vertex_sharpness(self.topology.source(vertex)));
        let vertices =
            (0..self.topology.vertex_count() as u32).map(|vertex| Corner { vertex, sharpness: sharpness(vertex) });
        vertices.filter(|corner| corner.sharpness > 0.0).collect()
    }
}
