//! The edges of patches, each once: its curve, its owner, its two ends.

use super::cells::{Cells, CurvePart, number_edges};
use super::plan::PatchPlan;
use crate::topology::Topology;

/// An edge of the patches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EdgeRecord {
    /// What it is a part of: edges of the caller's mesh are the curves that come first, in the order of their lower half-edges.
    pub part: CurvePart,
    /// The half-edge that owns the edge, for both sides: that which runs from the lower vertex of the mesh to the higher, or the
    /// only one.
    pub owner: u32,
    /// Whether the faces at it are lit with normals of their own.
    pub is_sharp: bool,
}

/// The edges of the patches of a mesh, in the order of their lower half-edges.
#[derive(Debug, Clone)]
pub struct EdgeTable {
    /// What is known of each.
    pub records: Vec<EdgeRecord>,
    /// The vertices at both ends of each: those of the control mesh, or of the refined one where it had to be refined.
    pub vertices: Vec<[u32; 2]>,
    /// For each patch corner, in the order of the plan, the edge to the next.
    pub of_corners: Vec<u32>,
    /// The edge of each half-edge.
    of_half_edges: Vec<u32>,
}

impl EdgeTable {
    /// Of the patches in `plan`, whose faces are those of `topology`, which `cells` are of.
    pub(super) fn new(topology: &Topology, cells: &Cells, plan: &PatchPlan) -> Self {
        let (of_half_edges, count) = number_edges(topology);
        let mut table = Self {
            records: Vec::with_capacity(count as usize),
            vertices: Vec::with_capacity(count as usize),
            of_corners: plan.corners(topology).into_iter().map(|h| of_half_edges[h as usize]).collect(),
            of_half_edges,
        };
        for h in 0..topology.mesh().corner_count() as u32 {
            let twin = topology.twin(h);
            if twin.is_some_and(|twin| twin < h) {
                continue;
            }
            let ends = [topology.mesh_vertex(h), topology.mesh_vertex(topology.next(h))];
            let owner = twin.filter(|_| ends[0] > ends[1]).unwrap_or(h);
            let part = cells.of_half_edge(h, table.records.len() as u32);
            table.records.push(EdgeRecord { part, owner, is_sharp: !topology.is_within_rings(h) });
            table.vertices.push(ends);
        }
        table
    }

    /// The record of a half-edge's edge.
    pub fn of_half_edge(&self, half_edge: u32) -> &EdgeRecord {
        &self.records[self.of_half_edges[half_edge as usize] as usize]
    }
}
