//! Patches against the exact limit surface, as the reference in Python (`tests/limit`) and OpenSubdiv's Bfr
//! (`../shared/limit`) gave it.
//!
//! Positions come from OBJ text as f64, as those of the reference did. Distances are in units of rounding at the
//! largest coordinate of the mesh, or over the diagonal of its bounds.

use crate::common;
use crate::common::limit::{Limit, LimitSample, Record, mesh_and_limit};
use ash_subdiv::mesh::SHARPNESS_INFINITE;
use ash_subdiv::patch::{Blend, Scheme};
use ash_subdiv::topology::{PatchKind, RingKind, Topology};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// Every mesh with a limit surface that this crate reads. `catmark_fan` has edges with three faces; in
/// `catmark_nonman_verts` a vertex has no face.
fn names() -> impl Iterator<Item = String> {
    common::limit::names().into_iter().filter(|n| n != "catmark_fan" && n != "catmark_nonman_verts")
}

/// Why a patch need not meet the limit surface at a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Exception {
    /// An edge or vertex of finite sharpness: patches draw it as infinitely sharp or not at all, so neither point nor
    /// normal is the limit's.
    SemiSharp,
    /// One sharp edge ends here. Patches use the smooth masks, as OpenSubdiv's Far does: point and normal are off.
    Dart,
    /// Boundary or crease vertices with three or more faces on a side: Biermann's tangents, and from four faces on no
    /// tangent plane at all. The point is right.
    CreaseOfThree,
    /// A boundary or crease that runs smoothly through a vertex with one face: both derivatives are along the boundary,
    /// so there is no normal. The point is right.
    CreaseOfOne,
    /// Several faces in a corner: drawn as a cone, without a common tangent plane. The point is right.
    Cone,
    /// Two faces inside the surface: no tangent plane. The point is right.
    ValenceTwo,
}

impl Exception {
    const ALL: [Self; 6] =
        [Self::SemiSharp, Self::Dart, Self::CreaseOfThree, Self::CreaseOfOne, Self::Cone, Self::ValenceTwo];

    fn at(topology: &Topology, half_edge: u32) -> Option<Self> {
        let data = topology.mesh().data();
        let vertex = topology.mesh_vertex(half_edge);
        let ring = &topology.rings()[topology.place(half_edge).ring as usize];
        let creases: Vec<f32> = data
            .creases
            .iter()
            .filter(|c| c.vertices.contains(&vertex) && c.sharpness > 0.0)
            .map(|c| c.sharpness)
            .collect();
        let corners = data.corners.iter().filter(|c| c.vertex == vertex && c.sharpness > 0.0).map(|c| c.sharpness);
        if creases.iter().copied().chain(corners).any(|sharpness| sharpness < SHARPNESS_INFINITE) {
            return Some(Self::SemiSharp);
        }
        match (ring.kind, ring.faces) {
            (RingKind::Smooth, _) if creases.len() == 1 => Some(Self::Dart),
            (RingKind::Smooth, 2) => Some(Self::ValenceTwo),
            (RingKind::Crease, 1) => Some(Self::CreaseOfOne),
            (RingKind::Crease, 3..) => Some(Self::CreaseOfThree),
            (RingKind::Corner, 2..) => Some(Self::Cone),
            _ => None,
        }
    }

    fn has_point(self) -> bool {
        !matches!(self, Self::SemiSharp | Self::Dart)
    }
}

/// Faces that a patch follows exactly: regular ones without finite sharpness and darts.
///
/// The record's own flag is narrower: OpenSubdiv says no to faces beside creases, and to some beside valence 2.
fn is_exact(topology: &Topology, face: u32) -> bool {
    let mut corners = topology.mesh().face_corners(face);
    topology.patch_kind(face) == Some(PatchKind::Regular)
        && corners.all(|h| Exception::at(topology, h as u32).is_none_or(Exception::has_point))
}

fn parameters(limit: &Limit) -> impl Iterator<Item = (f64, f64)> {
    let last = limit.side - 1;
    let at = move |i| i as f64 / last as f64;
    (0..=last).flat_map(move |j| (0..=last).map(move |i| (at(i), at(j))))
}

fn whole_quads(limit: &Limit) -> impl Iterator<Item = &Record> {
    limit.records.iter().filter(|record| record.sub < 0)
}

/// Errors of a patch in f64 and in f32: of position in units of rounding, of the normal in radians (f64) and in units
/// of rounding of the derivatives (f32).
#[derive(Debug, Default, Clone, Copy)]
struct Errors {
    position: f64,
    normal: f64,
    position_f32: f64,
    normal_f32: f64,
}

