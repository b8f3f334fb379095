//! The surfaces that are compared: the patches of schemes, the limit surface, and where both are asked at.

use crate::limit::{LimitSample, LimitSurface};
use crate::mesh::MeshError;
use crate::patch::Sample;
use crate::table::{CpuSurface, Patch};
use crate::topology::{PatchKind, Topology, draws_face};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;

/// Patches measured with one limit surface, which remembers what it has refined: about 0.1 MB an irregular face.
const CHUNK: usize = 4096;

pub(super) fn drawn_faces(topology: &Topology) -> Vec<(u32, PatchKind)> {
    let faces = (0..).zip(draws_face(topology)).filter(|(_, draws)| *draws);
    // The prepared mesh has no larger faces than these.
    faces.filter_map(|(face, _)| Some((face, topology.patch_kind(face)?))).collect()
}

/// The patches of a scheme.
pub(super) struct SchemePatches<'p> {
    surface: &'p CpuSurface,
    /// What control points are made of.
    vertices: Vec<DVec3>,
    /// Patches in the order of their faces.
    patches: Vec<Patch>,
}

impl<'p> SchemePatches<'p> {
    pub(super) fn new(surface: &'p CpuSurface) -> Self {
        let mut patches = surface.plan().patches().to_vec();
        patches.sort_unstable_by_key(|patch| patch.face);
        Self { surface, vertices: surface.vertices(|p| p), patches }
    }
}

/// The patches of all schemes that have them, and the surface they approximate.
pub(super) struct Surfaces<'s> {
    pub topology: &'s Arc<Topology>,
    /// Faces that are drawn, and the patches they become.
    pub faces: Vec<(u32, PatchKind)>,
    pub schemes: Vec<SchemePatches<'s>>,
}

impl Surfaces<'_> {
    /// Does something for each of the faces, in parallel.
    pub(super) fn for_each<R: Send>(
        &self,
        work: impl Fn(&LimitSurface, usize) -> R + Sync,
    ) -> Result<Vec<R>, MeshError> {
        let mut results = Vec::with_capacity(self.faces.len());
        for start in (0..self.faces.len()).step_by(CHUNK) {
            let limit = LimitSurface::over(self.topology)?;
            let chunk = start..(start + CHUNK).min(self.faces.len());
            results.par_extend(chunk.into_par_iter().map(|face| work(&limit, face)));
        }
        Ok(results)
    }

    /// Control points of one of the schemes over one of the faces.
    pub(super) fn control_points(&self, scheme: usize, face: usize) -> Vec<DVec3> {
        let SchemePatches { surface, vertices, patches } = &self.schemes[scheme];
        surface.points_of(patches[face], vertices)
    }

    /// The patch at parameters of a part of the limit surface.
    pub(super) fn evaluate(&self, scheme: usize, face: usize, points: &[DVec3], at: Parameters) -> Sample<DVec3> {
        let SchemePatches { surface, patches, .. } = &self.schemes[scheme];
        let [u, v] = at.of_patch();
        surface.evaluate(patches[face], points, u, v)
    }

    pub(super) fn limit(&self, limit: &LimitSurface, face: usize, at: Parameters) -> LimitSample {
        limit.evaluate(self.faces[face].0, at.sub, at.u, at.v)
    }
}

/// Where on a face, as [`LimitSurface`] counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Parameters {
    pub sub: i32,
    pub u: f64,
    pub v: f64,
}

impl Parameters {
    /// Parameters of the patch over the face: (u, v) of a quad, the first two barycentric coordinates of a triangle.
    fn of_patch(self) -> [f64; 2] {
        let Self { sub, u, v } = self;
        if sub < 0 {
            return [u, v];
        }
        // Of corner k, of those after and before it; their sum is 1.
        let centre = u * v / 3.0;
        let (to_next, to_previous) = (0.5 * u * (1.0 - v) + centre, 0.5 * (1.0 - u) * v + centre);
        let here = 1.0 - to_next - to_previous;
        match sub {
            0 => [here, to_next],
            1 => [to_previous, here],
            _ => [to_next, to_previous],
        }
    }

    /// The other way: where the point of a patch is.
    pub(super) fn of_point(patch: Patch, [u, v]: [f64; 2]) -> Self {
        match patch.kind {
            PatchKind::Regular | PatchKind::IrregularQuad => return Self { sub: -1, u, v },
            PatchKind::Pentagon => {
                // A piece is half of the parts at either end of its edge.
                let (here, next) = (patch.first() as i32, (patch.first() as i32 + 1) % 5);
                let centre = 1.0 - u - v;
                return match u >= v {
                    true => Self { sub: here, u: 2.0 * v + centre, v: centre },
                    false => Self { sub: next, u: centre, v: 2.0 * u + centre },
                };
            }
            PatchKind::Triangle => {}
        }
        let corners = [u, v, 1.0 - u - v];
        let nearest = (1..3).fold(0, |best, k| if corners[k] > corners[best] { k } else { best });
        let (to_next, to_previous) = (corners[(nearest + 1) % 3], corners[(nearest + 2) % 3]);
        // With d = u - v = 2 (to_next - to_previous): v^2 + (d - 3) v + 6 to_previous = 0.
        let d = 2.0 * (to_next - to_previous);
        let v = (3.0 - d - ((3.0 - d).powi(2) - 24.0 * to_previous).max(0.0).sqrt()) / 2.0;
        Self { sub: nearest as i32, u: (v + d).clamp(0.0, 1.0), v: v.clamp(0.0, 1.0) }
    }
}

/// The parts of a patch, by the `sub` of the limit surface.
pub(super) fn parts(kind: PatchKind) -> std::ops::Range<i32> {
    if kind == PatchKind::Triangle { 0..3 } else { -1..0 }
}

/// Between unit vectors, in radians; `None` if one is zero.
pub(super) fn angle(a: DVec3, b: DVec3) -> Option<f64> {
    (a != DVec3::ZERO && b != DVec3::ZERO).then(|| a.cross(b).length().atan2(a.dot(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scheme;
    use crate::table::PatchId;

    #[test]
    fn points_of_triangles_are_found_in_their_parts() {
        for (sub, i, j) in (0..3).flat_map(|sub| (0..8).flat_map(move |i| (0..8).map(move |j| (sub, i, j)))) {
            let at = Parameters { sub, u: f64::from(i) / 8.0, v: f64::from(j) / 8.0 };
            let patch = Patch { face: 0, kind: PatchKind::Triangle, scheme: Scheme::Gregory, id: PatchId::whole(0) };
            let back = Parameters::of_point(patch, at.of_patch());
            assert_eq!(back.sub, sub);
            assert!((back.u - at.u).abs().max((back.v - at.v).abs()) < 1e-12, "{at:?} {back:?}");
        }
    }
}
