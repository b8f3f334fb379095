//! The cells of the caller's faces that a prepared mesh has as faces, and the curves of its edges.

use super::patch_id::{FaceOrigin, MAX_LEVEL, MAX_PARTS, PatchId};
use super::pieces::{LeafPart, Line, Pieces, SIDE};
use super::plan::Patch;
use super::wedges::{CutFace, Part};
use crate::adaptive::Plan;
use crate::mesh::{ControlMesh, MeshError};
use crate::topology::{PatchKind, Topology};

/// Numbers of the parts of a mesh's faces, as Ptex numbers its faces: a quad is one part, any other face has one around each
/// corner.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Parts {
    /// The first part of each face, and the number of all; empty where all faces are quads.
    first: Vec<u32>,
}

impl Parts {
    /// Those of all faces.
    ///
    /// # Errors
    /// [`MeshError::TooLarge`] if a [`PatchId`] has no room for so many.
    pub fn new(mesh: &ControlMesh) -> Result<Self, MeshError> {
        let sizes = &mesh.data().face_sizes;
        let parts = |&size: &u32| if size == 4 { 1 } else { size };
        let (count, max) = (sizes.iter().map(|size| parts(size) as usize).sum(), MAX_PARTS);
        if count > max {
            return Err(MeshError::TooLarge { what: "quads and corners of other faces", count, max });
        }
        if sizes.iter().all(|&size| size == 4) {
            return Ok(Self::default());
        }
        let mut first = Vec::with_capacity(sizes.len() + 1);
        first.push(0);
        for (face, size) in sizes.iter().enumerate() {
            first.push(first[face] + parts(size));
        }
        Ok(Self { first })
    }

    /// The first part of a face.
    pub fn first(&self, face: u32) -> u32 {
        self.first.get(face as usize).copied().unwrap_or(face)
    }

    /// The face of a part, and its corner if the face is no quad.
    pub fn face(&self, part: u32) -> (u32, Option<u32>) {
        if self.first.is_empty() {
            return (part, None);
        }
        let face = self.first.partition_point(|&first| first <= part) - 1;
        let parts = self.first[face + 1] - self.first[face];
        (face as u32, (parts > 1).then(|| part - self.first[face]))
    }

    /// Where a patch comes from.
    pub(super) fn origin(&self, patch: &Patch) -> FaceOrigin {
        let (id, (face, part)) = (patch.id, self.face(patch.id.face()));
        let corner = match patch.kind {
            PatchKind::Pentagon => Some(id.first()),
            _ if patch.is_wedge() => part,
            _ => part.filter(|_| id.level() > 0),
        };
        FaceOrigin { face, corner, id }
    }
}

/// A part of a curve: what half-edges lie on. A curve begins as an edge, that of the caller's mesh or one within a face where
/// refinement made it or wedges meet; each further step halves its parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct CurvePart {
    /// The number of the curve.
    pub curve: u32,
    /// How often the curve was halved: the part is one of `2^level`.
    pub level: u8,
    /// Which of them, from the start of the curve: that of the lower half-edge when it began.
    pub index: u16,
}

/// A half-edge and the part of a curve that it lies on.
#[derive(Debug, Clone, Copy)]
struct OnCurve {
    part: CurvePart,
    /// Whether the half-edge runs against the curve.
    reversed: bool,
}

impl OnCurve {
    /// The half of the part from which the half-edge starts, or the other.
    fn half(self, second: bool) -> Self {
        let CurvePart { curve, level, index } = self.part;
        let index = 2 * index + u16::from(second != self.reversed);
        Self { part: CurvePart { curve, level: level + 1, index }, ..self }
    }

    /// The part between two places, counted from where the half-edge starts; there are `side` on all of it, and the part is one of
    /// its halves, their halves and so on.
    fn part(self, [from, to]: [u32; 2], side: u32) -> Self {
        match to - from == side {
            true => self,
            false if from < side / 2 => self.half(false).part([from, to], side / 2),
            false => self.half(true).part([from - side / 2, to - side / 2], side / 2),
        }
    }
}

