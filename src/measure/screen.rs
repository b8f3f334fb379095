//! Distances of drawn triangles from the limit surface, in pixels of the screen.

use super::surfaces::{Face, Parameters};
use crate::capture::{CaptureDraw, Captured, CapturedVertex};
use crate::limit::LimitSurface;
use crate::mesh::ControlMesh;
use crate::renderer::{Error, View, is_size};
use crate::table::{CpuSurface, Patch};
use glam::{DMat4, DVec2, DVec3, Mat4, Vec3};
use rayon::prelude::*;

/// Patches measured with one limit surface, which remembers what it has refined.
const CHUNK: usize = 4096;

/// Samples in a triangle: the weights of its corners, and the part of the area that the sample stands for. Exact for
/// cubics; errors of chords are largest at the middles.
const SAMPLES: [([f64; 3], f64); 7] = [
    ([1.0, 0.0, 0.0], 0.05),
    ([0.0, 1.0, 0.0], 0.05),
    ([0.0, 0.0, 1.0], 0.05),
    ([0.5, 0.5, 0.0], 2.0 / 15.0),
    ([0.0, 0.5, 0.5], 2.0 / 15.0),
    ([0.5, 0.0, 0.5], 2.0 / 15.0),
    ([1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0], 0.45),
];

/// Size of a deviation on the screen, in pixels. All are zero if nothing is seen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PixelDeviation {
    /// Root mean square over the area on the screen.
    pub rms: f64,
    /// Bound of 99 % of the area on the screen, up to 1.1 % more.
    pub p99: f64,
    /// The largest, however small its triangle.
    pub max: f64,
}

/// Distances of the triangles of a draw from the limit surface on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct ScreenError {
    /// Triangles that the tessellator made, seen or not.
    pub triangles: u64,
    /// Samples that were seen.
    pub samples: u64,
    /// Between points with the same parameters: what textures and shading are shifted by, at least what outlines are.
    pub shift: PixelDeviation,
    /// Its part along the normal of the surface: what outlines are off by.
    pub shape: PixelDeviation,
    /// Distance from the patches themselves, between points with the same parameters: what more triangles would take away.
    pub facets: PixelDeviation,
}

