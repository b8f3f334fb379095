//! The surfaces that are compared: the patches of schemes, the limit surface, and where both are asked at.

use crate::limit::{LimitSample, LimitSurface};
use crate::mesh::MeshError;
use crate::patch::Sample;
use crate::table::{CpuSurface, Patch, Prepared, in_wedge};
use crate::topology::{PatchKind, Topology, draws_face};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Patches measured with one limit surface, which remembers what it has refined: about 0.1 MB an irregular face.
const CHUNK: usize = 4096;

/// A face that is drawn as one patch, or a piece of one.
#[derive(Debug, Clone)]
pub(super) struct Face {
    /// As [`LimitSurface`] counts.
    pub face: u32,
    pub kind: PatchKind,
    /// Of a piece: the corner from which its edge starts, and how many corners the face has.
    piece: Option<[i32; 2]>,
    /// The parts that are measured, by the `sub` of the limit surface. A wedge is measured as all of the part around its corner, half
    /// of which the wedge before has.
    pub parts: Range<i32>,
}

impl Face {
    fn new(prepared: &Prepared, face: u32, kind: PatchKind) -> Self {
        let (face, corner) = prepared.whole_face(face);
        let piece = corner.map(|corner| [corner as i32, prepared.whole().mesh().face(face).len() as i32]);
        let parts = match (piece, kind) {
            (Some([corner, _]), _) => corner..corner + 1,
            (None, PatchKind::Triangle) => 0..3,
            _ => -1..0,
        };
        Self { face, kind, piece, parts }
    }

    pub(super) fn of(prepared: &Prepared, patch: &Patch) -> Self {
        let face = Self::new(prepared, patch.face, patch.kind);
        let pentagon = (patch.kind == PatchKind::Pentagon).then(|| [patch.first() as i32, 5]);
        Self { piece: face.piece.or(pentagon), ..face }
    }

    /// Those that are drawn, in order.
    pub(super) fn all(prepared: &Prepared) -> Vec<Self> {
        let topology = prepared.topology();
        let faces = (0..).zip(draws_face(topology)).filter(|(_, draws)| *draws);
        // The prepared mesh has no larger faces than these.
        faces.filter_map(|(face, _)| Some(Self::new(prepared, face, topology.patch_kind(face)?))).collect()
    }

    /// Where a point is that is given by the parameters of its patch.
    pub(super) fn parameters(&self, [u, v]: [f64; 2]) -> Parameters {
        match (self.piece, self.kind) {
            (Some([corner, size]), _) => {
                let (is_next, u, v) = in_wedge(u, v);
                Parameters { sub: if is_next { (corner + 1) % size } else { corner }, u, v }
            }
            (None, PatchKind::Triangle) => Parameters::of_triangle([u, v]),
            _ => Parameters { sub: -1, u, v },
        }
    }
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
    /// Of the faces that the limit surface has.
    pub topology: &'s Arc<Topology>,
    /// Those that are drawn.
    pub faces: Vec<Face>,
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
        if patches[face].is_wedge() {
            return surface.evaluate_root(patches[face], points, at.u, at.v);
        }
        let [u, v] = at.of_patch();
        surface.evaluate(patches[face], points, u, v)
    }

    pub(super) fn limit(&self, limit: &LimitSurface, face: usize, at: Parameters) -> LimitSample {
        limit.evaluate(self.faces[face].face, at.sub, at.u, at.v)
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

    /// The other way: where the point of a triangle is.
    fn of_triangle([u, v]: [f64; 2]) -> Self {
        let corners = [u, v, 1.0 - u - v];
        let nearest = (1..3).fold(0, |best, k| if corners[k] > corners[best] { k } else { best });
        let (to_next, to_previous) = (corners[(nearest + 1) % 3], corners[(nearest + 2) % 3]);
        // With d = u - v = 2 (to_next - to_previous): v^2 + (d - 3) v + 6 to_previous = 0.
        let d = 2.0 * (to_next - to_previous);
        let v = (3.0 - d - ((3.0 - d).powi(2) - 24.0 * to_previous).max(0.0).sqrt()) / 2.0;
        Self { sub: nearest as i32, u: (v + d).clamp(0.0, 1.0), v: v.clamp(0.0, 1.0) }
    }
}

/// Between unit vectors, in radians; `None` if one is zero.
pub(super) fn angle(a: DVec3, b: DVec3) -> Option<f64> {
    (a != DVec3::ZERO && b != DVec3::ZERO).then(|| a.cross(b).length().atan2(a.dot(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_triangles_are_found_in_their_parts() {
        for (sub, i, j) in (0..3).flat_map(|sub| (0..8).flat_map(move |i| (0..8).map(move |j| (sub, i, j)))) {
            let at = Parameters { sub, u: f64::from(i) / 8.0, v: f64::from(j) / 8.0 };
            let back = Parameters::of_triangle(at.of_patch());
            assert_eq!(back.sub, sub);
            assert!((back.u - at.u).abs().max((back.v - at.v).abs()) < 1e-12, "{at:?} {back:?}");
        }
    }
}
