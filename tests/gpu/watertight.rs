//! What patches share on the GPU, to the bit; and vertices of high valence.

use crate::common;
use crate::common::edges::{SharedEdge, bits, edge_points, shared_edges};
use crate::common::random::{random_creased_mesh, random_mesh};
use ash_subdiv::Scheme;
use ash_subdiv::capture::{Captured, CapturedVertex};
use ash_subdiv::table::{CpuSurface, grid_parameters, prepare};
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{Construction, ControlMesh, MeshData, ModelOptions, Spacing, shape};
use glam::Vec3;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// With the edges between their faces.
fn meshes() -> Vec<(String, ControlMesh, Vec<SharedEdge>)> {
    let shapes = ["creature-mixed", "machine-part", "polygons", "valences", "cloth", "fan"];
    let mut meshes: Vec<_> = shapes.map(|name| (name.to_owned(), shape(name).expect("built in"))).into();
    for seed in 0..4 {
        meshes.push((format!("random {seed}"), random_mesh(seed)));
        meshes.push((format!("random creased {seed}"), random_creased_mesh(seed)));
    }
    let with_edges = |(name, mesh): (String, ControlMesh)| {
        let edges = shared_edges(prepare(&mesh, 0).expect("small").topology());
        (name, mesh, edges)
    };
    meshes.into_iter().map(with_edges).collect()
}

/// The edge from corner `k` to the next on which an evaluated vertex lies, and where on it; two edges for a corner.
fn places(kind: PatchKind, [u, v, w]: [f32; 3]) -> Vec<(usize, f32)> {
    let edges: &[(f32, f32)] = match kind {
        PatchKind::Triangle => &[(w, v), (u, w), (v, u)],
        // What is zero on the edge, and the way from its start.
        _ => &[(v, u), (1.0 - u, v), (1.0 - v, 1.0 - u), (u, 1.0 - v)],
    };
    edges.iter().enumerate().filter(|(_, (zero, _))| *zero == 0.0).map(|(k, (_, t))| (k, *t)).collect()
}

/// The evaluated vertices on each edge of each face, by their place in units of 2^-16, of which lavapipe's coordinates
/// are multiples.
fn on_edges(captured: &Captured, factor: f32) -> HashMap<(u32, usize), HashMap<u32, CapturedVertex>> {
    let mut edges: HashMap<_, HashMap<_, _>> = HashMap::new();
    for vertex in captured.vertices(factor).expect("a capture") {
        let patch = captured.tables().plan().patches()[vertex.patch as usize];
        for (k, t) in places(patch.kind, vertex.coordinate) {
            edges.entry((patch.face, k)).or_default().insert((t * 65536.0) as u32, vertex);
        }
    }
    edges
}

/// The schemes that are watertight, made in both ways.
fn cases() -> impl Iterator<Item = (Construction, Scheme)> {
    let schemes = Scheme::ALL.into_iter().filter(|scheme| scheme.is_watertight());
    schemes.flat_map(|scheme| Construction::ALL.map(|construction| (construction, scheme)))
}

#[test]
fn control_points_of_shared_edges() {
    let headless = common::headless();
    let meshes = meshes();
    for (construction, scheme) in cases() {
        for (name, mesh, edges) in &meshes {
            let refine = common::steps_to_patches(mesh, scheme);
            let options = ModelOptions { construction, scheme, refine, ..ModelOptions::default() };
            let captured = Captured::new(&headless, mesh, &options).expect("a model");
            let points = captured.control_points().expect("a capture");
            let patches = captured.tables().plan().patches();
            let of_face: HashMap<u32, usize> = patches.iter().enumerate().map(|(i, p)| (p.face, i)).collect();
            for edge in edges {
                let [a, mut b] = edge.sides.map(|(face, k)| {
                    let i = of_face[&face];
                    edge_points(patches[i].kind, &points[i], k)
                });
                b.reverse();
                for (a, b) in a.into_iter().zip(b) {
                    let what = || format!("{name} {scheme:?} {construction:?} {:?}: {a:?} and {b:?}", edge.sides);
                    assert_eq!(bits(a), bits(b), "{}", what());
                }
            }
        }
    }
    headless.finish_silent();
}