/// Measures how far the triangles that a device draws are from the Catmull-Clark limit surface, on the screen.
///
/// The triangles are those of the device's own tessellator, as geometry shaders see them. Each has seven samples (corners,
/// middles of edges, centre), each weighted by the area on the screen that it stands for. A sample is where the triangle is
/// flat and, with the same parameters, where the limit surface is; both are projected, and their distance counts, as in
/// Yeo, Bin and Peters, *Efficient Pixel-Accurate Rendering of Curved Surfaces*, 2012. What
/// patches themselves are off by is in it: more and smaller triangles get no closer than that ([`ScreenError::facets`] is
/// without).
///
/// **Seen** are samples in the view's frustum; of a mesh without boundary and holes only those where the limit surface faces
/// [`View::eye`]. What is hidden by something in front counts; patches that are culled and triangles that reach behind the eye
/// do not.
///
/// **Approximations.** The maximum is that of the samples. The shape is of first order: the limit surface is taken to be as
/// its tangent plane between the two points, and nothing is off where it has none. On triangles and pentagons "the same
/// parameters" are a convention, that of [`surface_errors`](super::surface_errors), which the shift depends on.
///
/// `mesh` is that of the model that is captured, which is not displaced.
///
/// # Errors
/// [`Error::NoScreen`] without [`View::viewport`]; coordinates beyond those of [`LimitSurface::new`]; as
/// [`Captured::triangles`].
pub fn screen_error(captured: &Captured, mesh: &ControlMesh, draw: &CaptureDraw) -> Result<ScreenError, Error> {
    let screen = Screen::new(&draw.view)?;
    let both_sides = mesh.boundary_edge_count() > 0 || !mesh.data().holes.is_empty();
    let tables = captured.tables();
    let smooth = CpuSurface::with_options(mesh, &tables.options())?;
    let (topology, vertices) = (smooth.prepared().whole(), smooth.vertices(|p| p));
    let (mut triangles, mut shift, mut shape, mut facets) = (0, Spread::new(), Spread::new(), Spread::new());
    captured.triangles(draw, |captured| {
        triangles += captured.len() as u64;
        let mut captured = captured.to_vec();
        captured.par_sort_unstable_by_key(key);
        let of_patches: Vec<_> = captured.chunk_by(|a, b| a[0].patch == b[0].patch).collect();
        for chunk in of_patches.chunks(CHUNK) {
            let limit = LimitSurface::over(topology)?;
            let measure = |triangles: &&[[CapturedVertex; 3]]| {
                let patch = tables.plan().patches()[triangles[0][0].patch as usize];
                let points = smooth.points_of(patch, &vertices);
                let face = Face::of(smooth.prepared(), &patch);
                let surface = Surface { limit: &limit, smooth: &smooth, both_sides, patch, face, points };
                triangles.iter().flat_map(|triangle| screen.measure(&surface, triangle)).collect()
            };
            let seen: Vec<Vec<Seen>> = chunk.par_iter().map(measure).collect();
            for seen in seen.iter().flatten() {
                shift.add(seen.area, seen.shift);
                shape.add(seen.area, seen.shape);
                facets.add(seen.area, seen.facets);
            }
        }
        Ok(())
    })?;
    let count = shift.count;
    let [shift, shape, facets] = [&shift, &shape, &facets].map(Spread::deviation);
    Ok(ScreenError { triangles, samples: count, shift, shape, facets })
}

/// An order that does not depend on the device's.
fn key(triangle: &[CapturedVertex; 3]) -> (u32, [[u32; 3]; 3]) {
    (triangle[0].patch, triangle.map(|vertex| vertex.coordinate.map(f32::to_bits)))
}

/// A sample that is seen.
struct Seen {
    /// In pixels.
    shift: f64,
    shape: f64,
    facets: f64,
    /// In square pixels.
    area: f64,
}

/// What a patch and the triangles over it approximate.
struct Surface<'s> {
    limit: &'s LimitSurface,
    smooth: &'s CpuSurface,
    /// Whether what faces away is seen.
    both_sides: bool,
    patch: Patch,
    face: Face,
    /// Its control points.
    points: Vec<DVec3>,
}

/// Where things are in the picture.
struct Screen {
    clip: DMat4,
    /// Pixels in half of the picture.
    half: DVec2,
    eye: DVec3,
}

impl Screen {
    fn new(view: &View) -> Result<Self, Error> {
        if !is_size(view.viewport) {
            return Err(Error::NoScreen);
        }
        let half = DVec2::from(view.viewport.map(|side| f64::from(side) / 2.0));
        let eye = Vec3::from(view.eye).as_dvec3();
        Ok(Self { clip: Mat4::from_cols_array_2d(&view.view_projection).as_dmat4(), half, eye })
    }

    /// In pixels from the middle of the picture, and whether it is in the picture; none behind the eye.
    fn project(&self, point: DVec3) -> Option<(DVec2, bool)> {
        let clip = self.clip * point.extend(1.0);
        let at = clip.truncate() / clip.w;
        let inside = at.truncate().abs().max_element() <= 1.0 && (0.0..=1.0).contains(&at.z);
        (clip.w > 0.0).then(|| (self.half * at.truncate(), inside))
    }

