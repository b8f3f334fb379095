//! How far schemes are from the limit surface.

use super::nearest::{self, Nearest};
use super::sums::Sums;
use crate::limit::{LimitSample, LimitSurface};
use crate::mesh::{ControlMesh, MeshError};
use crate::patch::{Fallback, Sample, Scheme, Undefined};
use crate::table::{Patch, PatchPlan, prepare};
use crate::topology::{PatchKind, Topology, draws_face};
use glam::DVec3;
use rayon::prelude::*;

/// Patches measured with one limit surface, which remembers what it has refined: about 0.1 MB an irregular face.
const CHUNK: usize = 4096;

/// How to measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ErrorOptions {
    /// What becomes of faces that a scheme has no patches for.
    pub fallback: Fallback,
    /// Steps of refinement before patches are made, at least.
    pub refine: u32,
    /// Samples along each side of a quad, and of each of the three parts of a triangle; at least 1.
    pub samples: u32,
    /// Samples of each surface for the nearest distance, over the whole mesh; none is measured if 0.
    pub nearest: u32,
}

impl Default for ErrorOptions {
    /// Nothing falls back or is refined; 33 by 33 samples a patch, 60 000 for the nearest distance.
    fn default() -> Self {
        Self { fallback: Fallback::Refuse, refine: 0, samples: 33, nearest: 60_000 }
    }
}

/// Size of a deviation over many samples. All are zero if there are no samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviation {
    /// Root mean square, every sample weighted by the area of the limit surface that it stands for.
    pub rms: f64,
    /// Root mean square over the samples as they are.
    pub rms_per_sample: f64,
    /// The largest.
    pub max: f64,
}

/// How far some faces of a scheme are from the limit surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FaceErrors {
    /// Distance of the points with the same parameters, over the diagonal of the control mesh.
    pub position: Deviation,
    /// Distance to the nearest point of the other surface, both ways together, over the diagonal of the control mesh.
    /// `None` if not asked for.
    pub nearest: Option<Deviation>,
    /// Angle between the normals at the same parameters, in radians. Samples where either surface has none are left out.
    pub normal: Deviation,
}

/// How far the patches of a scheme are from the limit surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SchemeError {
    /// Over all faces.
    pub all: FaceErrors,
    /// Over irregular quads and triangles; `None` if there are none.
    pub irregular: Option<FaceErrors>,
    /// How many faces the scheme has no patches for, so that they were measured with those of the fallback.
    pub fallen_back: usize,
}

/// What [`surface_errors`] found.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorReport {
    /// Length of the diagonal of the control mesh's bounding box: the unit of distances here, in the mesh's own.
    pub diagonal: f64,
    /// Area of the limit surface that was measured, in the mesh's own units.
    pub area: f64,
    /// How many patches there are.
    pub patches: usize,
    /// How many of them are irregular quads or triangles.
    pub irregular_patches: usize,
    /// The nearest distance of the limit surface from itself, over the diagonal of the control mesh: what comes of
    /// measuring against triangles. `None` if not asked for.
    pub nearest_floor: Option<Deviation>,
    /// In the order in which they were asked for; those without patches on this mesh say why.
    pub schemes: Vec<(Scheme, Result<SchemeError, Undefined>)>,
}