#[test]
fn evaluated_vertices_of_shared_edges() {
    let headless = common::headless();
    let meshes = meshes();
    for (construction, scheme) in cases() {
        for (spacing, factor, shared_normals) in [
            (Spacing::Equal, 7.0, false),
            (Spacing::Equal, 7.0, true),
            (Spacing::FractionalOdd, 4.3, true),
            (Spacing::FractionalEven, 4.3, true),
        ] {
            for (name, mesh, edges) in &meshes {
                let refine = common::steps_to_patches(mesh, scheme);
                let options =
                    ModelOptions { construction, scheme, spacing, shared_normals, refine, ..ModelOptions::default() };
                let captured = Captured::new(&headless, mesh, &options).expect("a model");
                let on_edges = on_edges(&captured, factor);
                for edge in edges {
                    let [a, b] = edge.sides.map(|side| &on_edges[&side]);
                    let count = spacing.segments(factor, 64) as usize + 1;
                    assert_eq!((a.len(), b.len()), (count, count), "{name} {spacing:?}");
                    for (t, a) in a {
                        let b = b[&(65536 - t)];
                        let what = || {
                            format!("{name} {scheme:?} {construction:?} {spacing:?} {:?}: {a:?} and {b:?}", edge.sides)
                        };
                        assert_eq!(bits(a.position), bits(b.position), "{}", what());
                        if !edge.smooth {
                            continue;
                        }
                        if shared_normals {
                            assert_eq!(bits(a.normal), bits(b.normal), "{}", what());
                        } else {
                            // Each patch makes normals from its own derivatives: equal to rounding, in units of small faces.
                            let turn = (Vec3::from(a.normal) - Vec3::from(b.normal)).length();
                            assert!(turn < 4e-4, "{turn:e}: {}", what());
                        }
                    }
                }
            }
        }
    }
    headless.finish_silent();
}

/// Two poles with `n` faces each: triangles that meet at an equator, or two belts of quads around each pole.
fn poles(n: u32, quads: bool) -> ControlMesh {
    let at = |i: f64, radius: f64, y: f64| {
        let (sin, cos) = (TAU * i / f64::from(n)).sin_cos();
        [radius * cos, y + 0.05 * (5.0 * TAU * i / f64::from(n)).sin(), radius * sin]
    };
    let mut positions = vec![[0.0, 0.8, 0.0], [0.0, -0.8, 0.0]];
    let mut faces = Vec::new();
    let wrap = |i: u32| i % n;
    if quads {
        // A quad around a pole: the pole, a vertex of the belt, one of the equator, the next of the belt.
        positions.extend((0..n).map(|i| at(i.into(), 0.6, 0.5)));
        positions.extend((0..n).map(|i| at(f64::from(i) + 0.5, 1.0, 0.0)));
        positions.extend((0..n).map(|i| at(i.into(), 0.6, -0.5)));
        let [top, middle, bottom] = [2, 2 + n, 2 + 2 * n];
        for i in 0..n {
            let next = wrap(i + 1);
            faces.push(vec![0, top + next, middle + i, top + i]);
            faces.push(vec![1, bottom + i, middle + i, bottom + next]);
            faces.push(vec![top + next, middle + next, bottom + next, middle + i]);
        }
    } else {
        positions.extend((0..n).map(|i| at(i.into(), 1.0, 0.0)));
        for i in 0..n {
            faces.push(vec![0, 2 + wrap(i + 1), 2 + i]);
            faces.push(vec![1, 2 + i, 2 + wrap(i + 1)]);
        }
    }
    let face_sizes = faces.iter().map(|f| f.len() as u32).collect();
    ControlMesh::new(MeshData { positions, face_sizes, face_vertices: faces.concat(), ..MeshData::default() })
        .expect("closed")
}

#[test]
fn valence_has_no_limit() {
    let headless = common::headless();
    for quads in [false, true] {
        let mesh = poles(500, quads);
        assert_eq!(mesh.boundary_edge_count(), 0);
        let surface = CpuSurface::new(&mesh, Scheme::Gregory, 0).expect("small");
        let points = surface.control_points(|p| p.as_vec3().as_dvec3());
        let expected: HashMap<u32, _> = surface.plan().patches().iter().map(|p| p.face).zip(points).collect();
        for construction in Construction::ALL {
            let options = ModelOptions { construction, ..ModelOptions::default() };
            let captured = Captured::new(&headless, &mesh, &options).expect("a model");
            let patches = captured.tables().plan().patches();
            let points = captured.control_points().expect("a capture");
            assert_eq!(points.len(), mesh.face_count());
            let mut largest: f64 = 0.0;
            for (patch, points) in patches.iter().zip(&points) {
                for (ours, expected) in points.iter().zip(&expected[&patch.face]) {
                    largest = largest.max((Vec3::from(*ours).as_dvec3() - *expected).length());
                }
            }
            // Sums of 1000 terms and more, whose weights add to one: units of rounding at 1. Measured: 2 for the two-stage
            // construction; 9 for stencils of face points, whose weights of both signs are larger.
            let units = largest / f64::from(f32::EPSILON);
            assert!(units < 24.0, "{construction:?}: {units} units");
            // Three samples a side: every patch is evaluated.
            for (patch, samples) in patches.iter().zip(captured.grid(3).expect("a capture")) {
                let parameters = grid_parameters(patch.kind, 3);
                assert_eq!(samples.len(), parameters.len());
                for (sample, [u, v]) in samples.iter().zip(parameters) {
                    let twin = Scheme::Gregory.evaluate(patch.kind, &expected[&patch.face], u, v);
                    let units =
                        (Vec3::from(sample.position).as_dvec3() - twin.position).length() / f64::from(f32::EPSILON);
                    assert!(units < 24.0, "{construction:?}: {units} units at {u} {v}");
                }
            }
        }
    }
    headless.finish_silent();
}
