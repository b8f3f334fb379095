//! Distances to the nearest point of the other surface.

use super::error::{Parameters, Surfaces, angle, parts};
use super::sums::Sums;
use crate::mesh::MeshError;
use crate::patch::Sample;
use crate::topology::PatchKind;
use glam::DVec3;
use rayon::prelude::*;
use rstar::{AABB, PointDistance, RTree, RTreeObject};

/// Where normals differ by more, in radians, the nearest point is on the other side of something thin.
const MAX_ANGLE: f64 = 1.2;

/// Triangles of a surface, about.
const TRIANGLES: f64 = 2e6;

/// What [`measure`] found.
pub(super) struct Nearest {
    /// Of each scheme, for each patch, the distances from its points to the limit surface and the other way.
    pub distances: Vec<Vec<Sums>>,
}

/// A point of a surface, and the area it stands for over the average of the patch.
struct Probe {
    at: Parameters,
    sample: Sample<DVec3>,
    weight: f64,
}

/// What both surfaces over a patch are asked at.
struct LimitPatch {
    facets: Vec<Facet>,
    probes: Vec<Probe>,
}

/// Measures both ways from about `samples` points of each surface. `areas` are those of the patches.
pub(super) fn measure(surfaces: &Surfaces, areas: &[f64], samples: u32) -> Result<Nearest, MeshError> {
    let side = ((TRIANGLES / 2.0 / surfaces.faces.len().max(1) as f64).sqrt() as u32).clamp(4, 32);
    let ranges = spread(areas, samples);
    let limits = surfaces.for_each(|limit, patch| {
        let kind = surfaces.faces[patch].1;
        let facets = facets(kind, side, |at| surfaces.limit(limit, patch, at).position);
        let probe = |number: u32| {
            let at = parameters(kind, number);
            let truth = surfaces.limit(limit, patch, at);
            let mean = areas[patch] / f64::from(parts(kind).len() as u32);
            let weight = truth.du.cross(truth.dv).length() / mean;
            Probe { at, sample: Sample { position: truth.position, normal: truth.normal }, weight }
        };
        LimitPatch { facets, probes: ranges[patch].clone().map(probe).collect() }
    })?;
    let (limit_facets, probes): (Vec<_>, Vec<_>) = limits.into_iter().map(|patch| (patch.facets, patch.probes)).unzip();
    let limit = RTree::bulk_load(limit_facets.into_iter().flatten().collect());
    let of_scheme = |scheme: usize| {
        let of_patch = |patch: usize| {
            let points = surfaces.control_points(scheme, patch);
            let evaluate = |at| surfaces.evaluate(scheme, patch, &points, at);
            let triangles = facets(surfaces.faces[patch].1, side, |at| evaluate(at).position);
            (triangles, probes[patch].iter().map(|probe| evaluate(probe.at)).collect::<Vec<_>>())
        };
        let patches = (0..surfaces.faces.len()).into_par_iter().map(of_patch);
        let (facets, samples): (Vec<_>, Vec<_>) = patches.unzip();
        let tree = RTree::bulk_load(facets.into_iter().flatten().collect());
        let sums = |(probes, samples): (&Vec<Probe>, &Vec<Sample<DVec3>>)| {
            let mut sums = Sums::default();
            for (probe, sample) in probes.iter().zip(samples) {
                for distance in [distance(&limit, sample), distance(&tree, &probe.sample)].into_iter().flatten() {
                    sums.add(probe.weight, distance);
                }
            }
            sums
        };
        probes.par_iter().zip(&samples).map(sums).collect()
    };
    Ok(Nearest { distances: (0..surfaces.schemes.len()).map(of_scheme).collect() })
}

/// Numbers of samples for each patch, as many as its area is worth.
fn spread(areas: &[f64], samples: u32) -> Vec<std::ops::Range<u32>> {
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
fn parameters(kind: PatchKind, number: u32) -> Parameters {
    let parts = parts(kind);
    let part = number % parts.len() as u32;
    let number = f64::from(number / parts.len() as u32) + 1.0;
    let [u, v] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2].map(|step| (number * step).fract());
    Parameters { sub: parts.start + part as i32, u, v }
}

/// The distance to the nearest triangle, if its side is the same.
fn distance(tree: &RTree<Facet>, sample: &Sample<DVec3>) -> Option<f64> {
    let point = sample.position.to_array();
    let facet = tree.nearest_neighbor(point)?;
    let other_side = angle(sample.normal, facet.normal()).is_some_and(|angle| angle > MAX_ANGLE);
    (!other_side).then(|| facet.distance_2(&point).sqrt())
}

/// A triangle of a dense mesh.
struct Facet([DVec3; 3]);

impl Facet {
    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.0;
        (b - a).cross(c - a).normalize_or_zero()
    }
}

impl RTreeObject for Facet {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        let [a, b, c] = self.0;
        AABB::from_corners(a.min(b).min(c).to_array(), a.max(b).max(c).to_array())
    }
}

impl PointDistance for Facet {
    fn distance_2(&self, point: &[f64; 3]) -> f64 {
        let point = DVec3::from_array(*point);
        point.distance_squared(closest(self.0, point))
    }
}

/// The point of a triangle that is closest to `p` (Ericson, *Real-Time Collision Detection*, 5.1.5).
fn closest([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + d1 / (d1 - d3) * ab;
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + d2 / (d2 - d6) * ac;
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    a + (vb * ab + vc * ac) / (va + vb + vc)
}

/// A patch as triangles, `side` cells along each side; about as many for a triangle in all.
fn facets(kind: PatchKind, side: u32, position: impl Fn(Parameters) -> DVec3) -> Vec<Facet> {
    let side = if kind == PatchKind::Triangle { side.div_ceil(2) } else { side };
    let at = |i: u32| f64::from(i) / f64::from(side);
    let mut facets = Vec::new();
    for sub in parts(kind) {
        let lattice: Vec<DVec3> = (0..=side)
            .flat_map(|j| (0..=side).map(move |i| Parameters { sub, u: at(i), v: at(j) }))
            .map(&position)
            .collect();
        for (i, j) in (0..side).flat_map(|j| (0..side).map(move |i| (i, j))) {
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| lattice[(j * (side + 1) + i) as usize]);
            facets.extend([Facet([a, b, c]), Facet([a, c, d])]);
        }
    }
    facets
}
