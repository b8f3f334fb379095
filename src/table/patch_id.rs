//! The identity of a patch: which cell of which of the caller's faces it covers.

use std::fmt;

/// What a patch covers, in 64 bits, the same on the GPU: after OpenSubdiv's `PatchParam`.
///
/// A face that is refined is a quadtree over its (u, v): a *cell* of level `l` has a side of `2^-l`. Faces other than quads have
/// such a tree for each of their parts, the root of which is of level 1, as the first step of refinement makes it; at
/// level 0 they are whole.
///
/// | word | bits | |
/// |---|---|---|
/// | 0 | 0 to 27 | [`face`](PatchId::face) |
/// | 0 | 28 to 31 | [`transition`](PatchId::transition) |
/// | 1 | 0 to 9 | [`u`](PatchId::u) |
/// | 1 | 10 to 19 | [`v`](PatchId::v) |
/// | 1 | 20 to 23 | [`level`](PatchId::level) |
/// | 1 | 24 to 26 | [`first`](PatchId::first) |
/// | 1 | 27 to 30 | [`boundary`](PatchId::boundary) |
/// | 1 | 31 | [`has_crease`](PatchId::has_crease) |
#[repr(transparent)]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PatchId([u32; 2]);

/// A number in a word: its first bit and its number of bits.
#[derive(Clone, Copy)]
struct Field {
    word: usize,
    shift: u32,
    bits: u32,
}

const FACE: Field = Field { word: 0, shift: 0, bits: 28 };
const TRANSITION: Field = Field { word: 0, shift: 28, bits: 4 };
const U: Field = Field { word: 1, shift: 0, bits: 10 };
const V: Field = Field { word: 1, shift: 10, bits: 10 };
const LEVEL: Field = Field { word: 1, shift: 20, bits: 4 };
const FIRST: Field = Field { word: 1, shift: 24, bits: 3 };
const BOUNDARY: Field = Field { word: 1, shift: 27, bits: 4 };
const CREASE: Field = Field { word: 1, shift: 31, bits: 1 };

/// The deepest level of a cell.
pub(crate) const MAX_LEVEL: u32 = U.bits;
/// The most parts that faces may have.
pub(crate) const MAX_PARTS: usize = 1 << FACE.bits;

impl PatchId {
    /// A whole face: that part of it which comes first.
    pub fn whole(face: u32) -> Self {
        Self::default().with(FACE, face)
    }

    /// The first cell of a part of a face that is no quad.
    pub(super) fn of_part(part: u32) -> Self {
        Self::whole(part).with(LEVEL, 1)
    }

    /// The cell that refinement makes around a corner of this one, which begins there.
    pub(super) fn child(self, corner: u32) -> Self {
        let quadrant = (self.first() + corner) % 4;
        let [u, v] = Self::QUADRANTS[quadrant as usize];
        let place = self.with(U, 2 * self.u() + u).with(V, 2 * self.v() + v);
        place.with(LEVEL, self.level() + 1).with(FIRST, quadrant)
    }

    /// The cell `steps` levels below this one at column and row `at` of those in it, seen from this patch; the patch starts from corner
    /// `first` of the cell, and patches are finer beyond the edges with a bit in `transition`.
    pub(super) fn cell(self, steps: u32, at: [u32; 2], first: u32, transition: u32) -> Self {
        let last = (1 << steps) - 1;
        let [u, v] = (0..self.first()).fold(at, |[u, v], _| [last - v, u]);
        let place = self.with(U, (self.u() << steps) + u).with(V, (self.v() << steps) + v);
        // From the first corner on, as all that patches have for their edges.
        let turned = (transition << 4 | transition) >> first & 15;
        place.with(LEVEL, self.level() + steps).with(FIRST, (self.first() + first) % 4).with(TRANSITION, turned)
    }

    pub(super) fn with_first(self, first: u32) -> Self {
        self.with(FIRST, first)
    }

    pub(super) fn with_boundary(self, edges: u32) -> Self {
        self.with(BOUNDARY, edges)
    }

    /// The number of the face's part, among the parts of the caller's mesh.
    pub fn face(self) -> u32 {
        self.get(FACE)
    }

    /// The level of the cell.
    pub fn level(self) -> u32 {
        self.get(LEVEL)
    }

    /// The column of the cell, along u, among those of its level.
    pub fn u(self) -> u32 {
        self.get(U)
    }

    /// The row of the cell, along v.
    pub fn v(self) -> u32 {
        self.get(V)
    }

    /// The corner of the cell, or of the whole face, that is the patch's first. Corners of a cell are counted from its least
    /// (u, v), counter-clockwise. A fifth of a pentagon lies between the edge from here and the centre of the face.
    pub fn first(self) -> u32 {
        self.get(FIRST)
    }