impl Errors {
    fn add(&mut self, topology: &Topology, face: u32, limit: &Limit, samples: &[LimitSample]) {
        let mesh = topology.mesh();
        let scale = common::largest_coordinate(mesh);
        let kind = PatchKind::Regular;
        let points = Scheme::Gregory.control_points(topology, face, kind, |v| mesh.position(v));
        let points_f32: Vec<Vec3> =
            Scheme::Gregory.control_points(topology, face, kind, |v| mesh.position(v).as_vec3());
        for (sample, (u, v)) in samples.iter().zip(parameters(limit)) {
            let ours = Scheme::Gregory.evaluate(kind, &points, u, v);
            self.position = self.position.max((ours.position - sample.position).length() / (f64::EPSILON * scale));
            // A smooth boundary through a vertex with one face has no normal there.
            let area = sample.du.cross(sample.dv).length();
            if area < 1e-9 * sample.du.length() * sample.dv.length() {
                continue;
            }
            self.normal = self.normal.max((ours.normal - sample.normal()).length());
            let ours = Scheme::Gregory.evaluate(kind, &points_f32, u as f32, v as f32);
            let unit = f64::from(f32::EPSILON) * scale;
            self.position_f32 = self.position_f32.max((ours.position.as_dvec3() - sample.position).length() / unit);
            // The derivatives are differences of rounded points; the flatter the parallelogram they span, the more they turn.
            let turn = unit * sample.du.length().max(sample.dv.length()) / area;
            let error = (ours.normal.as_dvec3() - sample.normal()).length();
            self.normal_f32 = self.normal_f32.max(error / turn.max(f64::from(f32::EPSILON)));
        }
    }
}

#[test]
fn regular_faces_are_the_limit_surface() {
    let mut faces = BTreeMap::new();
    for name in names() {
        let (mesh, limit) = mesh_and_limit(&name);
        let topology = Topology::new(&mesh);
        let mut errors = Errors::default();
        let mut count = 0;
        for record in whole_quads(&limit) {
            let exact = is_exact(&topology, record.face);
            assert!(exact || !record.regular, "{name}: face {} is regular in the reference", record.face);
            if exact {
                count += 1;
                errors.add(&topology, record.face, &limit, &record.samples);
            }
        }
        // Measured at worst: 4.9 units of f64 (2.6e-15 of the diagonal) and 7.5e-13 rad; 2.8 and 6.9 units of f32.
        assert!(errors.position < 8.0 && errors.normal < 2e-12, "{name}: {errors:?}");
        assert!(errors.position_f32 < 4.0 && errors.normal_f32 < 10.0, "{name}: {errors:?}");
        faces.insert(name, count);
    }
    let ours = [("strip", 8), ("torus", 20)];
    let theirs = [
        ("monsterfrog", 528),
        ("bigguy", 858),
        ("car", 583),
        ("catmark_torus", 32),
        ("catmark_righthanded", 208),
        ("catmark_quadstrips", 20),
        ("catmark_edgecorner", 28),
        ("rook", 432),
    ];
    for (name, at_least) in ours.into_iter().chain(theirs.into_iter().filter(|_| cfg!(shared))) {
        assert!(faces[name] >= at_least, "{name}: {} exact faces of {at_least}", faces[name]);
    }
}

