//! Surfaces that meet along an edge of three and more faces are parted there.

use super::{Joints, NO_TWIN, Place, RepairKind, Work};
use crate::mesh::{BoundaryRule, Corner, Crease, MeshData, SHARPNESS_INFINITE};
use std::collections::HashMap;

/// Parts surfaces at crowded and opposed edges and at `crossed` corners.
pub(super) fn mend(work: &mut Work, joints: &mut Joints, crossed: &[u32]) {
    report(work, joints, crossed);
    if !joints.has_faults() && crossed.is_empty() {
        return;
    }
    let Cut { cut, is_parted } = Cut::new(&work.data, joints, crossed);
    let parting = Parting { joints, data: &work.data, cut: &cut, is_parted: &is_parted };
    let Parted { vertices, sources, corners } = parting.walk();
    let data = &mut work.data;
    copy_tags(data, joints, &vertices, &is_parted);
    for (half_edge, _) in cut.iter().enumerate().filter(|(_, cut)| **cut) {
        let ends = [half_edge as u32, joints.next(half_edge as u32)].map(|h| vertices[h as usize]);
        data.creases.push(Crease { vertices: ends, sharpness: SHARPNESS_INFINITE });
    }
    let count = data.positions.len() as u32;
    let copies: HashMap<u32, Vec<u32>> = (count..).zip(&sources).fold(HashMap::new(), |mut copies, (copy, &source)| {
        copies.entry(source).or_insert_with(Vec::new).push(copy);
        copies
    });
    let of_copies = |corner: &Corner| {
        let vertices = copies.get(&corner.vertex).into_iter().flatten();
        vertices.map(|&vertex| Corner { vertex, ..*corner }).collect::<Vec<_>>()
    };
    data.corners.extend(corners.into_iter().map(|vertex| Corner { vertex, sharpness: SHARPNESS_INFINITE }));
    data.corners.extend(data.corners.iter().flat_map(of_copies).collect::<Vec<_>>());
    data.face_vertices = vertices;
    data.positions.extend(sources.iter().map(|&source| data.positions[source as usize]).collect::<Vec<_>>());
    if !sources.is_empty() {
        work.repairs.renumber_vertices((0..count).chain(sources).collect());
    }
}

fn report(work: &mut Work, joints: &Joints, crossed: &[u32]) {
    let crowded = || joints.crowded_edges().filter(|edge| edge.len() > 2);
    // By the third face, as the error has it.
    let first = crowded().map(|edge| edge[2].1).min();
    work.repairs.add(RepairKind::CrowdedEdges, crowded().count(), first.map(|h| joints.place(&work.data, h)));
    let first = crossed.first().map(|&corner| Place::Face(joints.faces[corner as usize]));
    work.repairs.add(RepairKind::CrossedCorners, crossed.len(), first);
}

struct Cut {
    /// Half-edges at which nothing is joined.
    cut: Vec<bool>,
    /// Vertices at the ends of those.
    is_parted: Vec<bool>,
}

impl Cut {
    /// Takes the faces apart.
    fn new(data: &MeshData, joints: &mut Joints, crossed: &[u32]) -> Self {
        let faults = joints.crowded.iter().map(|&(_, h)| h).chain(joints.opposed.iter().flatten().copied());
        let mut half_edges: Vec<u32> = faults.collect();
        // Such a corner is parted from all around it.
        for half_edge in crossed.iter().flat_map(|&corner| [corner, joints.prev(corner)]) {
            half_edges.push(half_edge);
            half_edges.extend(Some(joints.twins[half_edge as usize]).filter(|&twin| twin != NO_TWIN));
        }
        let mut cut = vec![false; data.face_vertices.len()];
        let mut is_parted = vec![false; data.positions.len()];
        for half_edge in half_edges {
            cut[half_edge as usize] = true;
            joints.cut(half_edge);
            joints.edge(data, half_edge).into_iter().for_each(|end| is_parted[end as usize] = true);
        }
        Self { cut, is_parted }
    }
}

struct Parting<'j> {
    joints: &'j Joints,
    data: &'j MeshData,
    cut: &'j [bool],
    is_parted: &'j [bool],
}

