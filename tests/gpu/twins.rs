//! The shaders against their CPU twins: control points and evaluated vertices, captured.

use crate::common;
use ash_subdiv::capture::Captured;
use ash_subdiv::headless::{Headless, HeadlessOptions};
use ash_subdiv::table::{CpuSurface, Patch, PatchId, TableOptions};
use ash_subdiv::{Construction, ControlMesh, ModelOptions, Spacing, shape};
use ash_subdiv::{Fallback, Scheme};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

const SHAPES: [&str; 12] = [
    "cube",
    "tetrahedron",
    "torus",
    "creature",
    "creature-mixed",
    "cloth",
    "valences",
    "polygons",
    "machine-part",
    "strip",
    "single-quad",
    "fan",
];

fn headless() -> Headless {
    Headless::new(&HeadlessOptions { validation: true, ..HeadlessOptions::default() }).expect("a Vulkan device")
}

/// A few units in the last place of the largest coordinate.
fn tolerance(mesh: &ControlMesh) -> f64 {
    let [low, high] = mesh.bounds();
    8.0 * f64::from(f32::EPSILON) * low.abs().max(high.abs()).max_element()
}

/// Every shape with every scheme; faces without patches fall back.
fn cases() -> impl Iterator<Item = (&'static str, ControlMesh, Scheme)> {
    let shapes = SHAPES.map(|name| (name, shape(name).expect("built in")));
    let all = shapes.into_iter().chain([("pentagons", common::pentagons())]);
    // Scheme by scheme, so that all shapes can use the same pipelines.
    Scheme::ALL.into_iter().flat_map(move |scheme| all.clone().map(move |(name, mesh)| (name, mesh, scheme)))
}

const FALLBACK: Fallback = Fallback::Gregory;

/// The control points of the twin by face and part, since each construction sorts patches in its own way.
fn reference(mesh: &ControlMesh, scheme: Scheme) -> HashMap<PatchId, (Patch, Vec<DVec3>)> {
    let surface = CpuSurface::with_options(
        mesh,
        &TableOptions {
            refine: common::steps_to_patches(mesh, scheme),
            scheme,
            fallback: FALLBACK,
            ..TableOptions::default()
        },
    )
    .expect("small");
    // The GPU starts from f32 positions.
    let points = surface.control_points(|position| position.as_vec3().as_dvec3());
    surface.plan().patches().iter().zip(points).map(|(patch, points)| (patch.id, (*patch, points))).collect()
}

#[test]
fn control_points() {
    let headless = headless();
    for (name, mesh, scheme) in cases() {
        let (expected, tolerance) = (reference(&mesh, scheme), tolerance(&mesh));
        for construction in Construction::ALL {
            let refine = common::steps_to_patches(&mesh, scheme);
            let options = ModelOptions { scheme, fallback: FALLBACK, construction, refine, ..ModelOptions::default() };
            let captured = Captured::new(&headless, &mesh, &options).expect("a model");
            let points = captured.control_points().expect("a capture");
            let tables = captured.tables();
            assert_eq!(points.len(), expected.len(), "{name}");
            for (patch, points) in tables.plan().patches().iter().zip(points) {
                let (twin, expected) = &expected[&patch.id];
                assert_eq!((patch, points.len()), (twin, expected.len()), "{name} {patch:?}");
                for (i, (ours, expected)) in points.iter().zip(expected).enumerate() {
                    let error = (Vec3::from(*ours).as_dvec3() - *expected).length();
                    assert!(
                        error < tolerance,
                        "{name} {scheme:?} {construction:?} {twin:?} point {i}: {ours:?}, not {expected}"
                    );
                }
            }
        }
    }
    headless.finish_silent();
}

#[test]
fn grids() {
    let headless = headless();
    for (name, mesh, scheme) in cases() {
        let (expected, tolerance) = (reference(&mesh, scheme), tolerance(&mesh));
        for construction in Construction::ALL {
            let refine = common::steps_to_patches(&mesh, scheme);
            let options = ModelOptions { scheme, fallback: FALLBACK, construction, refine, ..ModelOptions::default() };
            let captured = Captured::new(&headless, &mesh, &options).expect("a model");
            let tables = captured.tables();
            for (patch, samples) in tables.plan().patches().iter().zip(captured.grid(6).expect("a capture")) {
                let (patch, points) = &expected[&patch.id];
                let parameters = ash_subdiv::table::grid_parameters(patch.kind, 6);
                assert_eq!(samples.len(), parameters.len());
                for (sample, [u, v]) in samples.iter().zip(parameters) {
                    let twin = patch.scheme.evaluate(patch.kind, points, u, v);
                    check((name, tolerance), sample.position, sample.normal, twin);
                }
            }
        }
    }
    headless.finish_silent();
}

fn check((name, tolerance): (&str, f64), position: [f32; 3], normal: [f32; 3], twin: ash_subdiv::patch::Sample<DVec3>) {
    let error = (Vec3::from(position).as_dvec3() - twin.position).length();
    assert!(error < tolerance, "{name}: {position:?}, not {}: off by {error}", twin.position);
    let normal = Vec3::from(normal).as_dvec3();
    let error = (normal - twin.normal).length();
    // The quartic pieces of Pm-patches are found by more differences than the others' points.
    assert!(error < 4e-4, "{name}: normal {normal}, not {}: off by {error}", twin.normal);
}

#[test]
fn evaluated_vertices() {
    let headless = headless();
    let few = cases().filter(|(name, ..)| ["creature", "creature-mixed", "cloth", "pentagons"].contains(name));
    let few: Vec<_> = few.map(|(name, mesh, scheme)| (name, reference(&mesh, scheme), mesh, scheme)).collect();
    for construction in Construction::ALL {
        for (spacing, factors) in
            [(Spacing::Equal, &[1.0, 7.0][..]), (Spacing::FractionalOdd, &[4.3]), (Spacing::FractionalEven, &[4.3])]
        {
            for (&(name, ref expected, ref mesh, scheme), &factor) in
                few.iter().flat_map(|case| factors.iter().map(move |factor| (case, factor)))
            {
                let tolerance = tolerance(mesh);
                let refine = common::steps_to_patches(mesh, scheme);
                let options = ModelOptions {
                    scheme,
                    fallback: FALLBACK,
                    construction,
                    spacing,
                    refine,
                    ..ModelOptions::default()
                };
                let captured = Captured::new(&headless, mesh, &options).expect("a model");
                let tables = captured.tables();
                let vertices = captured.vertices(factor).expect("a capture");
                let mut seen = vec![0; tables.plan().patches().len()];
                for vertex in &vertices {
                    seen[vertex.patch as usize] += 1;
                    let (patch, points) = &expected[&tables.plan().patches()[vertex.patch as usize].id];
                    let [u, v, _] = vertex.coordinate.map(f64::from);
                    let twin = patch.scheme.evaluate(patch.kind, points, u, v);
                    check((name, tolerance), vertex.position, vertex.normal, twin);
                }
                for (patch, seen) in tables.plan().patches().iter().zip(seen) {
                    let domain = match patch.kind.is_triangular() {
                        true => ash_subdiv::headless::objects::Domain::Triangles,
                        false => ash_subdiv::headless::objects::Domain::Quads,
                    };
                    let count = ash_subdiv::headless::objects::tessellated_vertices(domain, spacing, factor, 64);
                    assert!(seen >= count, "{name} {spacing:?} {factor}: {seen} vertices of {count}");
                }
            }
        }
    }
    headless.finish_silent();
}
