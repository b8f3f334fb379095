//! Patches by leaves: the mesh whose faces are the leaves of a plan of adaptive subdivision, or parts of them.

use super::wedges::{CutFace, Part, mean};
use crate::adaptive::{Leaf, Plan, Root};
use crate::constants::APEX_IS_CENTRE;
use crate::mesh::{BoundaryRule, ControlMesh, Crease, FaceVarying, MeshData, MeshError, SHARPNESS_INFINITE};
use crate::topology::Topology;
use rustc_hash::FxBuildHasher;
use std::collections::HashMap;
use std::sync::Arc;

/// Parts of the side of a root, of the finest level.
pub(super) const SIDE: u32 = crate::constants::PIECE_PARTS;
const _: () = assert!(SIDE == 1 << crate::constants::MAX_DEPTH);

/// A triangle of a leaf beside finer ones, between a part of the leaf's boundary, which is an edge of one patch beyond it, and an apex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct LeafPart {
    /// The leaf's edge on which the part lies.
    pub edge: u32,
    /// The ends of the part on that edge, in the order around the leaf, in parts of [`SIDE`].
    pub ends: [u32; 2],
    /// The leaf's edge whose middle is the apex, or [`APEX_IS_CENTRE`].
    pub apex: u32,
}

/// A point on the control mesh, by the element in whose inside it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Place {
    Vertex(u32),
    /// On an edge, in parts of `2 * SIDE` from the start of its lower half-edge.
    Edge(u32, u32),
    /// Between the middle of a half-edge's edge and the centre of its face, in parts of [`SIDE`].
    Spoke(u32, u32),
    /// The centre of a face other than a quad.
    Centre(u32),
    /// In a root, at (u, v).
    Root(u32, [u32; 2]),
}

/// A line of the control mesh on which edges of leaves lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Line {
    /// A half-edge's edge; from and to, in parts of `2 * SIDE`, where the half-edge starts being 0.
    Edge(u32, [u32; 2]),
    /// Within a face.
    Inner,
}

/// A mesh cut by leaves.
pub(super) struct Pieces {
    pub topology: Arc<Topology>,
    /// What each face is of the mesh before.
    pub faces: Vec<CutFace>,
    /// What each half-edge lies on.
    pub lines: Vec<Line>,
}

/// Where leaves are.
struct Places<'t> {
    topology: &'t Topology,
    plan: &'t Plan,
    numbers: HashMap<Place, u32, FxBuildHasher>,
    positions: Vec<[f64; 3]>,
}