/// What the faces and half-edges of a prepared mesh are of the caller's.
#[derive(Debug, Clone)]
pub struct Cells {
    parts: Parts,
    /// By face of the prepared mesh; empty where nothing was refined or cut.
    of_faces: Vec<PatchId>,
    /// By half-edge; empty where nothing was refined or cut.
    of_half_edges: Vec<OnCurve>,
    /// Curves so far, where something was refined.
    curves: u32,
    /// Vertices of the caller's mesh.
    control_vertices: u32,
    /// Whether the mesh is refined.
    is_refined: bool,
}

impl Cells {
    /// Of the mesh as it is.
    pub(super) fn whole(mesh: &ControlMesh) -> Result<Self, MeshError> {
        let (parts, control_vertices) = (Parts::new(mesh)?, mesh.vertex_count() as u32);
        Ok(Self {
            parts,
            of_faces: Vec::new(),
            of_half_edges: Vec::new(),
            curves: 0,
            control_vertices,
            is_refined: false,
        })
    }

    /// Of the mesh that one step of refinement makes of that of `topology`, at most [`MAX_LEVEL`](super::patch_id::MAX_LEVEL) in all.
    pub(super) fn refined(mut self, topology: &Topology) -> Self {
        let mesh = topology.mesh();
        let mut of_faces = Vec::with_capacity(mesh.corner_count());
        for face in 0..mesh.face_count() as u32 {
            let cell = self.of_face(face);
            let is_quad = mesh.face(face).len() == 4;
            let child = |corner| if is_quad { cell.child(corner) } else { PatchId::of_part(cell.face() + corner) };
            of_faces.extend((0..mesh.face(face).len() as u32).map(child));
        }
        let (coarse, curves) = match self.of_half_edges.is_empty() {
            true => edges_as_curves(topology),
            false => (std::mem::take(&mut self.of_half_edges), self.curves),
        };
        // From the middle of half-edge h's edge to the centre of its face.
        let spoke = |h: u32, reversed| OnCurve { part: CurvePart { curve: curves + h, level: 0, index: 0 }, reversed };
        let child = |h: u32| {
            let prev = topology.prev(h);
            let [edge, before] = [h, prev].map(|h| coarse[h as usize]);
            [edge.half(false), spoke(h, false), spoke(prev, true), before.half(true)]
        };
        let corners = mesh.corner_count() as u32;
        let of_half_edges = (0..corners).flat_map(child).collect();
        Self { of_faces, of_half_edges, curves: curves + corners, is_refined: true, ..self }
    }

    /// Of a mesh some of whose faces are cut. `topology` is of the mesh before, which nothing refined, and `faces` says what each
    /// face of the new one was there.
    pub(super) fn cut(self, topology: &Topology, faces: &[CutFace]) -> Self {
        let (whole, curves) = edges_as_curves(topology);
        let mesh = topology.mesh();
        let of_face = |cut: &CutFace| PatchId::whole(self.parts.first(cut.face) + cut.part.corner().unwrap_or(0));
        // From the corner of half-edge h to the centre of its face.
        let spoke = |h: u32, reversed| OnCurve { part: CurvePart { curve: curves + h, level: 0, index: 0 }, reversed };
        let mut of_half_edges = Vec::with_capacity(4 * faces.len());
        for &CutFace { face, part } in faces {
            let corners = mesh.face_corners(face);
            match part.corner() {
                None => of_half_edges.extend_from_slice(&whole[corners]),
                Some(corner) => {
                    let h = corners.start as u32 + corner;
                    of_half_edges.extend([whole[h as usize], spoke(topology.next(h), false), spoke(h, true)]);
                }
            }
        }
        let curves = curves + mesh.corner_count() as u32;
        Self { of_faces: faces.iter().map(of_face).collect(), of_half_edges, curves, ..self }
    }

