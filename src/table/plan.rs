//! Which faces become which patches, in the order in which they are stored and drawn.

use crate::patch::{Scheme, Undefined};
use crate::topology::{PatchKind, Topology, draws_face};
use rayon::prelude::*;
use std::ops::Range;

/// A patch and the face of the prepared mesh it covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patch {
    /// The face of the prepared mesh.
    pub face: u32,
    /// What it becomes.
    pub kind: PatchKind,
}

/// All patches of a mesh: the regular ones, then irregular quads, then triangles, each in the order of their faces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PatchPlan {
    patches: Vec<Patch>,
    counts: [u32; 3],
}

impl PatchPlan {
    /// Plans the patches of a mesh of triangles and quads. Holes get none.
    pub fn new(topology: &Topology) -> Self {
        let draws = draws_face(topology);
        let kinds: Vec<Option<PatchKind>> = draws
            .par_iter()
            .enumerate()
            .map(|(face, &draws)| if draws { topology.patch_kind(face as u32) } else { None })
            .collect();
        let mut patches = Vec::with_capacity(kinds.len());
        let mut counts = [0; 3];
        for (kind, count) in PatchKind::ALL.into_iter().zip(&mut counts) {
            let before = patches.len();
            let of_kind = kinds.iter().enumerate().filter(|(_, k)| **k == Some(kind));
            patches.extend(of_kind.map(|(face, _)| Patch { face: face as u32, kind }));
            *count = (patches.len() - before) as u32;
        }
        Self { patches, counts }
    }

    /// All patches, in order.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// How many patches of a kind there are.
    pub fn count(&self, kind: PatchKind) -> u32 {
        self.counts[kind as usize]
    }

    /// Tells whether a scheme has a patch for every face.
    ///
    /// # Errors
    /// [`Undefined`] names the first face that has none.
    pub fn check(&self, topology: &Topology, scheme: Scheme) -> Result<(), Undefined> {
        let lacking = self.patches.iter().filter_map(|patch| scheme.check(topology, patch.face, patch.kind).err());
        lacking.min_by_key(|undefined| undefined.face).map_or(Ok(()), Err)
    }

    /// Puts the same patches in another order within their kinds.
    pub(crate) fn reorder(&mut self, patches: Vec<Patch>) {
        debug_assert!(patches.len() == self.patches.len() && patches.is_sorted_by_key(|p| p.kind));
        self.patches = patches;
    }

    /// Where the patches of a kind stand among [`PatchPlan::patches`].
    pub fn range(&self, kind: PatchKind) -> Range<usize> {
        let start: u32 = self.counts[..kind as usize].iter().sum();
        start as usize..(start + self.count(kind)) as usize
    }

    /// The number of the first corner of the patches of a kind, when all corners are counted in order.
    pub fn first_corner(&self, kind: PatchKind) -> u32 {
        PatchKind::ALL[..kind as usize].iter().map(|&k| self.count(k) * k.corners() as u32).sum()
    }

    /// The half-edges of all patch corners, in order: four each for quads, three for triangles.
    pub(crate) fn corners(&self, topology: &Topology) -> Vec<u32> {
        let face_offsets = topology.mesh().face_offsets();
        let corners_of = |patch: &Patch| face_offsets[patch.face as usize]..face_offsets[patch.face as usize + 1];
        let mut corners = Vec::with_capacity(4 * self.patches.len());
        self.patches.iter().for_each(|patch| corners.extend(corners_of(patch)));
        corners
    }

    /// The texture coordinates at all patch corners, in order, if the mesh has any.
    pub fn texcoords(&self, topology: &Topology) -> Option<Vec<[f32; 2]>> {
        let texcoords = topology.mesh().data().texcoords.as_ref()?;
        let corners = self.corners(topology).into_iter();
        Some(corners.map(|h| texcoords.values[texcoords.indices[h as usize] as usize]).collect())
    }
}
