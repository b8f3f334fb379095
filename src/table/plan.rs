//! Which faces become which patches, in the order in which they are stored and drawn.

use crate::patch::{Blend, Fallback, FallbackRings, Scheme, Undefined};
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
    /// The scheme that draws it: the one asked for, or the one fallen back to.
    pub scheme: Scheme,
}

impl Patch {
    /// The control points, as [`Scheme::control_points_beside`] makes them.
    pub fn control_points<T: Blend>(
        self,
        topology: &Topology,
        fallback: &FallbackRings,
        vertex: impl Fn(u32) -> T,
    ) -> Vec<T> {
        self.scheme.control_points_beside(topology, self.face, self.kind, fallback, vertex)
    }

    /// What patches are sorted by.
    pub(crate) fn group(self) -> (PatchKind, Scheme) {
        (self.kind, self.scheme)
    }
}

/// Patches of one kind and scheme, which stand together and are drawn together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PatchGroup {
    /// The kind of all of them.
    pub kind: PatchKind,
    /// The scheme of all of them.
    pub scheme: Scheme,
    /// Where they stand among [`PatchPlan::patches`].
    pub patches: Range<usize>,
    /// The number of the first corner of the first, when the corners of all patches are counted in order.
    pub first_corner: usize,
}

/// All patches of a mesh: the regular ones, then irregular quads, then triangles; in each kind by scheme, and then in the
/// order of their faces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PatchPlan {
    patches: Vec<Patch>,
    groups: Vec<PatchGroup>,
    scheme: Scheme,
    fallback_rings: FallbackRings,
}

impl PatchPlan {
    /// Plans the patches of a mesh of triangles and quads. Holes get none.
    ///
    /// # Errors
    /// [`Undefined`] names the first face that the scheme has no patch for, unless such faces fall back.
    pub fn new(topology: &Topology, scheme: Scheme, fallback: Fallback) -> Result<Self, Undefined> {
        let of_face = |(face, draws): (usize, bool)| {
            let (face, kind) = (face as u32, topology.patch_kind(face as u32).filter(|_| draws)?);
            let drawn_by = scheme.check(topology, face, kind).map(|()| scheme);
            let patch = |scheme| Patch { face, kind, scheme };
            Some(drawn_by.or_else(|undefined| fallback.scheme().ok_or(undefined)).map(patch))
        };
        let faces = draws_face(topology).into_par_iter().enumerate().map(of_face);
        // The first error is that of the first face: collected before it is looked for.
        let faces: Vec<Option<Result<Patch, Undefined>>> = faces.collect();
        let mut patches: Vec<Patch> = faces.into_iter().flatten().collect::<Result<_, _>>()?;
        let fallen = patches.iter().filter(|patch| patch.scheme != scheme).map(|patch| patch.face);
        let fallback_rings = FallbackRings::new(topology, fallen);
        patches.sort_by_key(|patch| patch.group());
        let mut groups = Vec::new();
        let (mut first, mut first_corner) = (0, 0);
        for same in patches.chunk_by(|a, b| a.group() == b.group()) {
            let (kind, scheme) = same[0].group();
            groups.push(PatchGroup { kind, scheme, patches: first..first + same.len(), first_corner });
            first += same.len();
            first_corner += same.len() * kind.corners();
        }
        Ok(Self { patches, groups, scheme, fallback_rings })
    }

    /// All patches, in order.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// The patches of each kind and scheme that there are, in order.
    pub fn groups(&self) -> &[PatchGroup] {
        &self.groups
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

    /// The rings around those.
    pub fn fallback_rings(&self) -> &FallbackRings {
        &self.fallback_rings
    }

    /// Puts the same patches in another order within their groups.
    pub(crate) fn reorder(&mut self, patches: Vec<Patch>) {
        debug_assert!(patches.len() == self.patches.len() && patches.is_sorted_by_key(|patch| patch.group()));
        self.patches = patches;
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
