//! Faces that lie edge on edge without being joined.
//!
//! Edges are joined, not vertices: pieces that touch in a point or along an edge that both have closed stay apart.

use super::{Joints, MeshData, NO_TWIN, Place, RepairKind, Work};
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Within which vertices are said to coincide, as a part of the diagonal.
const COINCIDENT: f64 = 1e-6;

/// Joins loose faces, to a part of the diagonal.
pub(super) fn mend(work: &mut Work, tolerance: f64) {
    let joints = Joints::new(&work.data);
    let open = open_half_edges(&joints);
    let places = places(&work.data, &joints, &open, tolerance);
    let mut roots: Vec<u32> = (0..work.data.positions.len() as u32).collect();
    for [a, b] in Matching::new(&work.data, &joints, &places).pairs(&open) {
        unite(&mut roots, a, b);
    }
    let joined = |roots: &mut Vec<u32>, vertex: u32| root(roots, vertex) != vertex;
    let vertices = 0..roots.len() as u32;
    let first = vertices.clone().find(|&vertex| joined(&mut roots, vertex));
    let count = vertices.filter(|&vertex| joined(&mut roots, vertex)).count();
    work.repairs.add(RepairKind::WeldedVertices, count, first.map(Place::Vertex));
    if count > 0 {
        let before = apply(&mut work.data, roots);
        work.repairs.renumber_vertices(before);
    }
}

/// Joins loose faces whose vertices have the same number in `places`. Gives the number that each vertex had before.
pub(in super::super) fn join(data: &mut MeshData, places: &[u32]) -> Vec<u32> {
    let joints = Joints::new(data);
    let mut roots: Vec<u32> = (0..data.positions.len() as u32).collect();
    for [a, b] in Matching::new(data, &joints, places).pairs(&open_half_edges(&joints)) {
        unite(&mut roots, a, b);
    }
    apply(data, roots)
}

/// Edges on boundaries that lie on others.
pub(super) fn loose_edges(data: &MeshData, joints: &Joints) -> usize {
    let open = open_half_edges(joints);
    if open.is_empty() {
        return 0;
    }
    let places = places(data, joints, &open, COINCIDENT);
    let matching = Matching::new(data, joints, &places);
    let loose = matching.edges(&open);
    loose.len() * 2
}

/// Half-edges on boundaries.
fn open_half_edges(joints: &Joints) -> Vec<u32> {
    let mut at_fault: Vec<u32> = joints.crowded.iter().map(|&(_, h)| h).collect();
    at_fault.extend(joints.opposed.iter().flatten());
    at_fault.sort_unstable();
    let is_open = |&h: &u32| joints.twins[h as usize] == NO_TWIN && at_fault.binary_search(&h).is_err();
    (0..joints.twins.len() as u32).filter(is_open).collect()
}

/// A number for the place of each vertex of faces on boundaries: the same in neighbouring cells of a grid half as wide as the
/// tolerance.
fn places(data: &MeshData, joints: &Joints, open: &[u32], tolerance: f64) -> Vec<u32> {
    let mut places = vec![u32::MAX; data.positions.len()];
    let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for position in data.face_vertices.iter().map(|&v| DVec3::from(data.positions[v as usize])) {
        if position.is_finite() {
            bounds = [bounds[0].min(position), bounds[1].max(position)];
        }
    }
    let spacing = (bounds[1] - bounds[0]).length() * tolerance / 2.0;
    let mut cells: HashMap<[u64; 3], u32> = HashMap::new();
    let mut roots: Vec<u32> = Vec::new();
    let mut faces: Vec<u32> = open.iter().map(|&h| joints.faces[h as usize]).collect();
    faces.dedup();
    for at in faces.into_iter().flat_map(|face| joints.corners(face)).map(|corner| data.face_vertices[corner]) {
        let position = DVec3::from(data.positions[at as usize]);
        if places[at as usize] != u32::MAX {
            continue;
        }
        let cell = match spacing > 0.0 {
            true => ((position - bounds[0]) / spacing).floor().to_array().map(|x| (x as i64) as u64),
            // Adding zero makes -0 and 0 the same.
            false => position.to_array().map(|x| (x + 0.0).to_bits()),
        };
        let count = roots.len() as u32;
        let place = *cells.entry(cell).or_insert(count);
        places[at as usize] = place;
        if place < count {
            continue;
        }
        roots.push(place);
        if spacing > 0.0 {
            for step in 0..27 {
                let offset = [step % 3, step / 3 % 3, step / 9];
                let beside = std::array::from_fn(|axis| cell[axis].wrapping_add(offset[axis]).wrapping_sub(1));
                if let Some(&beside) = cells.get(&beside) {
                    unite(&mut roots, place, beside);
                }
            }
        }
    }
    for (vertex, place) in (0..).zip(&mut places) {
        // Others are alone where they are.
        *place = if *place == u32::MAX { u32::MAX - vertex } else { root(&mut roots, *place) };
    }
    places
}

