//! Errors of schemes against the limit surface.

use super::nearest::{self, Nearest};
use super::sums::{Deviation, Sums};
use super::surfaces::{Face, Parameters, SchemePatches, Surfaces, angle};
use crate::adaptive::AdaptiveOptions;
use crate::limit::LimitSurface;
use crate::mesh::ControlMesh;
use crate::patch::{Fallback, Scheme, Undefined};
use crate::table::{CpuSurface, TableError, TableOptions, prepare};
use crate::topology::PatchKind;

/// Options of the measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ErrorOptions {
    /// Fallback for faces that a scheme has no patches for.
    pub fallback: Fallback,
    /// Steps of refinement before patches are made, at least.
    pub refine: u32,
    /// Depths of adaptive subdivision, if schemes are measured as the end caps of that: only those that have some.
    pub adaptive: Option<AdaptiveOptions>,
    /// Samples along each side of a quad, and of each of the three parts of a triangle; at least 1.
    pub samples: u32,
    /// Samples of each surface for the nearest distance, over the whole mesh; none is measured if 0.
    pub nearest: u32,
}

impl Default for ErrorOptions {
    /// Nothing falls back or is refined, adaptively or not; 33 by 33 samples a patch, 60 000 for the nearest distance.
    fn default() -> Self {
        Self { fallback: Fallback::Refuse, refine: 0, adaptive: None, samples: 33, nearest: 60_000 }
    }
}

/// Errors of some faces of a scheme against the limit surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FaceErrors {
    /// Distance of the points with the same parameters, over the diagonal of the control mesh.
    pub position: Deviation,
    /// Distance to the nearest point of the other surface, both ways together, over the diagonal of the control mesh.
    /// `None` if not asked for.
    pub nearest: Option<Deviation>,
    /// Angle between the normals at the same parameters, in radians. Samples where either surface has none do not count.
    pub normal: Deviation,
}

/// Errors of the patches of a scheme against the limit surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SchemeError {
    /// Over all faces.
    pub all: FaceErrors,
    /// Over irregular quads and triangles; `None` if there are none.
    pub irregular: Option<FaceErrors>,
    /// Faces that the scheme has no patches for, measured with those of the fallback.
    pub fallen_back: usize,
}

/// Result of [`surface_errors`].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ErrorReport {
    /// Length of the diagonal of the control mesh's bounding box: the unit of distances here, in the mesh's own.
    pub diagonal: f64,
    /// Area of the limit surface that was measured, in the mesh's own units.
    pub area: f64,
    /// Patches of the mesh.
    pub patches: usize,
    /// Patches that are irregular quads or triangles.
    pub irregular_patches: usize,
    /// The nearest distance of the limit surface from itself, over the diagonal of the control mesh: what comes of
    /// measuring against triangles. `None` if not asked for.
    pub nearest_floor: Option<Deviation>,
    /// Errors by scheme, in the order of the request; schemes without patches on this mesh say why.
    pub schemes: Vec<(Scheme, Result<SchemeError, Undefined>)>,
}