// Longer than a screen: one sweep over all meshes, and the bounds of what it found.
#[test]
fn corners_are_limit_points_with_limit_normals() {
    // By exception (or none): corners, largest position error (of the diagonal), largest normal error.
    let mut seen: BTreeMap<Option<Exception>, (usize, f64, f64)> = BTreeMap::new();
    let mut irregular = BTreeMap::new();
    for name in names() {
        let (mesh, limit) = mesh_and_limit(&name);
        let topology = Topology::new(&mesh);
        for face in 0..mesh.face_count() as u32 {
            let Some(kind) = topology.patch_kind(face) else { continue };
            // A patch beside a pentagon is made after refinement only.
            let beside_polygon = |h| {
                let ring = &topology.rings()[topology.place(h as u32).ring as usize];
                topology.ring_half_edges(ring).any(|h| topology.face_size(h) > 4)
            };
            if mesh.face_corners(face).any(beside_polygon) {
                continue;
            }
            let points = Scheme::Gregory.control_points(&topology, face, kind, |v| mesh.position(v));
            for (k, h) in mesh.face_corners(face).enumerate() {
                // Holes have no record.
                let Some(sample) = limit.at_corner(face, k) else { continue };
                let exception = Exception::at(&topology, h as u32);
                assert!(limit.vertices[topology.mesh_vertex(h as u32) as usize].valid);
                let at = match kind {
                    PatchKind::Triangle => [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]][k],
                    _ => [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][k],
                };
                let ours = Scheme::Gregory.evaluate(kind, &points, at[0], at[1]);
                let position = (ours.position - sample.position).length() / mesh.diagonal();
                let mut normal = (ours.normal - sample.normal()).length();
                if sample.normal() == DVec3::ZERO {
                    // No normal to compare with.
                    assert!(exception.is_some() || name == "car", "{name}: face {face} corner {k}");
                    normal = if exception.is_some() { f64::INFINITY } else { 0.0 };
                }
                let what =
                    || format!("{name}: face {face} corner {k}, {exception:?}, off by {position:e} and {normal:e}");
                if exception.is_none_or(Exception::has_point) {
                    assert!(position < 1e-14, "{}", what());
                }
                if exception.is_none() {
                    // Measured 5e-6 on bigguy and frog, 1e-12 on most small meshes: the reference differentiates a patch
                    // at level 10. That ours is the limit's to 1e-12 is shown in exactness.rs by refinement.
                    assert!(normal < 1e-5, "{}", what());
                    *irregular.entry(kind).or_insert(0) += usize::from(!topology_is_regular(&topology, h as u32));
                }
                let entry = seen.entry(exception).or_default();
                *entry = (entry.0 + 1, entry.1.max(position), entry.2.max(normal));
            }
        }
    }
    let [corners, quads, triangles] = if cfg!(shared) { [20_000, 3000, 250] } else { [100, 0, 5] };
    assert!(seen[&None].0 > corners && irregular[&PatchKind::IrregularQuad] > quads, "{seen:?} {irregular:?}");
    assert!(irregular[&PatchKind::Triangle] > triangles, "{irregular:?}");
    if !cfg!(shared) {
        return;
    }
    // An exception that is none any more, or that no mesh has, is to be struck off the list.
    for exception in Exception::ALL {
        let (_, position, normal) = seen[&Some(exception)];
        assert!(normal > 1e-2 && (exception.has_point() || position > 1e-3), "{exception:?}: {position:e} {normal:e}");
    }
}

fn topology_is_regular(topology: &Topology, half_edge: u32) -> bool {
    topology.rings()[topology.place(half_edge).ring as usize].is_regular()
}

/// Root mean squares over the surface: distance at the same parameters over the diagonal, and normal angle in radians.
fn rms<T: Blend>(name: &str, value: impl Fn(DVec3) -> T, point: impl Fn(&T) -> DVec3) -> [f64; 2] {
    let (mesh, limit) = mesh_and_limit(name);
    let topology = Topology::new(&mesh);
    let (mut area, mut position, mut angle) = (0.0, 0.0, 0.0);
    for record in whole_quads(&limit) {
        let kind = topology.patch_kind(record.face).expect("a quad");
        let points = Scheme::Gregory.control_points(&topology, record.face, kind, |v| value(mesh.position(v)));
        let points: Vec<DVec3> = points.iter().map(&point).collect();
        for (sample, (u, v)) in record.samples.iter().zip(parameters(&limit)) {
            // The trapezoidal rule: half a weight on an edge, a quarter in a corner.
            let half = |t: f64| if t == 0.0 || t == 1.0 { 0.5 } else { 1.0 };
            let weight = half(u) * half(v) * sample.du.cross(sample.dv).length();
            let ours = Scheme::Gregory.evaluate(kind, &points, u, v);
            area += weight;
            position += weight * (ours.position - sample.position).length_squared();
            angle += weight * ours.normal.angle_between(sample.normal()).powi(2);
        }
    }
    [(position / area).sqrt() / mesh.diagonal(), (angle / area).sqrt()]
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn one_patch_a_face_is_as_far_from_the_limit_as_gregory_patches_are() {
    // The reference (../shared/reference/peers.md) has, at 33 x 33 samples a patch, frog 0.292e-3 and 0.0092, bigguy
    // 0.227e-3 and 0.0064; it says of 5 x 5 samples, as here, that the position error is a third larger. Measured:
    // 0.375e-3 and 0.0094, 0.295e-3 and 0.0063.
    for (name, position, angle) in [("monsterfrog", 0.292e-3, 0.0092), ("bigguy", 0.227e-3, 0.0064)] {
        let ours = rms(name, |p| p, |p| *p);
        assert!((1.25..1.35).contains(&(ours[0] / position)), "{name}: position {:e}", ours[0]);
        assert!((0.97..1.03).contains(&(ours[1] / angle)), "{name}: normal {:e}", ours[1]);
        let ours_f32 = rms(name, |p| p.as_vec3(), |p| p.as_dvec3());
        assert!((ours_f32[0] / ours[0] - 1.0).abs() < 1e-3, "{name}: {ours_f32:?} in f32, {ours:?} in f64");
    }
}
