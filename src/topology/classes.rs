//! Which patch a face becomes.

use super::half_edges::Topology;
use crate::mesh::{BoundaryRule, SHARPNESS_INFINITE};
use crate::named::named;

named! {
    /// The patch that a face of the mesh becomes.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum PatchKind {
        /// A quad whose one-rings are regular: a bicubic B-spline patch, which is the limit surface itself.
        Regular = "regular",
        /// Any other quad.
        IrregularQuad = "irregular_quad",
        /// A triangle, in whatever surroundings.
        Triangle = "triangle",
        /// A fifth of a face of five corners, in whatever surroundings: the triangle between an edge of it and its centre.
        Pentagon = "pentagon",
    }
}

impl PatchKind {
    /// Corners of the patch. A fifth of a pentagon takes its control points from all five corners of the face.
    pub fn corners(self) -> usize {
        match self {
            Self::Triangle => 3,
            Self::Pentagon => 5,
            _ => 4,
        }
    }

    /// Patches of the kind per face.
    pub fn pieces(self) -> u32 {
        if self == Self::Pentagon { 5 } else { 1 }
    }

    /// Whether the patch has barycentric parameters, those of a triangle.
    pub fn is_triangular(self) -> bool {
        matches!(self, Self::Triangle | Self::Pentagon)
    }
}

impl Topology {
    /// The patch that a face becomes, or its pieces; `None` for a face with six or more corners, which must be refined
    /// first.
    pub fn patch_kind(&self, face: u32) -> Option<PatchKind> {
        let corners = self.mesh.face_corners(face);
        match corners.len() {
            3 => Some(PatchKind::Triangle),
            4 if { corners }.all(|h| self.rings[self.places[h].ring as usize].is_regular()) => Some(PatchKind::Regular),
            4 => Some(PatchKind::IrregularQuad),
            5 => Some(PatchKind::Pentagon),
            _ => None,
        }
    }
}

/// Whether each face is drawn: a drawn face is no hole and, under [`BoundaryRule::None`], touches no boundary but edges that
/// are tagged infinitely sharp.
pub fn draws_face(topology: &Topology) -> Vec<bool> {
    let mesh = topology.mesh();
    let mut draws = vec![true; mesh.face_count()];
    for &hole in &mesh.data().holes {
        draws[hole as usize] = false;
    }
    if mesh.data().boundary == BoundaryRule::None {
        let mut on_boundary = vec![false; topology.vertex_count()];
        let half_edges = 0..mesh.corner_count() as u32;
        let is_open = |h: u32| topology.twin(h).is_none() && mesh.crease_sharpness(h) < SHARPNESS_INFINITE;
        for half_edge in half_edges.clone().filter(|&h| is_open(h)) {
            on_boundary[topology.vertex(half_edge) as usize] = true;
            on_boundary[topology.vertex(topology.next(half_edge)) as usize] = true;
        }
        for half_edge in half_edges.filter(|&h| on_boundary[topology.vertex(h) as usize]) {
            draws[topology.face(half_edge) as usize] = false;
        }
    }
    draws
}
