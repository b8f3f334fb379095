//! Patches by leaves: they cover each face, and every edge of one is an edge of its neighbour.

use crate::common::random::{random_creased_mesh, random_mesh};
use ash_subdiv::adaptive::{AdaptiveOptions, DrawnBy};
use ash_subdiv::renderer::{EdgeTable, ModelTables};
use ash_subdiv::table::{Evaluation, TableOptions};
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{ControlMesh, Scheme, shape, shapes};
use std::collections::{HashMap, HashSet};

fn tables(mesh: &ControlMesh, adaptive: Option<AdaptiveOptions>) -> ModelTables {
    ModelTables::new(mesh, TableOptions { edge_factors: true, adaptive, ..TableOptions::default() }).expect("tables")
}

fn by_leaves(depth: u32, sharp_depth: Option<u32>) -> AdaptiveOptions {
    AdaptiveOptions { depth, sharp_depth, drawn_by: DrawnBy::Leaves, ..AdaptiveOptions::default() }
}

/// The number of patches at each edge.
fn patches_at(edges: &EdgeTable) -> Vec<usize> {
    let mut patches = vec![0; edges.records.len()];
    edges.of_corners.iter().for_each(|&edge| patches[edge as usize] += 1);
    patches
}

fn meshes() -> impl Iterator<Item = (String, ControlMesh)> {
    let built_in = shapes().iter().map(|info| (info.name.to_owned(), shape(info.name).expect("built in")));
    let random = (0..8).map(|seed| (format!("random {seed}"), random_mesh(seed)));
    let creased = (0..8).map(|seed| (format!("creased {seed}"), random_creased_mesh(seed)));
    built_in.chain(random).chain(creased)
}

#[test]
fn every_edge_is_one_of_both_patches_beside_it() {
    let mut halved = 0;
    for (name, mesh) in meshes() {
        // The curves of the control mesh's edges come first, in the order of the edges.
        let twins = mesh.twins();
        let lower: Vec<usize> = (0..mesh.corner_count()).filter(|&h| twins[h] as usize > h).collect();
        let is_open: Vec<bool> = lower.iter().map(|&h| twins[h] as usize >= mesh.corner_count()).collect();
        for (depth, sharp_depth) in [(0, None), (2, None), (1, Some(4))] {
            let tables = tables(&mesh, Some(by_leaves(depth, sharp_depth)));
            let edges = tables.edges().expect("asked for");
            let mut lengths = vec![0.0; is_open.len()];
            for (record, patches) in edges.records.iter().zip(patches_at(edges)) {
                let curve = record.part.curve as usize;
                if let Some(length) = lengths.get_mut(curve) {
                    *length += 0.5_f64.powi(record.part.level.into());
                    halved += usize::from(record.part.level > 0);
                }
                let expected = if is_open.get(curve) == Some(&true) { 1 } else { 2 };
                assert!(patches == expected, "{name} depth {depth}: {record:?} has {patches} patches");
            }
            // Nothing is left out or there twice.
            assert!(lengths.iter().all(|&length| length == 1.0), "{name} depth {depth}: {lengths:?}");
        }
    }
    assert!(halved > 5000, "{halved}");
}

/// The area of each face in its (u, v), and each cell once.
#[test]
fn patches_cover_each_face_once() {
    for (name, mesh) in meshes() {
        let tables = tables(&mesh, Some(by_leaves(2, Some(3))));
        let mut areas: HashMap<(u32, Option<u32>), f64> = HashMap::new();
        let mut cells = HashSet::new();
        for (number, (patch, origin)) in tables.plan().patches().iter().zip(tables.origins()).enumerate() {
            let triangle = patch.kind == PatchKind::Triangle;
            let corners = tables.cell_corners(number).expect("by leaves");
            assert_eq!(corners.len(), patch.kind.corners());
            let of = |i: usize, j: usize| corners[i][0] * corners[j][1] - corners[i][1] * corners[j][0];
            let doubled: f64 = (0..corners.len()).map(|i| of(i, (i + 1) % corners.len())).sum();
            assert!(doubled > 0.0, "{name}: {origin:?} turns the other way");
            let is_quad = mesh.face(origin.face).len() == 4;
            let side = 0.5_f64.powi(origin.id.level() as i32 - i32::from(!is_quad));
            *areas.entry((origin.face, origin.corner)).or_default() += 0.5 * doubled * side * side;
            let cell = (origin.face, origin.corner, origin.id.level(), origin.id.u(), origin.id.v());
            assert!(cells.insert(cell) || triangle, "{name}: {origin:?} is there twice");
            // Beside finer ones there are triangles, and nowhere else.
            assert_eq!(origin.id.transition() != 0, triangle, "{name}: {origin:?}");
        }
        let parts = (0..mesh.face_count() as u32).map(|face| mesh.face(face).len());
        assert_eq!(areas.len(), parts.map(|size| if size == 4 { 1 } else { size }).sum::<usize>(), "{name}");
        assert!(areas.values().all(|&area| area == 1.0), "{name}: {areas:?}");
    }
}

#[test]
fn patches_by_leaves_that_there_are_not() {
    let mesh = shape("tetrahedron").expect("built in");
    assert_eq!(tables(&mesh, None).cell_corners(0), None);
    assert_eq!(tables(&mesh, Some(AdaptiveOptions::default())).cell_corners(0), None);
    let by_leaves = by_leaves(6, None);
    assert_eq!(tables(&mesh, Some(by_leaves)).cell_corners(usize::MAX), None);
    let adaptive = Some(by_leaves);
    let told = |options: TableOptions| ModelTables::new(&mesh, options).map(|_| ()).unwrap_err().to_string();
    assert_eq!(
        told(TableOptions { refine: 5, adaptive, ..TableOptions::default() }),
        "the mesh has 11 levels of refinement: at most 10 can be addressed"
    );
    assert_eq!(
        told(TableOptions { evaluation: Evaluation::Instanced, adaptive, ..TableOptions::default() }),
        "evaluation by instanced has no patches by leaves: only by tessellation there are such; draw by faces"
    );
}

/// Those of Niessner et al. (2012), where each face has its leaves.
#[test]
fn whole_leaves_and_triangles_are_as_many_as_the_plan_says() {
    let mesh = shape("valences").expect("built in");
    for depth in 0..4 {
        let tables = tables(&mesh, Some(by_leaves(depth, None)));
        let plan = ash_subdiv::adaptive::Plan::new(
            &ash_subdiv::topology::Topology::new(&mesh),
            Scheme::Gregory,
            &by_leaves(depth, None),
        )
        .expect("a plan");
        let halved: u32 = plan.leaves.iter().map(|leaf| leaf.transition.count_ones()).sum();
        let with = plan.leaves.iter().filter(|leaf| leaf.transition != 0).count() as u32;
        assert_eq!(tables.patch_count(PatchKind::IrregularQuad), plan.leaves.len() as u32 - with);
        // A fan over the corners of a leaf and the middles of its edges has two triangles fewer than these are.
        assert_eq!(tables.patch_count(PatchKind::Triangle), 2 * with + halved);
    }
}