impl Places<'_> {
    /// The half-edge from which a root starts.
    fn half_edge(&self, root: Root) -> u32 {
        self.topology.mesh().face_corners(root.face).start as u32 + root.part
    }

    /// A point of an edge; `t` counts from the start of a half-edge.
    fn on_edge(&self, half_edge: u32, t: u32) -> Place {
        match t {
            0 => Place::Vertex(self.topology.mesh_vertex(half_edge)),
            t if t == 2 * SIDE => Place::Vertex(self.topology.mesh_vertex(self.topology.next(half_edge))),
            t => match self.topology.twin(half_edge).filter(|&twin| twin < half_edge) {
                Some(twin) => Place::Edge(twin, 2 * SIDE - t),
                None => Place::Edge(half_edge, t),
            },
        }
    }

    fn on_spoke(&self, half_edge: u32, t: u32) -> Place {
        match t {
            0 => self.on_edge(half_edge, SIDE),
            t if t == SIDE => Place::Centre(self.topology.face(half_edge)),
            t => Place::Spoke(half_edge, t),
        }
    }

    /// The point of a root at (u, v), in parts of [`SIDE`].
    fn place(&self, number: u32, at: [u32; 2]) -> Place {
        let root = self.plan.roots[number as usize];
        let h = self.half_edge(root);
        let ([u, v], prev) = (at, self.topology.prev(h));
        if root.level == 0 {
            let edge =
                |k: u32, t: u32| self.on_edge(self.topology.mesh().face_corners(root.face).start as u32 + k, 2 * t);
            return match (u, v) {
                (u, 0) => edge(0, u),
                (SIDE, v) => edge(1, v),
                (u, SIDE) => edge(2, SIDE - u),
                (0, v) => edge(3, SIDE - v),
                _ => Place::Root(number, at),
            };
        }
        match (u, v) {
            (u, 0) => self.on_edge(h, u),
            (0, v) => self.on_edge(prev, 2 * SIDE - v),
            (SIDE, v) => self.on_spoke(h, v),
            (u, SIDE) => self.on_spoke(prev, u),
            _ => Place::Root(number, at),
        }
    }

    /// The line that a part of edge `k` of a leaf lies on, between its ends.
    fn line(&self, leaf: &Leaf, (k, ends): (u32, [u32; 2])) -> Line {
        let (side, [u, v]) = cell(self.plan, leaf);
        let (start, is_on_root) = match k {
            0 => (u, v == 0),
            1 => (v, u + side == SIDE),
            2 => (SIDE - u - side, v + side == SIDE),
            _ => (SIDE - v - side, u == 0),
        };
        if !is_on_root {
            return Line::Inner;
        }
        let (root, ends) = (self.plan.roots[leaf.root as usize], ends.map(|t| start + t));
        let h = self.half_edge(root);
        match (root.level, k) {
            (0, k) => Line::Edge(self.topology.mesh().face_corners(root.face).start as u32 + k, ends.map(|t| 2 * t)),
            (_, 0) => Line::Edge(h, ends),
            (_, 3) => Line::Edge(self.topology.prev(h), ends.map(|t| SIDE + t)),
            _ => Line::Inner,
        }
    }

    /// What corners of the root's face have, between them at (u, v).
    fn between<const N: usize>(&self, root: Root, at: [u32; 2], value: impl Fn(usize) -> [f64; N]) -> [f64; N] {
        let corners = self.topology.mesh().face_corners(root.face);
        let h = self.half_edge(root);
        let [next, prev] = [self.topology.next(h), self.topology.prev(h)];
        let value = |h: u32| value(h as usize);
        let halfway = |a: u32, b: u32| mean([value(a), value(b)].into_iter());
        let of_corners = match root.level {
            0 => [0, 1, 2, 3].map(|k| value(corners.start as u32 + k)),
            _ => [value(h), halfway(h, next), mean(corners.map(|h| value(h as u32))), halfway(prev, h)],
        };
        let [u, v] = at.map(|t| f64::from(t) / f64::from(SIDE));
        let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v];
        std::array::from_fn(|i| (0..4).map(|k| weights[k] * of_corners[k][i]).sum())
    }

    /// The number of a point's vertex.
    fn vertex(&mut self, number: u32, at: [u32; 2]) -> u32 {
        let place = self.place(number, at);
        if let Some(&known) = self.numbers.get(&place) {
            return known;
        }
        let (mesh, root) = (self.topology.mesh(), self.plan.roots[number as usize]);
        let position = |h: usize| mesh.data().positions[mesh.data().face_vertices[h] as usize];
        let vertex = self.positions.len() as u32;
        self.positions.push(self.between(root, at, position));
        self.numbers.insert(place, vertex);
        vertex
    }
}

/// The side of a leaf, and the corner of it with the least (u, v), in parts of [`SIDE`].
fn cell(plan: &Plan, leaf: &Leaf) -> (u32, [u32; 2]) {
    let side = SIDE >> (leaf.level - plan.roots[leaf.root as usize].level);
    (side, [leaf.u * side, leaf.v * side])
}

/// A point on edge `k` of a leaf or a root, `t` parts of its side along it.
pub(super) fn on_side([u, v]: [u32; 2], side: u32, k: u32, t: u32) -> [u32; 2] {
    match k {
        0 => [u + t, v],
        1 => [u + side, v + t],
        2 => [u + side - t, v + side],
        _ => [u, v + side - t],
    }
}

/// The mesh in the making.
#[derive(Default)]
struct Faces {
    data: MeshData,
    faces: Vec<CutFace>,
    /// The lines that half-edges lie on.
    lines: Vec<Line>,
    texcoords: Vec<[f32; 2]>,
}