    /// The samples of a triangle that are seen.
    fn measure(&self, surface: &Surface, triangle: &[CapturedVertex; 3]) -> impl Iterator<Item = Seen> {
        let Surface { limit, smooth, both_sides, patch, ref face, ref points } = *surface;
        let positions = triangle.map(|vertex| Vec3::from(vertex.position).as_dvec3());
        let coordinates = triangle.map(|vertex| Vec3::from(vertex.coordinate).as_dvec3());
        let area = match positions.map(|position| self.project(position)) {
            [Some((a, _)), Some((b, _)), Some((c, _))] => Some((b - a).perp_dot(c - a).abs() / 2.0),
            _ => None,
        };
        let sample = move |(weights, part): ([f64; 3], f64)| {
            let mean = |of: [DVec3; 3]| weights.iter().zip(of).map(|(&weight, x)| weight * x).sum::<DVec3>();
            let drawn = mean(positions);
            let (at, true) = self.project(drawn)? else { return None };
            let place: [f64; 2] = mean(coordinates).truncate().into();
            let Parameters { sub, u, v } = face.parameters(place);
            let truth = limit.evaluate(face.face, sub, u, v);
            if !both_sides && truth.normal.dot(self.eye - truth.position) <= 0.0 {
                return None;
            }
            let smooth = smooth.evaluate(patch, points, place[0], place[1]).position;
            let off = truth.position + (drawn - truth.position).dot(truth.normal) * truth.normal;
            let [truth, off, smooth] = [truth.position, off, smooth].map(|point| self.project(point));
            let (truth, off, smooth) = (truth?.0, off?.0, smooth?.0);
            Some(Seen {
                shift: at.distance(truth),
                shape: off.distance(truth),
                facets: at.distance(smooth),
                area: part * area?,
            })
        };
        SAMPLES.into_iter().filter_map(sample)
    }
}

/// Many deviations, each weighted by an area.
struct Spread {
    count: u64,
    area: f64,
    square: f64,
    max: f64,
    /// Area by the logarithm of the deviation.
    bins: Vec<f64>,
}

impl Spread {
    /// A step is 1.1 %.
    const BINS_PER_OCTAVE: f64 = 64.0;
    /// The lowest bin ends at 2^-40 pixels, the highest begins at 2^24.
    const LOWEST: f64 = -40.0;
    const OCTAVES: usize = 64;

    fn new() -> Self {
        let bins = vec![0.0; Self::OCTAVES * Self::BINS_PER_OCTAVE as usize + 1];
        Self { count: 0, area: 0.0, square: 0.0, max: 0.0, bins }
    }

    fn add(&mut self, area: f64, value: f64) {
        self.count += 1;
        self.area += area;
        self.square += area * value * value;
        self.max = self.max.max(value);
        // Zero goes to the lowest.
        let bin = ((value.log2() - Self::LOWEST) * Self::BINS_PER_OCTAVE).ceil() as usize;
        let last = self.bins.len() - 1;
        self.bins[bin.min(last)] += area;
    }

    fn deviation(&self) -> PixelDeviation {
        if self.area == 0.0 {
            return PixelDeviation { max: self.max, ..PixelDeviation::default() };
        }
        let mut within = 0.0;
        let reached = |area: &f64| {
            within += area;
            within >= 0.99 * self.area
        };
        let bin = self.bins.iter().position(reached).unwrap_or(self.bins.len() - 1);
        let p99 = (bin as f64 / Self::BINS_PER_OCTAVE + Self::LOWEST).exp2();
        PixelDeviation { rms: (self.square / self.area).sqrt(), p99: p99.min(self.max), max: self.max }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_are_weighted_by_area() {
        let mut spread = Spread::new();
        assert_eq!(spread.deviation(), PixelDeviation::default());
        (0..1000).for_each(|i| spread.add(1.0, f64::from(i) / 1000.0));
        spread.add(1e-9, 7.0);
        let PixelDeviation { rms, p99, max } = spread.deviation();
        assert!((rms - 3f64.sqrt().recip()).abs() < 1e-3, "{rms}");
        assert!((0.989..0.99 * 1.011).contains(&p99), "{p99}");
        assert_eq!(max, 7.0);
    }
}