struct Parted {
    /// The vertex of each face corner.
    vertices: Vec<u32>,
    /// The vertex that each copy is one of.
    sources: Vec<u32>,
    /// Vertices that are corners, and so are their copies.
    corners: Vec<u32>,
}

/// The faces around a vertex that are joined.
struct Fan {
    corners: Vec<u32>,
    /// The other ends of the first edge and the last, if both are cut and differ: the lower first.
    through: Option<[u32; 2]>,
}

impl Parting<'_> {
    /// Gives every fan but the first of a vertex a copy of it. Where all fans lie between the same two edges the line runs on
    /// through the vertex; anywhere else it is a corner.
    fn walk(&self) -> Parted {
        let (face_vertices, count) = (&self.data.face_vertices, self.data.positions.len() as u32);
        let mut parted = Parted { vertices: face_vertices.clone(), sources: Vec::new(), corners: Vec::new() };
        let mut seen = vec![false; face_vertices.len()];
        let mut through: HashMap<u32, Option<[u32; 2]>> = HashMap::new();
        for (corner, &vertex) in (0..).zip(face_vertices) {
            if seen[corner as usize] || !self.is_parted[vertex as usize] {
                continue;
            }
            let fan = self.fan(corner);
            fan.corners.iter().for_each(|&corner| seen[corner as usize] = true);
            match through.get_mut(&vertex) {
                None => drop(through.insert(vertex, fan.through)),
                Some(of_others) => {
                    if *of_others != fan.through {
                        *of_others = None;
                    }
                    let copy = count + parted.sources.len() as u32;
                    parted.sources.push(vertex);
                    fan.corners.iter().for_each(|&corner| parted.vertices[corner as usize] = copy);
                }
            }
        }
        parted.corners = through.iter().filter(|(_, through)| through.is_none()).map(|(&vertex, _)| vertex).collect();
        parted.corners.sort_unstable();
        parted
    }

    fn fan(&self, start: u32) -> Fan {
        let joints = self.joints;
        let mut corners = vec![start];
        let mut last = start;
        loop {
            match joints.twins[joints.prev(last) as usize] {
                NO_TWIN => break,
                next if next == start => return Fan { corners, through: None },
                next => last = next,
            }
            corners.push(last);
        }
        let mut first = start;
        while joints.twins[first as usize] != NO_TWIN {
            first = joints.next(joints.twins[first as usize]);
            corners.push(first);
        }
        let (first_edge, last_edge) = (first, joints.prev(last));
        let is_cut = |h: u32| self.cut[h as usize];
        let ends = [joints.next(first_edge), last_edge].map(|h| self.data.face_vertices[h as usize]);
        let is_lone = self.data.boundary == BoundaryRule::EdgeAndCorner && corners.len() == 1;
        let through = is_cut(first_edge) && is_cut(last_edge) && ends[0] != ends[1] && !is_lone;
        Fan { corners, through: through.then_some([ends[0].min(ends[1]), ends[0].max(ends[1])]) }
    }
}

/// Gives creases at parted vertices to the copies of their edges.
fn copy_tags(data: &mut MeshData, joints: &Joints, vertices: &[u32], is_parted: &[bool]) {
    let mut creases = std::mem::take(&mut data.creases);
    let mut copies: HashMap<[u32; 2], Vec<[u32; 2]>> = HashMap::new();
    let key = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let is_touched = |ends: [u32; 2]| ends.into_iter().any(|vertex| is_parted[vertex as usize]);
    for crease in creases.iter().filter(|crease| is_touched(crease.vertices)) {
        copies.entry(key(crease.vertices)).or_default();
    }
    if !copies.is_empty() {
        for half_edge in 0..vertices.len() as u32 {
            if let Some(copies) = copies.get_mut(&joints.edge(data, half_edge)) {
                let copy = key([half_edge, joints.next(half_edge)].map(|h| vertices[h as usize]));
                copies.push(copy);
            }
        }
    }
    for copies in copies.values_mut() {
        copies.sort_unstable();
        copies.dedup();
    }
    for crease in creases.drain(..) {
        match copies.get(&key(crease.vertices)) {
            Some(copies) => data.creases.extend(copies.iter().map(|&vertices| Crease { vertices, ..crease })),
            None => data.creases.push(crease),
        }
    }
}