/// Which open edges belong together.
struct Matching<'d> {
    data: &'d MeshData,
    joints: &'d Joints,
    places: &'d [u32],
}

impl<'d> Matching<'d> {
    fn new(data: &'d MeshData, joints: &'d Joints, places: &'d [u32]) -> Self {
        Self { data, joints, places }
    }

    /// The vertices of a half-edge.
    fn ends(&self, half_edge: u32) -> [u32; 2] {
        [half_edge, self.joints.next(half_edge)].map(|h| self.data.face_vertices[h as usize])
    }

    fn places_of(&self, half_edge: u32) -> [u32; 2] {
        self.ends(half_edge).map(|vertex| self.places[vertex as usize])
    }

    /// Vertices that become one: the ends of edges that lie on one another, and of edges without length.
    fn pairs(&self, open: &[u32]) -> Vec<[u32; 2]> {
        let is_short = |&h: &u32| self.places_of(h)[0] == self.places_of(h)[1];
        let mut pairs: Vec<[u32; 2]> = open.iter().copied().filter(is_short).map(|h| self.ends(h)).collect();
        for [a, b] in self.edges(open) {
            let ([a0, a1], [b0, b1]) = (self.ends(a), self.ends(b));
            let is_opposite = self.places_of(a)[0] != self.places_of(b)[0];
            pairs.extend(if is_opposite { [[a0, b1], [a1, b0]] } else { [[a0, b0], [a1, b1]] });
        }
        pairs
    }

