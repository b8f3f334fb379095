//! Which faces become which patches, in the order in which they are stored and drawn.

use super::cells::{Cells, Parts};
use super::patch_id::{FaceOrigin, PatchId};
use crate::blend::Blend;
use crate::patch::{Fallback, FallbackRings, Scheme, Undefined};
use crate::topology::{PatchKind, Topology, draws_face};
use rayon::prelude::*;
use std::ops::Range;

/// A patch and the face of the prepared mesh that it covers, whole or in part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patch {
    /// The face of the prepared mesh.
    pub face: u32,
    /// What it becomes.
    pub kind: PatchKind,
    /// The scheme that draws it: the one asked for, or the one fallen back to.
    pub scheme: Scheme,
    /// Whether it is drawn by its leaves ([`adaptive`](crate::adaptive)). A triangle is then a wedge: that between an edge of a face
    /// other than a quad and the centre of the face.
    pub refined: bool,
    /// What it covers of the caller's mesh.
    pub id: PatchId,
}

impl Patch {
    /// The control points, as [`Scheme::control_points_beside`] makes them.
    pub fn control_points<T: Blend>(
        self,
        topology: &Topology,
        fallback: &FallbackRings,
        vertex: impl Fn(u32) -> T,
    ) -> Vec<T> {
        self.scheme.control_points_beside(topology, self.kind, self.corners(topology), fallback, vertex)
    }

    /// The half-edges of its corners, in order.
    pub(crate) fn corners(self, topology: &Topology) -> impl Iterator<Item = u32> + Clone {
        let face = topology.mesh().face_corners(self.face);
        let (start, end) = (face.start as u32, face.end as u32);
        (start + self.first()..end).chain(start..start + self.first())
    }

    /// The corner of the face that is the patch's first: 0 but for the pieces of a pentagon, of which piece k lies between
    /// the edge from corner k and the centre of the face.
    pub fn first(self) -> u32 {
        if self.kind == PatchKind::Pentagon { self.id.first() } else { 0 }
    }

    /// Whether it is the triangle between an edge of a face other than a quad and the centre of the face.
    pub fn is_wedge(&self) -> bool {
        self.refined && self.kind == PatchKind::Triangle
    }

    /// The edges along which the surface ends or is drawn sharp: see [`PatchId::boundary`].
    fn boundary(self, topology: &Topology) -> u32 {
        let edges = if self.kind == PatchKind::Pentagon { 1 } else { self.kind.corners() };
        let ends = |h: u32| topology.twin(h).is_none() || topology.is_sharp(h);
        self.corners(topology).take(edges).zip(0..).map(|(h, k)| u32::from(ends(h)) << k).sum()
    }

    /// What patches are sorted by.
    pub(crate) fn group(self) -> (PatchKind, Scheme, bool) {
        (self.kind, self.scheme, self.refined)
    }
}

/// Patches of one kind and scheme, all refined or none, which stand together and are drawn together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PatchGroup {
    /// The kind of all of them.
    pub kind: PatchKind,
    /// The scheme of all of them.
    pub scheme: Scheme,
    /// Whether all of them are drawn by their leaves: [`Patch::refined`].
    pub refined: bool,
    /// Where they stand among [`PatchPlan::patches`].
    pub patches: Range<usize>,
    /// The number of the first corner of the first, when the corners of all patches are counted in order.
    pub first_corner: usize,
}

/// All patches of a mesh: the regular ones, then irregular quads, triangles, pieces of pentagons; in each kind by scheme, those that
/// are refined last, and then in the order of their faces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PatchPlan {
    patches: Vec<Patch>,
    groups: Vec<PatchGroup>,
    scheme: Scheme,
    fallback_rings: FallbackRings,
    /// The parts of the caller's faces.
    parts: Parts,
    /// Where the vertices of the prepared mesh start among those that shaders read.
    first_vertex: u32,
}

