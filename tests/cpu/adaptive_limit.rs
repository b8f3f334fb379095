//! Plans of adaptive subdivision against reference limit surfaces, and of creases of any sharpness.

use crate::adaptive::{Distance, Planned, distance, distance_at_samples, shared_mesh};
use crate::common::limit::{mesh_and_limit, names};
use ash_subdiv::adaptive::{AdaptiveOptions, Leaf, LeafKind, Reason};
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::mesh::SHARPNESS_INFINITE;
use ash_subdiv::{ControlMesh, Scheme, shape};

/// The largest distance of a plan's samples from those of a reference, over the diagonal.
fn distance_from_reference(name: &str, depth: u32) -> f64 {
    let (mesh, limit) = mesh_and_limit(name);
    let planned = Planned::at_depth(&mesh, depth);
    let last = (limit.side - 1) as f64;
    let mut distance = 0.0f64;
    for record in &limit.records {
        let root = planned.plan.face_roots[record.face as usize] + record.sub.max(0) as u32;
        for (index, theirs) in record.samples.iter().enumerate() {
            let (u, v) = ((index % limit.side) as f64 / last, (index / limit.side) as f64 / last);
            let ours = planned.plan.evaluate(root, u, v, &planned.points);
            distance = distance.max((ours.position - theirs.position).length() / mesh.diagonal());
        }
    }
    distance
}

#[test]
fn reference_limits_are_met() {
    for name in names().iter().filter(|name| *name != "catmark_fan") {
        let distances = [0, 1, 3, 5].map(|depth| distance_from_reference(name, depth));
        println!("{name:28} {:8.1e} {:8.1e} {:8.1e} {:8.1e}", distances[0], distances[1], distances[2], distances[3]);
        assert!(distances[3] < 1e-5, "{name}: {distances:?}");
    }
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn creases_of_all_kinds_come_to_their_limit() {
    for name in [
        "catmark_cube_creases0",
        "catmark_cube_creases1",
        "catmark_cube_corner0",
        "catmark_cube_corner1",
        "catmark_cube_corner2",
        "catmark_pyramid_creases0",
        "catmark_pyramid_creases1",
        "catmark_tent_creases0",
        "catmark_torus_creases0",
        "catmark_dart_edgeonly",
        "catmark_inf_crease0",
        "catmark_single_crease",
        "catmark_chaikin0",
        "car",
        "rook",
    ] {
        let mesh = shared_mesh(name);
        let surface = LimitSurface::new(&mesh).unwrap();
        for depth in [0, 2, 5] {
            let planned = Planned::at_depth(&mesh, depth);
            let Distance { exact, slope, caps, lift } = distance(&planned, &surface);
            let samples = distance_at_samples(&planned, &surface);
            println!(
                "{name:28} depth {depth}: {exact:8.1e} {slope:8.1e} caps {caps:8.1e} {lift:8.1e} samples {samples:8.1e}"
            );
            println!("    {:?}", planned.plan.counts());
            assert!(exact < 1e-12 && slope < 1e-8, "{name} at depth {depth}: {exact:e} {slope:e}");
        }
    }
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn any_sharpness_comes_to_its_limit() {
    for name in ["catmark_single_crease", "catmark_cube_creases0", "catmark_torus_creases0"] {
        let mesh = shared_mesh(name);
        for quarters in 0..=32 {
            let sharpness = quarters as f32 / 4.0;
            let mut data = mesh.clone().into_data();
            data.creases.iter_mut().for_each(|crease| crease.sharpness = sharpness);
            let mesh = ControlMesh::new(data).unwrap();
            let surface = LimitSurface::new(&mesh).unwrap();
            let planned = Planned::at_depth(&mesh, 5);
            let Distance { exact, slope, .. } = distance(&planned, &surface);
            let samples = distance_at_samples(&planned, &surface);
            println!("{name:28} {sharpness}: {exact:8.1e} {slope:8.1e} samples {samples:8.1e}");
            assert!(exact < 1e-12 && slope < 1e-8, "{name} at {sharpness}: {exact:e} {slope:e}");
            assert!(samples < 1e-5, "{name} at {sharpness}: {samples:e}");
        }
    }
}

/// The same surface without leaves that follow creases, and ever more of others.
#[test]
fn creases_can_be_refined() {
    let mut data = shape("machine-part").unwrap().into_data();
    let finite = data.creases.iter_mut().filter(|crease| crease.sharpness < SHARPNESS_INFINITE);
    finite.for_each(|crease| crease.sharpness = 2.5);
    let mesh = ControlMesh::new(data).unwrap();
    let surface = LimitSurface::new(&mesh).unwrap();
    let mut before = 0;
    for depth in 1..=3 {
        let options =
            AdaptiveOptions { depth: 1, sharp_depth: Some(depth), refine_creases: true, ..AdaptiveOptions::default() };
        let planned = Planned::new(&mesh, Scheme::Gregory, &options);
        let follows = |leaf: &&Leaf| matches!(leaf.kind, LeafKind::SingleCrease { .. });
        let (following, leaves) = (planned.plan.leaves.iter().filter(follows).count(), planned.plan.leaves.len());
        // At level 3 nothing is left of the sharpness.
        assert!(leaves > before && (following == 0) == (depth == 3), "depth {depth}: {following} of {leaves}");
        assert!(planned.plan.refined.iter().any(|cell| cell.reason == Reason::Crease));
        let Distance { exact, slope, .. } = distance(&planned, &surface);
        assert!(exact < 1e-12 && slope < 1e-9, "depth {depth}: {exact:e} {slope:e}");
        before = leaves;
    }
    let options = AdaptiveOptions { depth: 1, sharp_depth: Some(3), ..AdaptiveOptions::default() };
    assert!(before > 2 * Planned::new(&mesh, Scheme::Gregory, &options).plan.leaves.len());
}