/// Measures how far schemes are from the Catmull-Clark limit surface of a mesh.
///
/// **Samples.** Each patch is evaluated at the middles of `samples` by `samples` cells of equal size in u and v. A
/// triangle has three such uniform grids, one for each part of the limit surface over it
/// ([`LimitSurface`]); (u, v) of the part around corner k is taken to be the point of the triangle that is bilinear
/// between corner k, the middles of its edges and the centre. That is a convention: other ways to lay the parameters of
/// a triangle over those of the limit surface give other distances, and slightly other angles. Where the mesh is refined
/// before patches are made, samples are those of the refined faces. A mesh with faces of five or more corners is refined
/// once for every scheme, [`Scheme::Pm`] too, so that all are measured on the same faces. With adaptive subdivision no mesh is;
/// faces other than quads are measured on the parts of the limit surface themselves.
///
/// **Nearest distance.** As many points of both surfaces, spread evenly over the area, each against the other surface
/// as a mesh of triangles (about two million, at least 32 a patch, at most 2048). Chords of such a mesh are off the
/// surface by an eighth of their length squared over the radius of curvature: no smaller distance is to be trusted, and
/// that of a scheme that is exact is not zero ([`ErrorReport::nearest_floor`]). Where the normals differ by more than 1.2 rad the point has found the
/// other side of something thin, and does not count.
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
/// # Ok::<(), ash_subdiv::table::TableError>(())
/// ```
///
/// # Errors
/// A refined mesh that cannot be addressed; coordinates beyond those of [`LimitSurface::new`]; with
/// [`ErrorOptions::adaptive`] those of [`adaptive::Plan::new`](crate::adaptive::Plan::new), also of schemes without end caps.
///
/// # Panics
/// If `options.samples` is 0.
pub fn surface_errors(
    mesh: &ControlMesh,
    schemes: &[Scheme],
    options: &ErrorOptions,
) -> Result<ErrorReport, TableError> {
    assert!(options.samples > 0, "at least one sample along a side");
    let [low, high] = mesh.bounds();
    let diagonal = low.distance(high);
    let of_schemes = of_schemes(mesh, schemes, options)?;
    let defined: Vec<_> = of_schemes.iter().filter_map(|(_, surface)| surface.as_ref().ok()).collect();
    let prepared = match defined.first() {
        Some(surface) => surface.prepared(),
        None => &prepare(mesh, options.refine)?,
    };
    let schemes = defined.into_iter().map(SchemePatches::new).collect();
    let surfaces = Surfaces { topology: prepared.whole(), faces: Face::all(prepared), schemes };

    let faces = surfaces.for_each(|limit, face| measure_face(&surfaces, limit, face, options.samples))?;
    let areas: Vec<f64> = faces.iter().map(|face| face.area).collect();
    let nearest = match options.nearest {
        0 => None,
        samples => Some(nearest::measure(&surfaces, &areas, samples)?),
    };
    // A mesh without extent is as good as its patches, which are the same point.
    let scale = if diagonal > 0.0 { diagonal.recip() } else { 0.0 };
    let measured = Measured { kinds: surfaces.faces.iter().map(|face| face.kind).collect(), faces, nearest, scale };
    let irregular_patches = measured.kinds.iter().filter(|kind| **kind != PatchKind::Regular).count();
    let mut number = 0..;
    let mut of_scheme = |surface: &CpuSurface| {
        let number = number.next().unwrap_or(0);
        let irregular = (irregular_patches > 0).then(|| measured.errors(number, true));
        let fallen_back = surface.plan().fallen_back().count();
        SchemeError { all: measured.errors(number, false), irregular, fallen_back }
    };
    let errors =
        |(scheme, surface): &SchemeSurface| (*scheme, surface.as_ref().map(&mut of_scheme).map_err(Clone::clone));
    let schemes = of_schemes.iter().map(errors).collect();
    let (area, patches) = (areas.iter().sum(), measured.kinds.len());
    Ok(ErrorReport { diagonal, area, patches, irregular_patches, nearest_floor: measured.nearest_floor(), schemes })
}

/// A scheme and its surface, or why there is none.
type SchemeSurface = (Scheme, Result<CpuSurface, Undefined>);

/// The surfaces of schemes, all of the same faces.
fn of_schemes(
    mesh: &ControlMesh,
    schemes: &[Scheme],
    options: &ErrorOptions,
) -> Result<Vec<SchemeSurface>, TableError> {
    let &ErrorOptions { fallback, refine, adaptive, .. } = options;
    if adaptive.is_some() {
        let surface = |&scheme: &Scheme| {
            let options = TableOptions { scheme, refine, adaptive, ..TableOptions::default() };
            Ok((scheme, Ok(CpuSurface::with_options(mesh, &options)?)))
        };
        return schemes.iter().map(surface).collect();
    }
    let prepared = prepare(mesh, refine)?;
    let planned = |&scheme: &Scheme| {
        let plan = prepared.plan(scheme, fallback);
        (scheme, plan.map(|plan| CpuSurface::planned(prepared.clone(), plan)))
    };
    Ok(schemes.iter().map(planned).collect())
}

/// The sums of every patch.
struct Measured {
    kinds: Vec<PatchKind>,
    faces: Vec<PatchErrors>,
    nearest: Option<Nearest>,
    /// One over the diagonal, the unit of distances.
    scale: f64,
}

impl Measured {
    /// The errors of one scheme, over all patches or irregular ones only.
    fn errors(&self, scheme: usize, only_irregular: bool) -> FaceErrors {
        let (mut position, mut normal, mut nearest) = (Sums::default(), Sums::default(), Sums::default());
        for (i, &kind) in self.kinds.iter().enumerate() {
            if only_irregular && kind == PatchKind::Regular {
                continue;
            }
            position.merge(&self.faces[i].schemes[scheme].position);
            normal.merge(&self.faces[i].schemes[scheme].normal);
            if let Some(near) = &self.nearest {
                nearest.merge(&near.distances[scheme][i]);
            }
        }
        FaceErrors {
            position: position.deviation().scaled(self.scale),
            nearest: self.nearest.as_ref().map(|_| nearest.deviation().scaled(self.scale)),
            normal: normal.deviation(),
        }
    }

    fn nearest_floor(&self) -> Option<Deviation> {
        self.nearest.as_ref().map(|near| {
            let mut sums = Sums::default();
            near.floor.iter().for_each(|patch| sums.merge(patch));
            sums.deviation().scaled(self.scale)
        })
    }
}

struct PatchErrors {
    area: f64,
    /// Sums by scheme.
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
    for sub in surfaces.faces[face].parts.clone() {
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
