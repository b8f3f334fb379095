//! Distances to the nearest point of the other surface.

use super::dense::{Dense, grid};
use super::sums::Sums;
use super::surfaces::{Parameters, Surfaces, angle};
use crate::mesh::MeshError;
use crate::patch::Sample;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// Where normals differ by more, in radians, the nearest point is on the other side of something thin.
const MAX_ANGLE: f64 = 1.2;

/// Result of [`measure`].
pub(super) struct Nearest {
    /// For each scheme and patch, the distances from its points to the limit surface and the other way.
    pub distances: Vec<Vec<Sums>>,
    /// For each patch, the distances from points of the limit surface to its own triangles.
    pub floor: Vec<Sums>,
}

/// A point of a surface, and the area it stands for over the average of the patch.
struct Probe {
    at: Parameters,
    sample: Sample<DVec3>,
    weight: f64,
}

/// Points of a patch at which both surfaces are evaluated.
struct LimitPatch {
    grid: Vec<DVec3>,
    probes: Vec<Probe>,
}

/// Measures both ways from about `samples` points of each surface. `areas` are those of the patches.
pub(super) fn measure(surfaces: &Surfaces, areas: &[f64], samples: u32) -> Result<Nearest, MeshError> {
    let parts: Vec<_> = surfaces.faces.iter().map(|face| face.parts.clone()).collect();
    let ranges = spread(areas, samples);
    let limits = surfaces.for_each(|limit, patch| {
        let (of_patch, patches) = (&parts[patch], parts.len());
        let grid = grid(of_patch, patches, |at| surfaces.limit(limit, patch, at).position);
        let probe = |number: u32| {
            let at = parameters(of_patch, number);
            let truth = surfaces.limit(limit, patch, at);
            let mean = areas[patch] / f64::from(of_patch.len() as u32);
            let weight = truth.du.cross(truth.dv).length() / mean;
            Probe { at, sample: Sample { position: truth.position, normal: truth.normal }, weight }
        };
        LimitPatch { grid, probes: ranges[patch].clone().map(probe).collect() }
    })?;
    let (grids, probes): (Vec<_>, Vec<_>) = limits.into_iter().map(|patch| (patch.grid, patch.probes)).unzip();
    let limit = Dense::new(&parts, &grids);
    let own = |probes: &Vec<Probe>| {
        let mut sums = Sums::default();
        for probe in probes {
            distance(&limit, &probe.sample).into_iter().for_each(|distance| sums.add(probe.weight, distance));
        }
        sums
    };
    let floor = probes.par_iter().map(own).collect();
    let of_scheme = |scheme: usize| {
        let of_patch = |patch: usize| {
            let points = surfaces.control_points(scheme, patch);
            let evaluate = |at| surfaces.evaluate(scheme, patch, &points, at);
            let grid = grid(&parts[patch], parts.len(), |at| evaluate(at).position);
            (grid, probes[patch].iter().map(|probe| evaluate(probe.at)).collect::<Vec<_>>())
        };
        let (grids, samples): (Vec<_>, Vec<_>) = (0..parts.len()).into_par_iter().map(of_patch).unzip();
        let dense = Dense::new(&parts, &grids);
        let sums = |(probes, samples): (&Vec<Probe>, &Vec<Sample<DVec3>>)| {
            let mut sums = Sums::default();
            for (probe, sample) in probes.iter().zip(samples) {
                for distance in [distance(&limit, sample), distance(&dense, &probe.sample)].into_iter().flatten() {
                    sums.add(probe.weight, distance);
                }
            }
            sums
        };
        probes.par_iter().zip(&samples).map(sums).collect()
    };
    Ok(Nearest { distances: (0..surfaces.schemes.len()).into_par_iter().map(of_scheme).collect(), floor })
}

/// Numbers of samples for each patch, as many as its area is worth.
fn spread(areas: &[f64], samples: u32) -> Vec<Range<u32>> {
    let total: f64 = areas.iter().sum();
    let (mut before, mut start) = (0.0, 0);
    let range = |area: &f64| {
        before += area;
        let end = if total > 0.0 { (f64::from(samples) * (before / total) + 0.5) as u32 } else { 0 };
        let range = start..end.max(start);
        start = range.end;
        range
    };
    areas.iter().map(range).collect()
}

/// Evenly spread, whichever numbers a patch has: the additive sequence by powers of the plastic number.
fn parameters(parts: &Range<i32>, number: u32) -> Parameters {
    let part = number % parts.len() as u32;
    let number = f64::from(number / parts.len() as u32) + 1.0;
    let [u, v] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2].map(|step| (number * step).fract());
    Parameters { sub: parts.start + part as i32, u, v }
}

/// The distance to the nearest triangle, if its side is the same.
fn distance(surface: &Dense, sample: &Sample<DVec3>) -> Option<f64> {
    let (distance, normal) = surface.nearest(sample.position)?;
    let other_side = angle(sample.normal, normal).is_some_and(|angle| angle > MAX_ANGLE);
    (!other_side).then_some(distance)
}
