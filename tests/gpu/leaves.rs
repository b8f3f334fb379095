//! Adaptive surfaces on the GPU: every evaluation draws the limit surface, and neighbouring faces meet to the bit.

use crate::common;
use crate::common::limit::{mesh_and_limit, names, on_limit};
use ash_subdiv::adaptive::{AdaptiveOptions, DrawnBy, Sums};
use ash_subdiv::capture::Captured;
use ash_subdiv::headless::Headless;
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::renderer::Evaluation;
use ash_subdiv::table::{CpuSurface, FaceOrigin, ModelTables, TableOptions, grid_parameters};
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{Construction, ControlMesh, ModelOptions, shape, shapes};
use glam::Vec3;
use std::collections::HashMap;

/// Samples along each side of a face: those of small meshes fall into end caps, too.
fn grid(mesh: &ControlMesh) -> u32 {
    if mesh.face_count() < 30 { 50 } else { 9 }
}

fn adaptive(depth: u32, construction: Construction) -> ModelOptions {
    let adaptive = Some(AdaptiveOptions { depth, ..AdaptiveOptions::default() });
    ModelOptions { adaptive, construction, ..ModelOptions::default() }
}

fn diagonal(mesh: &ControlMesh) -> f64 {
    let [low, high] = mesh.bounds();
    (high - low).length()
}

/// The largest distances of irregular faces from the limit surface, of positions as parts of the mesh's diagonal, and of normals at
/// inner samples.
fn distance(headless: &Headless, mesh: &ControlMesh, options: &ModelOptions) -> [f64; 2] {
    let surface = LimitSurface::new(mesh).expect("a surface");
    let captured = Captured::new(headless, mesh, options).expect("a model");
    let grid = grid(mesh);
    let samples = captured.grid(grid).expect("a capture");
    let plan = captured.tables().plan();
    let (mut of_positions, mut of_normals) = (0.0_f64, 0.0_f64);
    for ((patch, origin), samples) in plan.patches().iter().zip(plan.origins()).zip(&samples) {
        for (at, sample) in grid_parameters(patch.kind, grid).into_iter().zip(samples) {
            let (sub, [u, v]) = on_limit(mesh, &origin, at);
            let limit = surface.evaluate(origin.face, sub, u, v);
            let away = (Vec3::from(sample.position).as_dvec3() - limit.position).length();
            of_positions = of_positions.max(away / diagonal(mesh));
            let inner = [u, v].iter().all(|t| (0.1..0.9).contains(t));
            if inner && limit.normal.length() > 0.5 {
                let normal = Vec3::from(sample.normal).as_dvec3().normalize_or_zero();
                of_normals = of_normals.max((normal - limit.normal).length());
            }
        }
    }
    [of_positions, of_normals]
}

#[test]
fn samples_come_to_the_limit_surface() {
    let headless = common::headless();
    for info in shapes() {
        let mesh = shape(info.name).expect("built in");
        let mut before = f64::INFINITY;
        let ways = [(0, Sums::Levels), (2, Sums::Composed), (5, Sums::Levels)];
        for ((depth, sums), construction) in ways.into_iter().zip(Construction::ALL) {
            let adaptive = Some(AdaptiveOptions { depth, sums, ..AdaptiveOptions::default() });
            let options = ModelOptions { adaptive, construction, ..ModelOptions::default() };
            let [positions, normals] = distance(&headless, &mesh, &options);
            println!("{:16} depth {depth}: {positions:8.1e} normals {normals:8.1e}", info.name);
            assert!(positions < 1.001 * before || positions < 1e-6, "{} at depth {depth}: {positions:e}", info.name);
            before = positions;
            if depth == 5 {
                // End caps are not the surface itself; samples of larger meshes lie between them.
                let most = if mesh.face_count() < 30 { 1e-3 } else { 1e-5 };
                assert!(positions < most, "{}: {positions:e}", info.name);
                assert!(normals < 2e-3, "{}: {normals:e}", info.name);
            }
        }
    }
    headless.finish_silent();
}