    /// Of a mesh that is cut by leaves; `topology` is of the mesh before.
    ///
    /// # Errors
    /// [`MeshError::TooLarge`] if a [`PatchId`] has no room for so many levels.
    pub(super) fn cut_by_leaves(self, topology: &Topology, plan: &Plan, pieces: &Pieces) -> Result<Self, MeshError> {
        let (whole, curves) = match self.of_half_edges.is_empty() {
            true => edges_as_curves(topology),
            false => (self.of_half_edges.clone(), self.curves),
        };
        let mut of_faces = Vec::with_capacity(pieces.faces.len());
        for cut in &pieces.faces {
            let (leaf, first) = match cut.part {
                Part::Leaf(leaf) => (leaf, 0),
                Part::OfLeaf(leaf, LeafPart { edge, .. }) => (leaf, edge),
                Part::Whole | Part::Wedge(_) => continue,
            };
            let leaf = &plan.leaves[leaf as usize];
            let root = match plan.roots[leaf.root as usize].level {
                0 => self.of_face(leaf.face),
                _ => PatchId::of_part(self.of_face(leaf.face).face() + leaf.part),
            };
            let steps = leaf.level - plan.roots[leaf.root as usize].level;
            if root.level() + steps > MAX_LEVEL {
                let (count, max) = ((root.level() + steps) as usize, MAX_LEVEL as usize);
                return Err(MeshError::TooLarge { what: "levels of refinement", count, max });
            }
            of_faces.push(root.cell(steps, [leaf.u, leaf.v], first, leaf.transition));
        }
        // The curve of an edge within a face begins there.
        let edges = &*pieces.topology;
        let (numbers, count) = number_edges(edges);
        let of_half_edge = |(h, line): (u32, &Line)| match *line {
            Line::Edge(of, ends) => whole[of as usize].part(ends, 2 * SIDE),
            Line::Inner => OnCurve {
                part: CurvePart { curve: curves + numbers[h as usize], level: 0, index: 0 },
                reversed: edges.twin(h).is_some_and(|twin| twin < h),
            },
        };
        let of_half_edges = (0..).zip(&pieces.lines).map(of_half_edge).collect();
        Ok(Self { of_faces, of_half_edges, curves: curves + count, ..self })
    }

    /// Where the vertices of the prepared mesh start among those that shaders read: after the control vertices where it is
    /// refined, else they are these.
    pub(super) fn first_vertex(&self) -> u32 {
        if self.is_refined { self.control_vertices } else { 0 }
    }

    /// The parts of the caller's faces.
    pub(super) fn parts(&self) -> &Parts {
        &self.parts
    }

    /// The cell that a face of the prepared mesh is, as a patch of it would have it.
    pub(super) fn of_face(&self, face: u32) -> PatchId {
        self.of_faces.get(face as usize).copied().unwrap_or_else(|| PatchId::whole(self.parts.first(face)))
    }

    /// The part of a curve that a half-edge lies on; `edge` is the number of its edge.
    pub(super) fn of_half_edge(&self, half_edge: u32, edge: u32) -> CurvePart {
        let whole = CurvePart { curve: edge, level: 0, index: 0 };
        self.of_half_edges.get(half_edge as usize).map_or(whole, |on_curve| on_curve.part)
    }
}

/// The edge of each half-edge, counted by lower half-edges, and the number of edges.
pub(super) fn number_edges(topology: &Topology) -> (Vec<u32>, u32) {
    let (mut edges, mut count) = (vec![0; topology.mesh().corner_count()], 0);
    for h in 0..edges.len() as u32 {
        edges[h as usize] = match topology.twin(h) {
            Some(twin) if twin < h => edges[twin as usize],
            _ => {
                count += 1;
                count - 1
            }
        };
    }
    (edges, count)
}

fn edges_as_curves(topology: &Topology) -> (Vec<OnCurve>, u32) {
    let (edges, count) = number_edges(topology);
    let of_half_edge = |(&curve, h): (&u32, u32)| OnCurve {
        part: CurvePart { curve, level: 0, index: 0 },
        reversed: topology.twin(h).is_some_and(|twin| twin < h),
    };
    (edges.iter().zip(0..).map(of_half_edge).collect(), count)
}