/// Measures how far schemes are from the Catmull-Clark limit surface of a mesh.
///
/// **Samples.** Each patch is evaluated at the middles of `samples` by `samples` cells of equal size in u and v. A
/// triangle has three such lattices, one for each part of the limit surface over it
/// ([`LimitSurface`]); (u, v) of the part around corner k is taken to be the point of the triangle that is bilinear
/// between corner k, the middles of its edges and the centre. That is a convention: other ways to lay the parameters of
/// a triangle over those of the limit surface give other distances, and slightly other angles. Where the mesh is refined
/// before patches are made, samples are those of the refined faces. A mesh with faces of five or more corners is refined
/// once for every scheme, [`Scheme::Pm`] too, so that all are measured on the same faces.
///
/// **Nearest distance.** As many points of both surfaces, spread evenly over the area, each against the other surface
/// as a mesh of triangles (about two million, at least 32 a patch, at most 2048). Chords of such a mesh are off the
/// surface by an eighth of their length squared over the radius of curvature: no smaller distance is to be trusted, and
/// that of a scheme that is exact is not zero ([`ErrorReport::nearest_floor`]). Where the normals differ by more than 1.2 rad the point has found the
/// other side of something thin, and is left out.
///
/// **Maxima of normals.** Where the limit surface itself folds over in a cusp, its normal swings by up to a half turn
/// within a few thousandths of u and v, and a patch that swings a little earlier or later differs by as much. That is
/// what the largest angles on OpenSubdiv's bigguy are (2.7 rad for Gregory patches, 3.0 for Pm, 1.1 for ACC): all at one
/// spot of one face (number 1050), where the limit surface has `du` within 0.03 rad of `dv`, a 250th of the area element
/// at the centre of the face, and a normal that turns by 3.0 rad over the face. At 65 by 65 samples a patch 2 of six
/// million are above 1 rad there (Pm: 9, ACC: 3), and no other face has more than 0.23 rad (ACC: 0.66). The distance
/// there is nothing special, and no normal is undefined. Root mean squares weighted by area hardly notice such spots.
///
/// The result is the same on any number of threads.
///
/// ```
/// use ash_subdiv::measure::{ErrorOptions, surface_errors};
/// use ash_subdiv::{Scheme, shape};
/// let options = ErrorOptions { samples: 5, nearest: 0, ..ErrorOptions::default() };
/// let report = surface_errors(&shape("torus")?, &[Scheme::Gregory], &options)?;
/// let error = report.schemes[0].1.as_ref().expect("Gregory patches are defined everywhere");
/// assert!(error.all.position.max < 1e-12 && error.irregular.is_none());
/// # Ok::<(), ash_subdiv::MeshError>(())
/// ```
///
/// # Errors
/// A refined mesh that cannot be addressed; coordinates beyond those of [`LimitSurface::new`].
///
/// # Panics
/// If `options.samples` is 0.
pub fn surface_errors(
    mesh: &ControlMesh,
    schemes: &[Scheme],
    options: &ErrorOptions,
) -> Result<ErrorReport, MeshError> {
    assert!(options.samples > 0, "at least one sample along a side");
    let [low, high] = mesh.bounds();
    let diagonal = low.distance(high);
    let prepared = prepare(mesh, options.refine)?;
    let topology = Topology::new(&prepared.mesh);
    let plan = |scheme: &Scheme| (*scheme, PatchPlan::new(&topology, *scheme, options.fallback));
    let plans: Vec<_> = schemes.iter().map(plan).collect();
    let defined = plans.iter().filter_map(|(_, plan)| plan.as_ref().ok());
    let surfaces = Surfaces {
        mesh: &prepared.mesh,
        topology: &topology,
        faces: drawn_faces(&topology),
        schemes: defined.map(SchemePatches::new).collect(),
    };

    // All distances are over the diagonal. A mesh without extent is as good as its patches, which are the same point.
    let scale = if diagonal > 0.0 { diagonal.recip() } else { 0.0 };
    let measured = surfaces.for_each(|limit, face| measure_face(&surfaces, limit, face, options.samples))?;
    let areas: Vec<f64> = measured.iter().map(|face| face.area).collect();
    let near = match options.nearest {
        0 => None,
        samples => Some(nearest::measure(&surfaces, &areas, samples)?),
    };
    let errors = |number: usize, only_irregular: bool| {
        let (mut position, mut normal, mut nearest) = (Sums::default(), Sums::default(), Sums::default());
        for (i, &(_, kind)) in surfaces.faces.iter().enumerate() {
            if only_irregular && kind == PatchKind::Regular {
                continue;
            }
            position.merge(&measured[i].schemes[number].position);
            normal.merge(&measured[i].schemes[number].normal);
            if let Some(near) = &near {
                nearest.merge(&near.distances[number][i]);
            }
        }
        FaceErrors {
            position: position.deviation().scaled(scale),
            nearest: near.as_ref().map(|_: &Nearest| nearest.deviation().scaled(scale)),
            normal: normal.deviation(),
        }
    };
    let patches = surfaces.faces.len();
    let irregular_patches = surfaces.faces.iter().filter(|(_, kind)| *kind != PatchKind::Regular).count();
    let mut number = 0..;
    let mut of_scheme = |plan: &PatchPlan| {
        let number = number.next().unwrap_or(0);
        let irregular = (irregular_patches > 0).then(|| errors(number, true));
        SchemeError { all: errors(number, false), irregular, fallen_back: plan.fallen_back().count() }
    };
    let schemes = plans.iter().map(|(s, plan)| (*s, plan.as_ref().map(&mut of_scheme).map_err(Clone::clone))).collect();
    let nearest_floor = near.as_ref().map(|near| {
        let mut sums = Sums::default();
        near.floor.iter().for_each(|patch| sums.merge(patch));
        sums.deviation().scaled(scale)
    });
    Ok(ErrorReport { diagonal, area: areas.iter().sum(), patches, irregular_patches, nearest_floor, schemes })
}