    /// The edges along which the surface ends, or is drawn infinitely sharp: bit k is that from corner k of the patch to the next.
    pub fn boundary(self) -> u32 {
        self.get(BOUNDARY)
    }

    /// The edges beyond which patches are finer, of patches by leaves: a bit each, as in [`PatchId::boundary`].
    pub fn transition(self) -> u32 {
        self.get(TRANSITION)
    }

    /// Whether the edge of [`PatchId::boundary`] is a crease of finite sharpness that the patch itself follows. None is yet.
    pub fn has_crease(self) -> bool {
        self.get(CREASE) == 1
    }

    /// Column and row of each quadrant of a cell, by the corner of the cell in it.
    const QUADRANTS: [[u32; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];

    /// The corners around which the last `steps` steps of refinement made the cell, each a corner of the patch before it.
    fn turns(self, steps: u32) -> impl Iterator<Item = u32> {
        let quadrant = move |step: u32| {
            let [u, v] = [self.u() >> step & 1, self.v() >> step & 1];
            if v == 0 { u } else { 3 - u }
        };
        (0..steps).rev().map(move |step| {
            let before = if step + 1 == steps { 0 } else { quadrant(step + 1) };
            (quadrant(step) + 4 - before) % 4
        })
    }

    fn get(self, field: Field) -> u32 {
        self.0[field.word] >> field.shift & ((1 << field.bits) - 1)
    }

    fn with(mut self, field: Field, value: u32) -> Self {
        debug_assert!(value < 1 << field.bits, "{value} has more than {} bits", field.bits);
        let mask = ((1 << field.bits) - 1) << field.shift;
        self.0[field.word] = self.0[field.word] & !mask | value << field.shift & mask;
        self
    }
}

impl fmt::Debug for PatchId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PatchId")
            .field("face", &self.face())
            .field("level", &self.level())
            .field("u", &self.u())
            .field("v", &self.v())
            .field("first", &self.first())
            .field("boundary", &self.boundary())
            .field("transition", &self.transition())
            .field("crease", &self.has_crease())
            .finish()
    }
}

/// Where a patch comes from in the caller's mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FaceOrigin {
    /// The face of the caller's mesh.
    pub face: u32,
    /// The corner of a face that is no quad: that around which the first step of refinement made the part with this patch, or
    /// from which the edge of this wedge, or of this piece of a pentagon, starts.
    pub corner: Option<u32>,
    /// The patch's identity.
    pub id: PatchId,
}

impl FaceOrigin {
    /// The corners around which refinement made the patch, step by step, or the one from which the edge of this piece of a
    /// pentagon starts; none for a whole face.
    pub fn path(&self) -> impl Iterator<Item = u32> {
        let steps = if self.corner.is_some() { self.id.level().saturating_sub(1) } else { self.id.level() };
        self.corner.into_iter().chain(self.id.turns(steps))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_do_not_touch_each_other() {
        let fields = [FACE, TRANSITION, U, V, LEVEL, FIRST, BOUNDARY, CREASE];
        let most = |field: Field| (1u32 << field.bits) - 1;
        let mut all = PatchId::default();
        for (i, field) in fields.into_iter().enumerate() {
            let one = PatchId::default().with(field, most(field));
            for (j, other) in fields.into_iter().enumerate() {
                assert_eq!(one.get(other), if i == j { most(field) } else { 0 });
            }
            all = all.with(field, most(field));
        }
        // All 64 bits have a field.
        assert_eq!(all.0, [u32::MAX; 2]);
    }

    #[test]
    fn cells_lead_back_to_the_corners_around_which_they_were_made() {
        for path in (0..64u32).map(|path| [path / 16, path / 4 % 4, path % 4]) {
            let id = path.iter().fold(PatchId::whole(7), |id, &corner| id.child(corner));
            assert_eq!((id.face(), id.level()), (7, 3));
            // Every step turns the patch by the corner that it begins at.
            assert_eq!(id.first(), path.iter().sum::<u32>() % 4);
            assert_eq!(FaceOrigin { face: 7, corner: None, id }.path().collect::<Vec<_>>(), path);
            let part = path[1..].iter().fold(PatchId::of_part(9), |id, &corner| id.child(corner));
            assert_eq!(part.level(), 3);
            let of_part = FaceOrigin { face: 2, corner: Some(path[0]), id: part };
            assert_eq!(of_part.path().collect::<Vec<_>>(), path);
        }
        let id = PatchId::whole(0).child(1).child(0);
        assert_eq!((id.u(), id.v(), id.first()), (3, 0, 1));
    }
}