/// Where a patch by leaves has a point of its own parameters: the part of the face, and (u, v) there.
fn by_leaves_on_limit(
    mesh: &ControlMesh,
    tables: &ModelTables,
    patch: usize,
    [u, v]: [f64; 2],
) -> (FaceOrigin, i32, [f64; 2]) {
    let (kind, origin) = (tables.plan().patches()[patch].kind, tables.origins()[patch]);
    let triangle = kind == PatchKind::Triangle;
    let corners = tables.cell_corners(patch).expect("by leaves");
    let weights = match triangle {
        true => vec![u, v, 1.0 - u - v],
        false => vec![(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v],
    };
    let [u, v] = [0, 1].map(|i| corners.iter().zip(&weights).map(|(corner, weight)| corner[i] * weight).sum::<f64>());
    // A part of a face other than a quad begins at level 1.
    let is_quad = mesh.face(origin.face).len() == 4;
    let side = 0.5_f64.powi(origin.id.level() as i32 - i32::from(!is_quad));
    let sub = if is_quad { -1 } else { origin.corner.expect("a part") as i32 };
    (origin, sub, [(f64::from(origin.id.u()) + u) * side, (f64::from(origin.id.v()) + v) * side])
}

/// Patches by leaves, whole ones and triangles beside finer ones, have the points of the limit surface that their places say.
#[test]
fn patches_by_leaves_are_the_limit_surface() {
    let headless = common::headless();
    let mut triangles = 0;
    for name in ["machine-part", "polygons", "cloth", "cube", "fan"] {
        let mesh = shape(name).expect("built in");
        let surface = LimitSurface::new(&mesh).expect("a surface");
        let mut before = f64::INFINITY;
        for (depth, sharp_depth) in [(1, None), (4, Some(5))] {
            let adaptive =
                AdaptiveOptions { depth, sharp_depth, drawn_by: DrawnBy::Leaves, ..AdaptiveOptions::default() };
            let options = ModelOptions { adaptive: Some(adaptive), ..ModelOptions::default() };
            let captured = Captured::new(&headless, &mesh, &options).expect("a model");
            let (samples, tables) = (captured.grid(3).expect("a capture"), captured.tables());
            let patches = tables.plan().patches();
            triangles += tables.patch_count(PatchKind::Triangle);
            let (mut worst, mut regular) = (0.0_f64, 0.0_f64);
            for (patch, samples) in samples.iter().enumerate() {
                for (at, sample) in grid_parameters(patches[patch].kind, 3).into_iter().zip(samples) {
                    let (origin, sub, [u, v]) = by_leaves_on_limit(&mesh, tables, patch, at);
                    let limit = surface.evaluate(origin.face, sub, u, v);
                    let away = (Vec3::from(sample.position).as_dvec3() - limit.position).length() / diagonal(&mesh);
                    assert!(away.is_finite(), "{name}: {origin:?} was not drawn");
                    worst = worst.max(away);
                    if origin.id.level() < depth {
                        regular = regular.max(away);
                    }
                }
            }
            println!("{name:16} depth {depth}: {worst:8.1e}, away from end caps {regular:8.1e}");
            // Of those that touch the caps of neighbours, edges are the caps'.
            assert!(worst < 1.001 * before && regular < 1e-6, "{name} at depth {depth}: {worst:e}, {regular:e}");
            before = worst;
        }
        assert!(before < 5e-3, "{name}: {before:e}");
    }
    assert!(triangles > 1000, "{triangles}");
    headless.finish_silent();
}

/// Inside, patches by leaves have the points that faces find in the same leaves, end caps too.
#[test]
fn patches_by_leaves_are_those_leaves() {
    let headless = common::headless();
    let mut compared = 0;
    for name in ["machine-part", "valences", "cube"] {
        let mesh = shape(name).expect("built in");
        let adaptive = Some(AdaptiveOptions { depth: 2, drawn_by: DrawnBy::Leaves, ..AdaptiveOptions::default() });
        let options = ModelOptions { adaptive, ..ModelOptions::default() };
        let captured = Captured::new(&headless, &mesh, &options).expect("a model");
        let (samples, tables) = (captured.grid(5).expect("a capture"), captured.tables());
        let surface =
            CpuSurface::with_options(&mesh, &TableOptions { adaptive, ..TableOptions::default() }).expect("patches");
        let vertices = surface.vertices(|p| p);
        let of_face: HashMap<_, _> = surface.plan().patches().iter().map(|patch| (patch.face, *patch)).collect();
        for (patch, samples) in samples.iter().enumerate() {
            let kind = tables.plan().patches()[patch].kind;
            for (at, sample) in grid_parameters(kind, 5).into_iter().zip(samples) {
                // On edges some are of the neighbour's leaf.
                let third = if kind == PatchKind::Triangle { 1.0 - at[0] - at[1] } else { 0.5 };
                if [at[0], at[1], third].into_iter().any(|t| !(0.1..0.9).contains(&t)) {
                    continue;
                }
                let (origin, _, [u, v]) = by_leaves_on_limit(&mesh, tables, patch, at);
                let of_face = of_face[&origin.face];
                let expected = surface.evaluate(of_face, &surface.points_of(of_face, &vertices), u, v);
                let away = (Vec3::from(sample.position).as_dvec3() - expected.position).length() / diagonal(&mesh);
                let turned = (Vec3::from(sample.normal).as_dvec3().normalize_or_zero() - expected.normal).length();
                assert!(away < 2e-7 && turned < 1e-4, "{name} {origin:?} at {at:?}: {away:e}, {turned:e}");
                compared += 1;
            }
        }
    }
    assert!(compared > 20_000, "{compared}");
    headless.finish_silent();
}

/// What `../shared` holds of other programs' surfaces, where that is.
#[test]
fn samples_are_those_of_reference_surfaces() {
    let headless = common::headless();
    let mut compared = 0;
    // That has edges of three faces.
    for name in names().into_iter().filter(|name| name != "catmark_fan") {
        let (mesh, limit) = mesh_and_limit(&name);
        if mesh.face_count() > 2000 {
            continue;
        }
        let options = adaptive(5, Construction::Stencil);
        let captured = Captured::new(&headless, &mesh, &options).expect("a model");
        let samples = captured.grid(limit.side as u32).expect("a capture");
        let (mut worst, plan) = (0.0_f64, captured.tables().plan());
        let records: HashMap<_, _> = limit.records.iter().map(|record| ((record.face, record.sub), record)).collect();
        for ((patch, origin), samples) in plan.patches().iter().zip(plan.origins()).zip(&samples) {
            for (at, sample) in grid_parameters(patch.kind, limit.side as u32).into_iter().zip(samples) {
                // Those of wedges are samples of their parts, too.
                let (sub, at) = on_limit(&mesh, &origin, at);
                let Some(record) = records.get(&(origin.face, sub)) else { continue };
                let [i, j] = at.map(|t| (t * (limit.side - 1) as f64).round() as usize);
                let expected = &record.samples[j * limit.side + i];
                let away = (Vec3::from(sample.position).as_dvec3() - expected.position).length();
                worst = worst.max(away / diagonal(&mesh));
                compared += 1;
            }
        }
        println!("{name:28} {worst:8.1e}");
        assert!(worst < 1e-5, "{name}: {worst:e}");
    }
    let least = if cfg!(shared) { 20_000 } else { 800 };
    assert!(compared > least, "{compared} samples");
    headless.finish_silent();
}

/// The vertices of irregular faces by face and place.
fn vertices(
    headless: &Headless,
    mesh: &ControlMesh,
    options: &ModelOptions,
) -> HashMap<(u32, [u32; 2]), [[f32; 3]; 2]> {
    const SEGMENTS: f32 = 8.0;
    let captured = Captured::new(headless, mesh, options).expect("a model");
    let patches = captured.tables().plan().patches();
    let place = |coordinate: [f32; 3]| [coordinate[0], coordinate[1]].map(|x| (x * 65536.0).round() as u32);
    let vertices = captured.vertices(SEGMENTS).expect("a capture").into_iter();
    let of_patch = |vertex: &ash_subdiv::capture::CapturedVertex| patches[vertex.patch as usize];
    let refined = vertices.filter(|vertex| of_patch(vertex).refined);
    refined.map(|v| ((of_patch(&v).face, place(v.coordinate)), [v.position, v.normal])).collect()
}

#[test]
fn every_evaluation_draws_the_same_leaves() {
    let headless = common::headless();
    for name in ["creature", "machine-part", "polygons"] {
        let mesh = shape(name).expect("built in");
        let expected = vertices(&headless, &mesh, &adaptive(3, Construction::TwoStage));
        assert!(expected.len() > 500, "{name}");
        let uniform_grids = [Evaluation::Instanced, Evaluation::Geometry, Evaluation::GeometryTwoPass];
        for evaluation in [Evaluation::Tessellation].into_iter().chain(uniform_grids) {
            for &construction in evaluation.constructions() {
                let options = ModelOptions { evaluation, ..adaptive(3, construction) };
                let vertices = vertices(&headless, &mesh, &options);
                let mut compared = 0;
                // Next to faces that are not refined, constructions differ by rounding.
                let same = |a: [f32; 3], b: [f32; 3]| Vec3::from(a).distance(Vec3::from(b)) < 1e-5;
                for (place, [position, normal]) in &vertices {
                    // Inside wedges the tessellator has vertices elsewhere.
                    let Some(&[p, n]) = expected.get(place) else { continue };
                    compared += 1;
                    assert!(
                        same(*position, p),
                        "{name} {evaluation:?} {construction:?} {place:?}: {position:?}, not {p:?}"
                    );
                    let [normal, n] = [*normal, n].map(|n| Vec3::from(n).normalize_or_zero().to_array());
                    assert!(
                        Vec3::from(normal).distance(Vec3::from(n)) < 1e-3,
                        "{name} {evaluation:?} {construction:?} {place:?}: normal {normal:?}, not {n:?}"
                    );
                }
                let least = if name == "polygons" { 1000 } else { expected.len() };
                assert!(compared >= least, "{name} {evaluation:?} {construction:?}: {compared} of {}", expected.len());
            }
        }
    }
    headless.finish_silent();
}

#[test]
fn what_cannot_be_refined_is_refused() {
    let error = |mesh: &ControlMesh, options: &ModelOptions| ModelTables::new(mesh, options).err().unwrap().to_string();
    let cube = shape("cube").expect("built in");
    let deep = adaptive(11, Construction::TwoStage);
    assert_eq!(error(&cube, &deep), "depth 11: adaptive subdivision goes 10 levels deep at most");
    let scheme = ash_subdiv::Scheme::Acc;
    let acc = ModelOptions { scheme, ..adaptive(2, Construction::TwoStage) };
    assert_eq!(error(&cube, &acc), "scheme acc: end caps are patches of gregory or gregory-fitted");
    let evaluation = Evaluation::Subdivision;
    let subdivided = ModelOptions { evaluation, ..adaptive(2, Construction::TwoStage) };
    assert_eq!(error(&cube, &subdivided), "evaluation by subdivision has no patches: it cannot be adaptive");
}