impl PatchPlan {
    /// Plans the patches of a mesh. Holes get none; regular faces that are refined are as irregular ones.
    ///
    /// # Errors
    /// [`Undefined`] names the first face that the scheme has no patch for, unless such faces fall back; then the first that
    /// there is no patch for at all, which has five or more corners: see [`prepare`](super::prepare()).
    pub(super) fn new(
        topology: &Topology,
        cells: &Cells,
        scheme: Scheme,
        fallback: Fallback,
        is_refined: impl Fn(u32) -> bool + Sync,
    ) -> Result<Self, Undefined> {
        let of_face = |face: u32| {
            let (kind, scheme) = match (scheme.check(topology, face), fallback.scheme()) {
                (Err(_), Some(fallback)) => (fallback.check(topology, face)?, fallback),
                (kind, _) => (kind?, scheme),
            };
            let refined = is_refined(face);
            // Of a face that is refined, what the corners of irregular ones have.
            let kind = if kind == PatchKind::Regular && refined { PatchKind::IrregularQuad } else { kind };
            Ok(Patch { face, kind, scheme, refined, id: cells.of_face(face) })
        };
        let faces = draws_face(topology).into_par_iter().enumerate();
        let faces = faces.map(|(face, draws)| draws.then(|| of_face(face as u32)));
        // The first error is that of the first face: collected before it is looked for.
        let faces: Vec<Option<Result<Patch, Undefined>>> = faces.collect();
        let pieces = |patch: Patch| {
            let piece =
                move |first| if patch.kind == PatchKind::Pentagon { patch.id.with_first(first) } else { patch.id };
            let patches = (0..patch.kind.pieces()).map(move |first| Patch { id: piece(first), ..patch });
            patches.map(|patch| Patch { id: patch.id.with_boundary(patch.boundary(topology)), ..patch })
        };
        let faces: Vec<Patch> = faces.into_iter().flatten().collect::<Result<_, _>>()?;
        let mut patches: Vec<Patch> = faces.into_iter().flat_map(pieces).collect();
        // Around regular patches, too, ACC patches take the frame's points along the edges. They are the same, but so to the last
        // bit: both sides of an edge ask for the same factor.
        let is_beside =
            |patch: &&Patch| patch.scheme != scheme || scheme == Scheme::Acc && patch.kind == PatchKind::Regular;
        let fallback_rings = FallbackRings::new(topology, patches.iter().filter(is_beside).map(|patch| patch.face));
        patches.sort_by_key(|patch| patch.group());
        let mut groups = Vec::new();
        let (mut first, mut first_corner) = (0, 0);
        for same in patches.chunk_by(|a, b| a.group() == b.group()) {
            let (kind, scheme, refined) = same[0].group();
            groups.push(PatchGroup { kind, scheme, refined, patches: first..first + same.len(), first_corner });
            first += same.len();
            first_corner += same.len() * kind.corners();
        }
        Ok(Self {
            patches,
            groups,
            scheme,
            fallback_rings,
            parts: cells.parts().clone(),
            first_vertex: cells.first_vertex(),
        })
    }

    /// All patches, in order.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// The patches of each group that there are, in order.
    pub fn groups(&self) -> &[PatchGroup] {
        &self.groups
    }

    /// The number, among the vertices that shaders read, of a vertex of the prepared mesh: control vertices come first, refined
    /// ones after them.
    pub(super) fn vertex(&self, mesh_vertex: u32) -> u32 {
        self.first_vertex + mesh_vertex
    }

    /// Where a patch comes from in the caller's mesh.
    pub fn origin(&self, patch: &Patch) -> FaceOrigin {
        self.parts.origin(patch)
    }

    /// Where each patch comes from, in order.
    pub fn origins(&self) -> Vec<FaceOrigin> {
        self.patches.iter().map(|patch| self.origin(patch)).collect()
    }

    /// How many corners all patches have together.
    pub fn corner_count(&self) -> usize {
        self.groups.last().map_or(0, |group| group.first_corner + group.patches.len() * group.kind.corners())
    }

    /// How many patches of a kind there are.
    pub fn count(&self, kind: PatchKind) -> u32 {
        self.range(kind).len() as u32
    }

    /// Where the patches of a kind stand among [`PatchPlan::patches`].
    pub fn range(&self, kind: PatchKind) -> Range<usize> {
        let start = self.patches.partition_point(|patch| patch.kind < kind);
        start..self.patches.partition_point(|patch| patch.kind <= kind)
    }

    /// The scheme that was asked for.
    pub fn scheme(&self) -> Scheme {
        self.scheme
    }

    /// The patches that another scheme draws than the one asked for.
    pub fn fallen_back(&self) -> impl Iterator<Item = &Patch> {
        self.patches.iter().filter(|patch| patch.scheme != self.scheme)
    }

    /// The rings around those; with ACC also around regular patches.
    pub fn fallback_rings(&self) -> &FallbackRings {
        &self.fallback_rings
    }

    /// Puts the same patches in another order within their groups.
    pub(crate) fn reorder(&mut self, patches: Vec<Patch>) {
        debug_assert!(patches.len() == self.patches.len() && patches.is_sorted_by_key(|patch| patch.group()));
        self.patches = patches;
    }

    /// The half-edges of all patch corners, in order.
    pub(crate) fn corners(&self, topology: &Topology) -> Vec<u32> {
        let mut corners = Vec::with_capacity(4 * self.patches.len());
        self.patches.iter().for_each(|patch| corners.extend(patch.corners(topology)));
        corners
    }

    /// The texture coordinates at all patch corners, in order, if the mesh has any.
    pub fn texcoords(&self, topology: &Topology) -> Option<Vec<[f32; 2]>> {
        let texcoords = topology.mesh().data().texcoords.as_ref()?;
        let corners = self.corners(topology).into_iter();
        Some(corners.map(|h| texcoords.values[texcoords.indices[h as usize] as usize]).collect())
    }
}
