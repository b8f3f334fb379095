//! A million faces through both tables.

use ash_subdiv::renderer::ModelTables;
use ash_subdiv::table::{RingTable, StencilTable, prepare};
use ash_subdiv::topology::{PatchKind, Topology};
use ash_subdiv::{Construction, ControlMesh, Fallback, ModelOptions, Scheme, grid_torus};

const SIDE: u32 = 1000;
const FACES: u32 = SIDE * SIDE;

#[test]
fn a_million_faces() {
    let mesh = ControlMesh::new(grid_torus(SIDE, SIDE)).expect("a torus");
    assert_eq!((mesh.face_count() as u32, mesh.vertex_count() as u32), (FACES, FACES));
    assert_eq!((mesh.edge_count() as u32, mesh.boundary_edge_count()), (2 * FACES, 0));
    for construction in Construction::ALL {
        let tables =
            ModelTables::new(&mesh, &ModelOptions { construction, ..ModelOptions::default() }).expect("tables");
        assert_eq!(PatchKind::ALL.map(|kind| tables.patch_count(kind)), [FACES, 0, 0, 0]);
        assert_eq!(tables.type_count(), 1, "{construction:?}");
        assert!(tables.notices().is_empty());
        assert!(
            tables
                .origins()
                .iter()
                .zip(0..)
                .all(|(origin, face)| origin.face == face && origin.path().next().is_none())
        );
    }
}

/// Every patch reads its own vertices, with its corners first.
#[test]
fn the_tables_of_a_million_faces() {
    let mesh = ControlMesh::new(grid_torus(SIDE, SIDE)).expect("a torus");
    let topology = Topology::new(&mesh);
    let mut plan =
        prepare(&mesh, 0).expect("small enough").plan(Scheme::Gregory, Fallback::Refuse).expect("defined everywhere");

    let rings = RingTable::new(&topology, &plan);
    assert_eq!((rings.headers.len(), rings.corners.len()), (FACES as usize, 4 * FACES as usize));
    assert_eq!(rings.entries.len(), 8 * FACES as usize);
    for (h, &[ring, index]) in rings.corners.iter().enumerate() {
        let [vertex, entries, kind, faces] = rings.headers[ring as usize];
        assert_eq!((vertex, kind, faces), (mesh.data().face_vertices[h], 0, 4));
        // The plus edge leads to the next corner of the face, the diagonal is the corner opposite, the minus edge follows.
        let face = mesh.face(h as u32 / 4);
        let at = |step: u32| rings.entries[(entries + (2 * index + step) % 8) as usize];
        let corner = |step: usize| face[(h + step) % 4];
        assert_eq!([at(0), at(1), at(2)], [corner(1), corner(2), corner(3)]);
    }

    let stencils = StencilTable::new(&topology, &mut plan).expect("addressable");
    assert_eq!((stencils.patches.len(), stencils.largest_ring), (FACES as usize, 16));
    assert_eq!(stencils.vertices.len(), (4 + 16) * FACES as usize);
    for (patch, &[vertices, kind]) in plan.patches().iter().zip(&stencils.patches) {
        let (turns, around) = stencils.vertices[vertices as usize..vertices as usize + 20].split_at(4);
        assert!(turns.iter().all(|turn| [0, 2, 4, 6].contains(turn)));
        assert_eq!((kind, &around[..4]), (0, mesh.face(patch.face)));
        let mut different = around.to_vec();
        different.sort_unstable();
        different.dedup();
        assert_eq!(different.len(), 16);
    }
}
