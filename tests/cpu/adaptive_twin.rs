//! Adaptive surfaces on the CPU.

use crate::common::limit::on_limit;
use ash_subdiv::adaptive::AdaptiveOptions;
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::mesh::Crease;
use ash_subdiv::patch::Sample;
use ash_subdiv::table::{CpuSurface, Notice, TableOptions, grid_parameters};
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{ControlMesh, MeshData, shape, shapes};
use glam::DVec3;

const GRID: u32 = 9;

fn surface(mesh: &ControlMesh, depth: u32) -> CpuSurface {
    let adaptive = Some(AdaptiveOptions { depth, ..AdaptiveOptions::default() });
    CpuSurface::with_options(mesh, &TableOptions { adaptive, ..TableOptions::default() }).expect("a surface")
}

fn samples(surface: &CpuSurface) -> Vec<Vec<Sample<DVec3>>> {
    surface.grid(&surface.control_points(|p| p), GRID)
}

#[test]
fn samples_come_to_the_limit_surface() {
    // Larger meshes have nothing else.
    for info in shapes().iter().filter(|info| !info.name.starts_with("creature")) {
        let mesh = shape(info.name).unwrap();
        let mut before = f64::INFINITY;
        for depth in [0, 2, 5] {
            let surface = surface(&mesh, depth);
            let (limit, origins) = (LimitSurface::new(&mesh).unwrap(), surface.origins());
            let mut worst = 0.0f64;
            for ((patch, origin), samples) in surface.plan().patches().iter().zip(&origins).zip(samples(&surface)) {
                for (at, sample) in grid_parameters(patch.kind, GRID).into_iter().zip(samples) {
                    let (sub, [u, v]) = on_limit(&mesh, origin, at);
                    let truth = limit.evaluate(origin.face, sub, u, v);
                    let away = sample.position.distance(truth.position) / mesh.diagonal();
                    worst = worst.max(away);
                    // The limit surface itself for all leaves but end caps.
                    assert!(patch.kind != PatchKind::Regular || away < 1e-12, "{} {patch:?}: {away:e}", info.name);
                }
            }
            println!("{:16} depth {depth}: {worst:8.1e}", info.name);
            assert!(worst < 1.001 * before || worst < 1e-12, "{} at depth {depth}: {worst:e}", info.name);
            before = worst;
        }
        assert!(before < 1e-5, "{}: {before:e}", info.name);
    }
}

#[test]
fn refined_faces_have_the_points_of_their_leaves() {
    let mesh = shape("machine-part").unwrap();
    let surface = surface(&mesh, 3);
    let plan = surface.adaptive().unwrap();
    let points = surface.control_points(|p| p);
    let vertices =
        plan.points(&surface.prepared().mesh().data().positions.iter().map(|&p| p.into()).collect::<Vec<_>>());
    let mut refined = 0;
    for (patch, points) in surface.plan().patches().iter().zip(&points) {
        let leaves = plan.leaves.iter().filter(|leaf| leaf.face == patch.face);
        let [root, end] = [0, 1].map(|i| plan.face_roots[patch.face as usize + i]);
        assert_eq!(end - root, 1);
        let count: usize = leaves.map(|leaf| leaf.kind.points()).sum();
        let expected = if patch.kind == PatchKind::Regular { 16 } else { count };
        assert_eq!(points.len(), expected);
        refined += usize::from(expected > 20);
        for (i, j) in (0..=10).flat_map(|i| (0..=10).map(move |j| (i, j))) {
            let (u, v) = (f64::from(i) / 10.0, f64::from(j) / 10.0);
            let (ours, theirs) = (surface.evaluate(*patch, points, u, v), plan.evaluate(root, u, v, &vertices));
            assert!(ours.position.distance(theirs.position) < 1e-13 * mesh.diagonal());
            assert!(ours.normal.distance(theirs.normal) < 1e-9 || theirs.normal == DVec3::ZERO);
        }
    }
    assert!(refined > 10, "{refined}");
    assert_eq!(surface.plan().count(PatchKind::Triangle), 0);
}

#[test]
fn single_precision_is_enough() {
    let mesh = shape("machine-part").unwrap();
    let surface = surface(&mesh, 4);
    let single = surface.grid(&surface.control_points(|p| p.as_vec3()), GRID);
    for (a, b) in single.iter().flatten().zip(samples(&surface).iter().flatten()) {
        assert!(a.position.as_dvec3().distance(b.position) < 1e-6 * mesh.diagonal());
    }
}

#[test]
fn sharpness_that_depth_does_not_use_up_is_told() {
    // A cube with a crease along one edge, which ends at both its vertices.
    let cube = shape("cube").unwrap().into_data();
    let creases = vec![Crease { vertices: [cube.face_vertices[0], cube.face_vertices[1]], sharpness: 4.5 }];
    let mesh = ControlMesh::new(MeshData { creases, ..cube }).unwrap();
    let told = |depth, sharp_depth| {
        let adaptive = Some(AdaptiveOptions { depth, sharp_depth, ..AdaptiveOptions::default() });
        let options = TableOptions { adaptive, ..TableOptions::default() };
        CpuSurface::with_options(&mesh, &options).expect("a surface").notices()
    };
    let count = |notices: Vec<Notice>| match notices[..] {
        [] => 0,
        [Notice::RoundedCaps { count }] => count,
        ref other => panic!("{other:?}"),
    };
    let depths = [(0, None), (2, None), (2, Some(4)), (2, Some(5))];
    let [none, two, four, five] = depths.map(|(depth, sharp)| count(told(depth, sharp)));
    assert!(none > 0 && two > 0 && four > 0 && five == 0, "{none} {two} {four} {five}");
    assert_eq!(surface(&shape("creature").unwrap(), 0).notices(), []);
    assert_eq!(
        Notice::RoundedCaps { count: 12 }.to_string(),
        "12 end caps have creases or corners whose sharpness is not used up at their level, and draw them infinitely \
         sharp or smooth: a greater depth, or depth of sharp features, follows them"
    );
}
