//! Which half-edge lies opposite which.

use super::error::MeshError;
use rayon::prelude::*;
use std::collections::HashMap;

/// In a twin table: the half-edge lies on a boundary.
pub(crate) const NO_TWIN: u32 = u32::MAX;

/// A half-edge filed under the lower of its two vertices.
#[derive(Clone, Copy, Default)]
pub(super) struct Filed {
    /// The higher vertex.
    pub(super) high: u32,
    pub(super) half_edge: u32,
}

/// The half-edges of a mesh, edge by edge.
///
/// They are filed under their lower vertex by counting, so that each file is as long as a vertex's valence and files can be
/// sorted in parallel: linear time up to sorting within one vertex.
pub(super) struct Edges {
    filed: Vec<Filed>,
    file_offsets: Vec<u32>,
}

impl Edges {
    pub(super) fn new(vertex_count: usize, face_offsets: &[u32], face_vertices: &[u32]) -> Self {
        let count = face_vertices.len();
        let mut file_offsets = vec![0u32; vertex_count + 1];
        for_each_half_edge(face_offsets, face_vertices, |_, from, to| file_offsets[from.min(to) as usize + 1] += 1);
        for i in 0..vertex_count {
            file_offsets[i + 1] += file_offsets[i];
        }
        let mut filed = vec![Filed::default(); count];
        let mut next = file_offsets.clone();
        for_each_half_edge(face_offsets, face_vertices, |half_edge, from, to| {
            let slot = &mut next[from.min(to) as usize];
            filed[*slot as usize] = Filed { high: from.max(to), half_edge };
            *slot += 1;
        });
        drop(next);

        let mut files = Vec::with_capacity(vertex_count);
        let mut rest = filed.as_mut_slice();
        for range in file_offsets.windows(2) {
            let (file, tail) = rest.split_at_mut((range[1] - range[0]) as usize);
            files.push(file);
            rest = tail;
        }
        files.par_iter_mut().with_min_len(1024).for_each(|file| file.sort_unstable_by_key(|f| (f.high, f.half_edge)));
        Self { filed, file_offsets }
    }

    /// Every edge: its lower vertex, and its half-edges in ascending order.
    pub(super) fn iter(&self) -> impl Iterator<Item = (u32, &[Filed])> {
        let file = |range: &[u32]| &self.filed[range[0] as usize..range[1] as usize];
        let files = self.file_offsets.windows(2).map(file);
        (0..).zip(files).flat_map(|(low, file)| file.chunk_by(|a, b| a.high == b.high).map(move |edge| (low, edge)))
    }
}

/// Finds the twin of every half-edge.
pub(crate) fn twins(vertex_count: usize, face_offsets: &[u32], face_vertices: &[u32]) -> Result<Vec<u32>, MeshError> {
    let edges = Edges::new(vertex_count, face_offsets, face_vertices);
    let mut twins = vec![NO_TWIN; face_vertices.len()];
    let mut faults = Vec::new();
    for (low, edge) in edges.iter() {
        match *edge {
            [_] => {}
            [a, b] if face_vertices[a.half_edge as usize] != face_vertices[b.half_edge as usize] => {
                twins[a.half_edge as usize] = b.half_edge;
                twins[b.half_edge as usize] = a.half_edge;
            }
            _ => faults.push((low, edge)),
        }
    }
    // The fault that comes first in the mesh, so that the message does not depend on how edges were filed.
    match faults.iter().min_by_key(|(_, edge)| edge.last().map(|f| f.half_edge)) {
        None => Ok(twins),
        Some((low, edge)) => Err(fault(*low, edge, face_offsets)),
    }
}

fn fault(low: u32, pair: &[Filed], face_offsets: &[u32]) -> MeshError {
    let face_of = |f: &Filed| face_offsets.partition_point(|&offset| offset <= f.half_edge) as u32 - 1;
    let edge = [low, pair[0].high];
    match pair {
        [a, b] => MeshError::InconsistentOrientation { face: face_of(b), other: face_of(a), edge },
        _ => MeshError::NonManifoldEdge { face: face_of(&pair[2]), edge },
    }
}

pub(super) fn for_each_half_edge(face_offsets: &[u32], face_vertices: &[u32], mut visit: impl FnMut(u32, u32, u32)) {
    for range in face_offsets.windows(2) {
        let face = &face_vertices[range[0] as usize..range[1] as usize];
        let mut from = face[face.len() - 1];
        // The half-edge that enters corner k is the one that starts at the corner before it.
        let mut half_edge = range[1] - 1;
        for (k, &to) in face.iter().enumerate() {
            visit(half_edge, from, to);
            from = to;
            half_edge = range[0] + k as u32;
        }
    }
}

/// The lower half-edge of the edge between each pair of vertices, [`NO_TWIN`] where there is no such edge.
pub(crate) fn find_edges(edges: &[[u32; 2]], face_offsets: &[u32], face_vertices: &[u32], twins: &[u32]) -> Vec<u32> {
    if edges.is_empty() {
        return Vec::new();
    }
    let key = |a: u32, b: u32| (a.min(b), a.max(b));
    let mut wanted: HashMap<(u32, u32), u32> = edges.iter().map(|&[a, b]| (key(a, b), NO_TWIN)).collect();
    for_each_half_edge(face_offsets, face_vertices, |half_edge, from, to| {
        if let Some(found) = wanted.get_mut(&key(from, to)) {
            *found = half_edge.min(twins[half_edge as usize]);
        }
    });
    edges.iter().map(|&[a, b]| wanted[&key(a, b)]).collect()
}

/// Whether there is an edge between each pair of vertices.
pub(super) fn are_edges(edges: &[[u32; 2]], face_offsets: &[u32], face_vertices: &[u32]) -> Vec<bool> {
    if edges.is_empty() {
        return Vec::new();
    }
    let key = |a: u32, b: u32| (a.min(b), a.max(b));
    let mut exists: HashMap<(u32, u32), bool> = edges.iter().map(|&[a, b]| (key(a, b), false)).collect();
    for_each_half_edge(face_offsets, face_vertices, |_, from, to| {
        if let Some(exists) = exists.get_mut(&key(from, to)) {
            *exists = true;
        }
    });
    edges.iter().map(|&[a, b]| exists[&key(a, b)]).collect()
}