/// Cuts a mesh into the leaves of a plan, and each leaf beside finer ones into triangles: every edge of a patch is an edge of its
/// neighbour, too.
///
/// # Errors
/// [`MeshError::TooLarge`].
pub(super) fn cut_by_leaves(whole: &Topology, plan: &Plan) -> Result<Pieces, MeshError> {
    let mut places = Places { topology: whole, plan, numbers: HashMap::default(), positions: Vec::new() };
    // Corners of all leaves, to be found between the corners of others.
    for leaf in &plan.leaves {
        let (side, at) = cell(plan, leaf);
        (0..4).for_each(|k| _ = places.vertex(leaf.root, on_side(at, side, k, 0)));
    }
    let mut leaves: Vec<u32> = (0..plan.leaves.len() as u32).collect();
    leaves.sort_by_key(|&leaf| (plan.leaves[leaf as usize].face, leaf));
    let mut made = Faces::default();
    leaves.into_iter().for_each(|leaf| made.add(&mut places, leaf));
    let Faces { mut data, faces, lines, texcoords } = made;
    let mut start = 0;
    for &size in &data.face_sizes {
        let vertices = &data.face_vertices[start..start + size as usize];
        for (k, line) in lines[start..start + size as usize].iter().enumerate() {
            if let Line::Edge(h, _) = *line
                && whole.sharpness(h) >= SHARPNESS_INFINITE
                && whole.twin(h).is_some()
            {
                let vertices = [vertices[k], vertices[(k + 1) % vertices.len()]];
                data.creases.push(Crease { vertices, sharpness: SHARPNESS_INFINITE });
            }
        }
        start += size as usize;
    }
    if whole.mesh().data().texcoords.is_some() {
        let indices = (0..texcoords.len() as u32).collect();
        data.texcoords = Some(FaceVarying { values: texcoords, indices });
    }
    data.positions = places.positions;
    // What is not drawn has no leaves.
    data.boundary = BoundaryRule::EdgeOnly;
    Ok(Pieces { topology: Arc::new(Topology::new(&ControlMesh::new(data)?)), faces, lines })
}

impl Faces {
    /// Adds the patches of a leaf.
    fn add(&mut self, places: &mut Places, number: u32) {
        let leaf = &places.plan.leaves[number as usize];
        let (side, at) = cell(places.plan, leaf);
        let mut parts = Vec::with_capacity(4);
        (0..4).for_each(|k| add_parts(places, leaf, k, [0, side], &mut parts));
        let point = |(k, [from, _]): (u32, [u32; 2])| on_side(at, side, k, from);
        if parts.len() == 4 {
            parts.iter().for_each(|&part| self.push(places, leaf, point(part), places.line(leaf, part)));
            self.push_face(4, leaf, Part::Leaf(number));
            return;
        }
        // From the middle of an edge that is halved once no triangle is degenerate.
        let halved = (0..4).find(|&k| parts.iter().filter(|part| part.0 == k).count() == 2);
        let apex = halved.map_or(at.map(|t| t + side / 2), |k| on_side(at, side, k, side / 2));
        let of_apex = |point| point == apex;
        for (i, &part) in parts.iter().enumerate() {
            let next = parts[(i + 1) % parts.len()];
            let points = [point(part), point(next)];
            if points.into_iter().any(of_apex) {
                continue;
            }
            // Of the parts of the boundary that start or end in the apex, each is the side of one triangle.
            let [before, after] = [parts[(i + parts.len() - 1) % parts.len()], parts[(i + 1) % parts.len()]];
            let to_apex =
                if of_apex(point(parts[(i + 2) % parts.len()])) { places.line(leaf, after) } else { Line::Inner };
            let from_apex = if of_apex(point(before)) { places.line(leaf, before) } else { Line::Inner };
            self.push(places, leaf, points[0], places.line(leaf, part));
            self.push(places, leaf, points[1], to_apex);
            self.push(places, leaf, apex, from_apex);
            let (edge, ends) = (part.0, part.1.map(|t| t * (SIDE / side)));
            let apex = halved.unwrap_or(APEX_IS_CENTRE);
            self.push_face(3, leaf, Part::OfLeaf(number, LeafPart { edge, ends, apex }));
        }
    }

    fn push_face(&mut self, size: u32, leaf: &Leaf, part: Part) {
        self.faces.push(CutFace { face: leaf.face, part });
        self.data.face_sizes.push(size);
    }

    /// Adds a corner of a face, and the line to the next.
    fn push(&mut self, places: &mut Places, leaf: &Leaf, at: [u32; 2], line: Line) {
        self.data.face_vertices.push(places.vertex(leaf.root, at));
        self.lines.push(line);
        if let Some(texcoords) = &places.topology.mesh().data().texcoords {
            let value = |h: usize| texcoords.values[texcoords.indices[h] as usize].map(f64::from);
            let texcoord = places.between(places.plan.roots[leaf.root as usize], at, value);
            self.texcoords.push(texcoord.map(|x| x as f32));
        }
    }
}

/// Adds the parts of edge `k` of a leaf between which others have corners.
fn add_parts(places: &Places, leaf: &Leaf, k: u32, [from, to]: [u32; 2], parts: &mut Vec<(u32, [u32; 2])>) {
    let (side, at) = cell(places.plan, leaf);
    let middle = from + (to - from) / 2;
    if to - from > 1 && places.numbers.contains_key(&places.place(leaf.root, on_side(at, side, k, middle))) {
        add_parts(places, leaf, k, [from, middle], parts);
        add_parts(places, leaf, k, [middle, to], parts);
    } else {
        parts.push((k, [from, to]));
    }
}
