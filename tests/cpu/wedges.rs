//! Faces of five and more corners, and what is left of a mesh around them.

use crate::common::limit::on_limit;
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::mesh::FaceVarying;
use ash_subdiv::patch::Sample;
use ash_subdiv::table::{CpuSurface, ModelTables, TableOptions, grid_parameters};
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{ControlMesh, MeshData, Scheme, shape};
use glam::DVec3;
use std::collections::BTreeSet;

const GRID: u32 = 9;

/// The torus of 16 by 8 quads with a hexagon in the place of two of them.
fn torus_with_hexagon() -> ControlMesh {
    let torus = shape("torus").expect("built in");
    let twin = torus.twins()[0];
    let around = |h: u32| (1..4).map(move |k| h / 4 * 4 + (h + k) % 4);
    let vertex = |h: u32| torus.data().face_vertices[h as usize];
    let hexagon: Vec<u32> = around(0).chain(around(twin)).map(vertex).collect();
    let left = (0..torus.face_count() as u32).filter(|&face| face != 0 && face != twin / 4);
    let quads: Vec<u32> = left.flat_map(|face| torus.face(face).to_vec()).collect();
    let face_sizes = std::iter::once(6).chain(std::iter::repeat_n(4, quads.len() / 4)).collect();
    let data = MeshData { face_sizes, face_vertices: [hexagon, quads].concat(), ..torus.data().clone() };
    ControlMesh::new(MeshData { texcoords: None, normals: None, ..data }).expect("a manifold")
}

fn samples(surface: &CpuSurface) -> Vec<Vec<Sample<DVec3>>> {
    surface.grid(&surface.control_points(|p| p), GRID)
}

#[test]
fn only_what_touches_a_polygon_is_refined() {
    let mesh = torus_with_hexagon();
    assert_eq!((mesh.face_count(), mesh.boundary_edge_count()), (127, 0));
    let surface = CpuSurface::new(&mesh, Scheme::Gregory, 0).expect("a surface");
    let plan = surface.plan();
    // The hexagon as six wedges, and the ten quads around it.
    assert_eq!((plan.patches().len(), plan.count(PatchKind::Triangle)), (126 + 6, 6));
    assert_eq!(plan.patches().iter().filter(|patch| patch.refined).count(), 6 + 10);
    // Nothing else is planned.
    assert_eq!(surface.adaptive().expect("leaves").roots.len(), 6 + 10);
    assert!(surface.notices().is_empty());
    let corners = plan.patches().iter().filter(|patch| patch.is_wedge()).map(|patch| plan.origin(patch));
    assert_eq!(corners.map(|o| (o.face, o.corner)).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5].map(|k| (0, Some(k))));

    let limit = LimitSurface::new(&mesh).expect("a surface");
    let (mut exact, mut worst) = (0, 0.0f64);
    for ((patch, origin), samples) in plan.patches().iter().zip(surface.origins()).zip(samples(&surface)) {
        for (at, sample) in grid_parameters(patch.kind, GRID).into_iter().zip(samples) {
            let (sub, [u, v]) = on_limit(&mesh, &origin, at);
            let truth = limit.evaluate(origin.face, sub, u, v);
            let away = sample.position.distance(truth.position) / mesh.diagonal();
            worst = worst.max(away);
            exact += usize::from(away < 1e-12);
            assert!(sample.normal.dot(truth.normal) > 0.95, "{origin:?} {at:?}: {sample:?}, not {truth:?}");
        }
    }
    assert!(worst < 1e-2, "{worst:e}");
    assert!(exact > 110 * 81, "{exact} samples of regular faces");
}

#[test]
fn tables_grow_with_the_polygons_not_with_the_mesh() {
    let bytes = |mesh: &ControlMesh, refine: u32| -> u64 {
        let options = TableOptions { refine, ..TableOptions::default() };
        ModelTables::new(mesh, options).expect("tables").bytes().iter().map(|(_, bytes)| bytes).sum()
    };
    let mesh = torus_with_hexagon();
    // Of one hexagon 46 KB at most: as it is, whatever else there is.
    let torus = shape("torus").expect("built in");
    assert!(bytes(&mesh, 0) < bytes(&torus, 0) + 46_000, "{} of {}", bytes(&mesh, 0), bytes(&torus, 0));
}

/// A disc of so many corners with a belt of quads.
fn disc(corners: u32) -> ControlMesh {
    let ring = |radius: f64, y: f64| {
        (0..corners).map(move |i| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / f64::from(corners)).sin_cos();
            [radius * cos, y, radius * sin]
        })
    };
    let quads = (0..corners).flat_map(|i| {
        let next = (i + 1) % corners;
        [i, next, corners + next, corners + i]
    });
    ControlMesh::new(MeshData {
        positions: ring(1.0, 0.0).chain(ring(1.2, -0.4)).collect(),
        face_sizes: std::iter::once(corners).chain(std::iter::repeat_n(4, corners as usize)).collect(),
        face_vertices: (0..corners).rev().chain(quads).collect(),
        ..MeshData::default()
    })
    .expect("a manifold")
}

/// The terms of what is made of a polygon are in proportion to its corners: its centre is a vertex of its own.
#[test]
fn polygons_of_many_corners_are_linear() {
    let bytes = |corners| -> u64 {
        let tables = ModelTables::new(&disc(corners), TableOptions::default()).expect("tables");
        tables.bytes().iter().map(|(_, bytes)| bytes).sum()
    };
    let [few, many] = [500, 5000].map(bytes);
    assert!(many < 11 * few, "{few} and {many}");
}

#[test]
fn wedges_have_edges_and_texture_coordinates_of_their_face() {
    const CORNERS: usize = 5;
    let disc = disc(CORNERS as u32);
    // Of the polygon, which comes first, corner i has (i, i^2): their mean is (2, 6).
    let values = (0..disc.corner_count()).map(|i| [i as f32, (i * i) as f32]).collect();
    let indices = (0..disc.corner_count() as u32).collect();
    let texcoords = Some(FaceVarying { values, indices });
    let mesh = ControlMesh::new(MeshData { texcoords, ..disc.into_data() }).expect("a manifold");
    let surface = CpuSurface::new(&mesh, Scheme::Gregory, 0).expect("a surface");
    let (plan, prepared) = (surface.plan(), surface.prepared());
    let texcoords = plan.texcoords(prepared.topology()).expect("the mesh has some");
    let first = plan.groups().iter().find(|group| group.kind == PatchKind::Triangle).expect("wedges").first_corner;
    for (k, wedge) in texcoords[first..].chunks(3).enumerate() {
        let corner = |i: usize| [i as f32, (i * i) as f32];
        assert_eq!(wedge, [corner(k), corner((k + 1) % CORNERS), [2.0, 6.0]], "{k}");
    }

    // Edges of the mesh are the curves that come first; each spoke is one of its own, whichever wedge asks.
    let edges = prepared.edges(plan);
    let curves: Vec<u32> = edges.records.iter().map(|record| record.part.curve).collect();
    let own: BTreeSet<u32> = curves.iter().copied().filter(|&curve| (curve as usize) < mesh.edge_count()).collect();
    let all: BTreeSet<u32> = curves.iter().copied().collect();
    assert_eq!((own.len(), all.len(), curves.len()), (mesh.edge_count(), curves.len(), mesh.edge_count() + CORNERS));
}