impl Deviation {
    fn scaled(self, scale: f64) -> Self {
        Self { rms: scale * self.rms, rms_per_sample: scale * self.rms_per_sample, max: scale * self.max }
    }
}

fn drawn_faces(topology: &Topology) -> Vec<(u32, PatchKind)> {
    let faces = (0..).zip(draws_face(topology)).filter(|(_, draws)| *draws);
    // The prepared mesh has no larger faces than these.
    faces.filter_map(|(face, _)| Some((face, topology.patch_kind(face)?))).collect()
}

/// The patches of a scheme.
pub(super) struct SchemePatches<'p> {
    plan: &'p PatchPlan,
    /// In the order of their faces.
    patches: Vec<Patch>,
}

impl<'p> SchemePatches<'p> {
    fn new(plan: &'p PatchPlan) -> Self {
        let mut patches = plan.patches().to_vec();
        patches.sort_unstable_by_key(|patch| patch.face);
        Self { plan, patches }
    }
}

/// The patches of all schemes that have them, and the surface they approximate.
pub(super) struct Surfaces<'s> {
    pub mesh: &'s ControlMesh,
    pub topology: &'s Topology<'s>,
    /// Those that are drawn, and what they become.
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
            let limit = LimitSurface::new(self.mesh)?;
            let chunk = start..(start + CHUNK).min(self.faces.len());
            results.par_extend(chunk.into_par_iter().map(|face| work(&limit, face)));
        }
        Ok(results)
    }

    /// Those of one of the schemes over one of the faces.
    pub(super) fn control_points(&self, scheme: usize, face: usize) -> Vec<DVec3> {
        let SchemePatches { plan, patches } = &self.schemes[scheme];
        patches[face].control_points(self.topology, plan.fallback_rings(), |vertex| self.mesh.position(vertex))
    }

    /// The patch at parameters of a part of the limit surface.
    pub(super) fn evaluate(&self, scheme: usize, face: usize, points: &[DVec3], at: Parameters) -> Sample<DVec3> {
        let Patch { kind, scheme, .. } = self.schemes[scheme].patches[face];
        let [u, v] = at.of_patch();
        scheme.evaluate(kind, points, u, v)
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
    /// Those of the patch over the face: (u, v) of a quad, the first two barycentric coordinates of a triangle.
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
                let (here, next) = (patch.first as i32, (patch.first as i32 + 1) % 5);
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

struct PatchErrors {
    area: f64,
    /// Of each scheme.
    schemes: Vec<ParametricSums>,
}

#[derive(Default)]
struct ParametricSums {
    position: Sums,
    normal: Sums,
}

fn measure_face(surfaces: &Surfaces, limit: &LimitSurface, face: usize, samples: u32) -> PatchErrors {
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(samples);
    let cell = f64::from(samples).powi(-2);
    let schemes = 0..surfaces.schemes.len();
    let points: Vec<_> = schemes.clone().map(|scheme| surfaces.control_points(scheme, face)).collect();
    let mut errors = PatchErrors { area: 0.0, schemes: Vec::new() };
    errors.schemes.resize_with(schemes.len(), Default::default);
    for sub in parts(surfaces.faces[face].1) {
        for (i, j) in (0..samples).flat_map(|j| (0..samples).map(move |i| (i, j))) {
            let at = Parameters { sub, u: middle(i), v: middle(j) };
            let truth = surfaces.limit(limit, face, at);
            let area = cell * truth.du.cross(truth.dv).length();
            errors.area += area;
            for scheme in schemes.clone() {
                let sample = surfaces.evaluate(scheme, face, &points[scheme], at);
                let sums = &mut errors.schemes[scheme];
                sums.position.add(area, sample.position.distance(truth.position));
                if let Some(angle) = angle(sample.normal, truth.normal) {
                    sums.normal.add(area, angle);
                }
            }
        }
    }
    errors
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
            let patch = Patch { face: 0, kind: PatchKind::Triangle, scheme: Scheme::Gregory, first: 0 };
            let back = Parameters::of_point(patch, at.of_patch());
            assert_eq!(back.sub, sub);
            assert!((back.u - at.u).abs().max((back.v - at.v).abs()) < 1e-12, "{at:?} {back:?}");
        }
    }
}
