//! Subjects: a mesh, or some of its patches.

use super::BenchError;
use crate::mesh::{ControlMesh, MeshData};
use crate::named::named;
use crate::patch::{Fallback, Scheme};
use crate::table::{TableError, prepare};
use crate::topology::PatchKind;

named! {
    /// Which patches of a mesh are drawn.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[non_exhaustive]
    pub enum Subset {
        /// All of them.
        #[default]
        All = "all",
        /// Regular quads.
        Regular = "regular",
        /// Irregular quads and triangles.
        Irregular = "irregular",
    }
}

impl Subset {
    fn has(self, kind: PatchKind) -> bool {
        match self {
            Self::All => true,
            Self::Regular => kind == PatchKind::Regular,
            Self::Irregular => kind != PatchKind::Regular,
        }
    }
}

/// A mesh to be drawn, by name.
#[derive(Debug, Clone)]
pub struct Subject {
    /// Name of the mesh.
    pub name: String,
    /// The control mesh; faces that are not drawn are holes.
    pub mesh: ControlMesh,
    /// Steps of refinement before patches are made.
    pub refine: u32,
    counts: [u32; PatchKind::ALL.len()],
}

impl Subject {
    /// A mesh, refined at least `refine` times, of which a subset of the patches is drawn. With faces of five and more corners it is
    /// refined once at least, for all schemes to draw the same faces.
    ///
    /// # Errors
    /// [`BenchError::NoPatches`] if the subset has no patches; a refined mesh that cannot be addressed.
    pub fn new(name: &str, mesh: ControlMesh, refine: u32, subset: Subset) -> Result<Self, BenchError> {
        let polygons = mesh.data().face_sizes.iter().any(|&size| size > 4);
        let refine = if polygons { refine.max(1) } else { refine };
        let prepared = prepare(&mesh, refine)?;
        let plan = prepared.plan(Scheme::Gregory, Fallback::Refuse).map_err(TableError::from)?;
        let counts = PatchKind::ALL.map(|kind| if subset.has(kind) { plan.count(kind) } else { 0 });
        if counts == [0; PatchKind::ALL.len()] {
            return Err(BenchError::NoPatches { mesh: name.to_owned(), subset: subset.name() });
        }
        let name = name.to_owned();
        if subset == Subset::All {
            return Ok(Self { name, mesh, refine, counts });
        }
        // The faces of a refined mesh become holes, not those of the control mesh.
        let holes = plan.patches().iter().filter(|patch| !subset.has(patch.kind)).map(|patch| patch.face);
        let data = prepared.mesh().data();
        let holes = data.holes.iter().copied().chain(holes).collect();
        let mesh = ControlMesh::new(MeshData { holes, ..data.clone() })?;
        Ok(Self { name, mesh, refine: 0, counts })
    }

    /// Patches of a kind that are drawn.
    pub fn patch_count(&self, kind: PatchKind) -> u32 {
        self.counts[kind as usize]
    }

    /// Patches that are drawn.
    pub fn patches(&self) -> u64 {
        self.counts.iter().map(|&count| u64::from(count)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape;

    #[test]
    fn subsets_are_drawn_alone_and_look_the_same() {
        let of = |subset| Subject::new("creature-mixed", shape("creature-mixed").unwrap(), 0, subset).unwrap();
        let [all, regular, irregular] = Subset::ALL.map(of);
        assert_eq!(all.patches(), regular.patches() + irregular.patches());
        assert_eq!(regular.patches(), u64::from(all.patch_count(PatchKind::Regular)));
        assert!(irregular.patch_count(PatchKind::Triangle) > 0 && irregular.patch_count(PatchKind::Regular) == 0);
        for subject in [&regular, &irregular] {
            let plan = prepare(&subject.mesh, 0).unwrap().plan(Scheme::Gregory, Fallback::Refuse).unwrap();
            assert_eq!(PatchKind::ALL.map(|kind| plan.count(kind)), subject.counts);
        }
    }

    #[test]
    fn polygons_are_refined_before_patches_are_left_out() {
        let subject = Subject::new("polygons", shape("polygons").unwrap(), 0, Subset::Irregular).unwrap();
        assert!(subject.mesh.data().face_sizes.iter().all(|&size| size == 4));
        let error = Subject::new("torus", shape("torus").unwrap(), 0, Subset::Irregular).unwrap_err();
        assert_eq!(error.to_string(), "torus: it has no irregular patches: choose others");
    }
}