    /// Half-edges that lie on one another, in pairs.
    fn edges(&self, open: &[u32]) -> Vec<[u32; 2]> {
        let key = |h: u32| {
            let [a, b] = self.places_of(h);
            (a.min(b), a.max(b), h)
        };
        let mut keys: Vec<(u32, u32, u32)> = open.iter().map(|&h| key(h)).filter(|(a, b, _)| a != b).collect();
        keys.sort_unstable();
        let mut pairs = Vec::new();
        for edge in keys.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            match *edge {
                [_] => {}
                [(.., a), (.., b)] => {
                    if !self.lie_on_another(a, b) {
                        pairs.push([a, b]);
                    }
                }
                _ => self.match_around(edge[0].0, &edge.iter().map(|key| key.2).collect::<Vec<_>>(), &mut pairs),
            }
        }
        pairs
    }

    /// Whether the faces of two half-edges have all their vertices at the same places: a sheet and its back.
    fn lie_on_another(&self, a: u32, b: u32) -> bool {
        let places = |h: u32| {
            let corners = self.joints.corners(self.joints.faces[h as usize]);
            let mut places: Vec<u32> =
                corners.map(|corner| self.places[self.data.face_vertices[corner] as usize]).collect();
            places.sort_unstable();
            places
        };
        let size = |h: u32| self.joints.corners(self.joints.faces[h as usize]).len();
        size(a) == size(b) && places(a) == places(b)
    }

    /// Pairs the faces around an edge of three and more: each with the next on its inner side that runs the other way, as in the
    /// solids that they bound.
    fn match_around(&self, low: u32, half_edges: &[u32], pairs: &mut Vec<[u32; 2]>) {
        /// Steps of a whole turn: faces nearer than one lie on one another.
        const STEPS: f64 = 65536.0;
        let position = |vertex: u32| DVec3::from(self.data.positions[vertex as usize]);
        let runs_up = |h: u32| self.places_of(h)[0] == low;
        let [from, to] = self.ends(half_edges[0]).map(position);
        let axis = (if runs_up(half_edges[0]) { to - from } else { from - to }).normalize_or(DVec3::Z);
        let (e1, e2) = axis.any_orthonormal_pair();
        let around = |h: u32| {
            let inward = self.normal(self.joints.faces[h as usize]).cross(if runs_up(h) { axis } else { -axis });
            let turn = inward.dot(e2).atan2(inward.dot(e1)) / TAU;
            (turn * STEPS).round().rem_euclid(STEPS) as u32
        };
        // Down around the edge; of faces that lie on one another those come first that wait for none.
        let mut order: Vec<(std::cmp::Reverse<u32>, bool, u32)> =
            half_edges.iter().map(|&h| (std::cmp::Reverse(around(h)), runs_up(h), h)).collect();
        order.sort_unstable();
        let mut waiting = Vec::new();
        let mut left = Vec::new();
        for &(_, up, h) in &order {
            match up.then_some(h).or_else(|| waiting.pop()) {
                Some(up) if up == h => waiting.push(h),
                Some(up) => pairs.push([up, h]),
                None => left.push(h),
            }
        }
        // Across the start of the turn.
        for h in left {
            let Some(up) = waiting.pop() else { break };
            pairs.push([up, h]);
        }
    }

    /// The normal of a face, of any length.
    fn normal(&self, face: u32) -> DVec3 {
        let position = |corner: usize| DVec3::from(self.data.positions[self.data.face_vertices[corner] as usize]);
        let corners = self.joints.corners(face);
        let first = position(corners.start);
        let fan = (corners.start + 1..corners.end - 1).map(|k| (position(k) - first).cross(position(k + 1) - first));
        fan.sum()
    }
}

/// Gives joined vertices one number. Gives the number that each vertex had before.
fn apply(data: &mut MeshData, mut roots: Vec<u32>) -> Vec<u32> {
    let mut numbers = vec![u32::MAX; roots.len()];
    let mut before = Vec::new();
    for vertex in 0..roots.len() as u32 {
        // A root is the lowest of its vertices.
        let root = root(&mut roots, vertex);
        if root == vertex {
            numbers[vertex as usize] = before.len() as u32;
            before.push(vertex);
        } else {
            numbers[vertex as usize] = numbers[root as usize];
        }
    }
    data.positions = before.iter().map(|&vertex| data.positions[vertex as usize]).collect();
    data.face_vertices.iter_mut().for_each(|vertex| *vertex = numbers[*vertex as usize]);
    // Tags on vertices that never were stay wrong, and are found later.
    let number = |vertex: u32| numbers.get(vertex as usize).copied().unwrap_or(vertex);
    data.creases.iter_mut().for_each(|crease| crease.vertices = crease.vertices.map(number));
    data.corners.iter_mut().for_each(|corner| corner.vertex = number(corner.vertex));
    before
}

fn root(roots: &mut [u32], mut of: u32) -> u32 {
    while roots[of as usize] != of {
        roots[of as usize] = roots[roots[of as usize] as usize];
        of = roots[of as usize];
    }
    of
}

/// The lower root stays one.
fn unite(roots: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(roots, a), root(roots, b));
    roots[a.max(b) as usize] = a.min(b);
}
