//! One-rings, sectors between creases, corners, darts, boundaries, holes and vertices where fans touch.

use crate::common::random::{random_creased_mesh, random_mesh};
use ash_subdiv::mesh::{BoundaryRule, Corner, Crease, SHARPNESS_INFINITE};
use ash_subdiv::table::{Notice, PatchPlan, prepare};
use ash_subdiv::topology::{PatchKind, Ring, RingKind, Topology};
use ash_subdiv::{ControlMesh, Fallback, MeshData, Scheme, shape, shapes};
use std::collections::{BTreeMap, BTreeSet};

/// Everything that a ring promises, checked against the faces of the mesh alone.
fn check_rings(name: &str, mesh: &ControlMesh) {
    let topology = Topology::new(mesh);
    let half_edges = 0..mesh.corner_count() as u32;
    let mut seen = BTreeSet::new();
    for (number, ring) in topology.rings().iter().enumerate() {
        let around: Vec<u32> = topology.ring_half_edges(ring).collect();
        let what = || format!("{name}: ring {number}, {ring:?}");
        assert_eq!(around.len(), ring.faces as usize, "{}", what());
        for (index, &h) in around.iter().enumerate() {
            let place = topology.place(h);
            assert_eq!((place.ring, place.index), (number as u32, index as u32), "{}", what());
            assert!(seen.insert(h), "{}: corner {h} is in two rings", what());
            assert_eq!(topology.vertex(h), topology.vertex(around[0]), "{}", what());
        }
        // Each face hangs on the next at an edge that is no cut.
        for pair in around.windows(2) {
            assert_eq!(topology.twin(topology.prev(pair[0])), Some(pair[1]), "{}", what());
            assert!(!topology.is_sharp(pair[1]) || ring.kind == RingKind::Smooth, "{}", what());
        }
        let (first, last) = (around[0], topology.prev(around[around.len() - 1]));
        if ring.open {
            let ends = [(first, topology.twin(first)), (last, topology.twin(last))];
            for (end, twin) in ends {
                assert!(twin.is_none() || topology.is_sharp(end), "{}: ends at a smooth edge", what());
            }
        } else {
            assert_eq!(topology.twin(last), Some(first), "{}", what());
        }
        let quads = around.iter().all(|&h| topology.face_size(h) == 4);
        assert_eq!(ring.quads, quads, "{}", what());
    }
    assert_eq!(seen.len(), mesh.corner_count(), "{name}: every corner is in a ring");
    // Every fan of faces is a vertex of its own: as many as there are ways around vertices.
    let mut parents: BTreeMap<u32, u32> = half_edges.clone().map(|h| (h, h)).collect();
    fn root(parents: &BTreeMap<u32, u32>, mut h: u32) -> u32 {
        while parents[&h] != h {
            h = parents[&h];
        }
        h
    }
    for h in half_edges.clone() {
        if let Some(twin) = topology.twin(h) {
            // The corner at the start of h and the one after the twin.
            let (a, b) = (root(&parents, h), root(&parents, topology.next(twin)));
            parents.insert(a, b);
        }
    }
    let fans: BTreeSet<u32> = half_edges.clone().map(|h| root(&parents, h)).collect();
    assert_eq!(topology.vertex_count(), fans.len(), "{name}");
    let vertices: BTreeSet<(u32, u32)> = half_edges.map(|h| (root(&parents, h), topology.vertex(h))).collect();
    assert_eq!(vertices.len(), fans.len(), "{name}: a vertex for each fan");
}

#[test]
fn rings_hold_every_corner_once_and_in_order() {
    for info in shapes() {
        check_rings(info.name, &shape(info.name).unwrap());
    }
    for seed in 0..200 {
        check_rings(&format!("random {seed}"), &random_mesh(seed));
        check_rings(&format!("random creased {seed}"), &random_creased_mesh(seed));
    }
}

/// `columns` x `rows` quads, row by row; vertices too.
fn grid(columns: u32, rows: u32) -> MeshData {
    let vertex = |i: u32, j: u32| j * (columns + 1) + i;
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    MeshData {
        positions: (0..(columns + 1) * (rows + 1))
            .map(|v| [f64::from(v % (columns + 1)), f64::from(v / (columns + 1)), 0.0])
            .collect(),
        face_sizes: vec![4; (columns * rows) as usize],
        face_vertices: cells
            .flat_map(|(i, j)| [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)])
            .collect(),
        ..MeshData::default()
    }
}

/// The rings around a vertex, counter-clockwise from any.
fn rings_at(mesh: &ControlMesh, vertex: u32) -> Vec<Ring> {
    let topology = Topology::new(mesh);
    topology.rings().iter().filter(|ring| topology.mesh_vertex(ring.start) == vertex).copied().collect()
}

fn shapes_of(rings: &[Ring]) -> Vec<(RingKind, u32, bool)> {
    let mut shapes: Vec<_> = rings.iter().map(|ring| (ring.kind, ring.faces, ring.open)).collect();
    shapes.sort();
    shapes
}

#[test]
fn sharp_edges_cut_the_ring_of_a_vertex_into_sectors() {
    use RingKind::{Corner as Cone, Crease as Along, Smooth};
    // The middle of 4 x 4 quads, vertex 12, with sharp edges to some of its neighbours.
    let [right, up, left, down] = [13, 17, 11, 7];
    for (ends, expected) in [
        (vec![], vec![(Smooth, 4, false)]),
        // A dart does not cut.
        (vec![right], vec![(Smooth, 4, false)]),
        (vec![right, left], vec![(Along, 2, true), (Along, 2, true)]),
        (vec![right, up], vec![(Along, 1, true), (Along, 3, true)]),
        (vec![right, up, left], vec![(Cone, 1, true), (Cone, 1, true), (Cone, 2, true)]),
        (vec![right, up, left, down], vec![(Cone, 1, true); 4]),
    ] {
        for (sharpness, is_sharp) in [(10.0, true), (1.0, true), (0.99, false), (0.0, false)] {
            let crease = |&end: &u32| Crease { vertices: [end, 12], sharpness };
            let creases = ends.iter().map(crease).collect();
            let mesh = ControlMesh::new(MeshData { creases, ..grid(4, 4) }).unwrap();
            let expected = if is_sharp { expected.clone() } else { vec![(Smooth, 4, false)] };
            assert_eq!(shapes_of(&rings_at(&mesh, 12)), expected, "{ends:?} of sharpness {sharpness}");
        }
    }
}

#[test]
fn tagged_vertices_are_corners() {
    for (sharpness, expected) in [(10.0, RingKind::Corner), (1.0, RingKind::Corner), (0.9, RingKind::Smooth)] {
        let corners = vec![Corner { vertex: 12, sharpness }];
        let mesh = ControlMesh::new(MeshData { corners, ..grid(4, 4) }).unwrap();
        assert_eq!(shapes_of(&rings_at(&mesh, 12)), [(expected, 4, false)], "{sharpness}");
        let is_regular = expected == RingKind::Smooth;
        let kind = if is_regular { PatchKind::Regular } else { PatchKind::IrregularQuad };
        let topology = Topology::new(&mesh);
        let kinds: Vec<_> = [5, 6, 9, 10, 0].map(|face| topology.patch_kind(face).unwrap()).into();
        assert_eq!(kinds, [kind, kind, kind, kind, PatchKind::Regular], "{sharpness}");
    }
}

#[test]
fn boundary_rings_run_from_boundary_to_boundary() {
    for (boundary, lone) in
        [(BoundaryRule::EdgeAndCorner, RingKind::Corner), (BoundaryRule::EdgeOnly, RingKind::Crease)]
    {
        let mesh = ControlMesh::new(MeshData { boundary, ..grid(2, 2) }).unwrap();
        assert_eq!(shapes_of(&rings_at(&mesh, 0)), [(lone, 1, true)]);
        assert_eq!(shapes_of(&rings_at(&mesh, 1)), [(RingKind::Crease, 2, true)]);
        assert_eq!(shapes_of(&rings_at(&mesh, 4)), [(RingKind::Smooth, 4, false)]);
        let topology = Topology::new(&mesh);
        let ring = rings_at(&mesh, 1)[0];
        // Edge 0 is the one with a face on its left and none on its right: counter-clockwise through the faces.
        assert_eq!(topology.mesh_vertex(topology.next(ring.start)), 2);
    }
}

#[test]
fn creases_on_a_boundary_change_nothing() {
    let crease = |a, b| Crease { vertices: [a, b], sharpness: 10.0 };
    let tagged = ControlMesh::new(MeshData { creases: vec![crease(0, 1), crease(2, 1)], ..grid(2, 2) }).unwrap();
    let plain = ControlMesh::new(grid(2, 2)).unwrap();
    assert_eq!(Topology::new(&tagged).rings(), Topology::new(&plain).rings());
}

#[test]
fn sharpness_is_kept_as_it_was_authored() {
    let crease = |vertices, sharpness| Crease { vertices, sharpness };
    // Vertex 4 is the middle of 9. Of two creases for an edge the last counts, of two corners likewise.
    let creases = vec![crease([4, 1], 7.0), crease([1, 4], 0.25), crease([4, 5], 3.5), crease([0, 1], 2.0)];
    let corners = [5.0, 1.5].map(|sharpness| Corner { vertex: 4, sharpness }).into();
    let mesh = ControlMesh::new(MeshData { creases, corners, ..grid(2, 2) }).unwrap();
    assert_eq!(mesh.creased_edge_count(), 3);
    let topology = Topology::new(&mesh);
    let mut found = Vec::new();
    for h in 0..mesh.corner_count() as u32 {
        let mut ends = [topology.mesh_vertex(h), topology.mesh_vertex(topology.next(h))];
        ends.sort();
        match topology.twin(h) {
            // Boundaries are infinitely sharp, tagged or not, and no creases.
            None => assert!(topology.sharpness(h) == SHARPNESS_INFINITE && !topology.is_sharp(h)),
            Some(twin) => assert_eq!(topology.sharpness(h), topology.sharpness(twin)),
        }
        if topology.twin(h).is_some_and(|twin| h < twin) {
            assert_eq!(topology.is_sharp(h), ends == [4, 5]);
            found.push((ends, topology.sharpness(h)));
        }
    }
    found.sort_by_key(|edge| edge.0);
    assert_eq!(found, [([1, 4], 0.25), ([3, 4], 0.0), ([4, 5], 3.5), ([4, 7], 0.0)]);
    assert_eq!([3, 4].map(|vertex| topology.vertex_sharpness(vertex)), [0.0, 1.5]);
}

#[test]
fn clones_of_a_mesh_are_the_same_arrays() {
    let mesh = ControlMesh::new(grid(2, 2)).unwrap();
    let topology = Topology::new(&mesh);
    assert!(std::ptr::eq(topology.mesh().data(), mesh.data()));
    assert!(std::ptr::eq(prepare(&mesh, 0).unwrap().mesh().data(), mesh.data()));
    assert_eq!(mesh.into_data(), topology.mesh().clone().into_data());
}

#[test]
fn vertices_where_fans_touch_are_split() {
    // Two quads that share vertex 0 only, and a third that shares an edge with the first.
    let mesh = ControlMesh::new(MeshData {
        positions: (0..9).map(|i| [f64::from(i), f64::from(i * i), 0.0]).collect(),
        face_sizes: vec![4; 3],
        face_vertices: vec![0, 1, 2, 3, 0, 4, 5, 6, 1, 7, 8, 2],
        ..MeshData::default()
    })
    .unwrap();
    let topology = Topology::new(&mesh);
    assert_eq!((topology.split_count(), topology.vertex_count()), (1, 10));
    assert_eq!([0, 1].map(|vertex| topology.vertex_sharpness(vertex)), [SHARPNESS_INFINITE, 0.0]);
    // The first face keeps the vertex.
    assert_eq!([topology.vertex(0), topology.vertex(4)], [0, 9]);
    assert_eq!([topology.source(0), topology.source(9)], [0, 0]);
    assert_eq!(shapes_of(&rings_at(&mesh, 0)), [(RingKind::Corner, 1, true); 2]);
    assert_eq!(prepare(&mesh, 0).unwrap().notices(&plan(&mesh)), [Notice::SplitVertices { count: 1 }]);
}

#[test]
fn creases_that_end_within_the_surface_are_told() {
    // Vertex 12 is the middle of 25.
    let told = |creases: &[[u32; 2]], corners: &[u32], sharpness: f32| {
        let creases = creases.iter().map(|&vertices| Crease { vertices, sharpness }).collect();
        let corners = corners.iter().map(|&vertex| Corner { vertex, sharpness }).collect();
        let mesh = ControlMesh::new(MeshData { creases, corners, ..grid(4, 4) }).unwrap();
        let notices = prepare(&mesh, 0).unwrap().notices(&plan(&mesh));
        notices.into_iter().find(|notice| matches!(notice, Notice::Darts { .. }))
    };
    assert_eq!(told(&[[10, 11], [11, 12]], &[], 10.0), Some(Notice::Darts { count: 1, first: 12 }));
    assert_eq!(told(&[[11, 12], [12, 13]], &[], 2.0), Some(Notice::Darts { count: 2, first: 11 }));
    assert_eq!(told(&[[10, 11], [11, 12], [12, 11]], &[], 10.0), Some(Notice::Darts { count: 1, first: 12 }));
    let text = Notice::Darts { count: 2, first: 11 }.to_string();
    assert!(text.starts_with("2 ends of creases lie within the surface (the first at vertex 11): "), "{text}");
    // From boundary to boundary; to a corner; too little sharpness to be drawn.
    assert_eq!(told(&[[10, 11], [11, 12], [12, 13], [13, 14]], &[], 10.0), None);
    assert_eq!(told(&[[10, 11], [11, 12]], &[12], 10.0), None);
    assert_eq!(told(&[[10, 11], [11, 12]], &[], 0.5), None);
}

fn plan(mesh: &ControlMesh) -> PatchPlan {
    prepare(mesh, 0).unwrap().plan(Scheme::Gregory, Fallback::Refuse).unwrap()
}

#[test]
fn holes_and_faces_at_a_free_boundary_are_not_drawn() {
    let drawn = |data: MeshData| -> Vec<u32> {
        let mesh = ControlMesh::new(data).unwrap();
        plan(&mesh).patches().iter().map(|patch| patch.face).collect()
    };
    assert_eq!(drawn(MeshData { holes: vec![1, 3], ..grid(2, 2) }), [0, 2]);
    assert_eq!(drawn(MeshData { boundary: BoundaryRule::None, ..grid(4, 3) }), [5, 6]);
    assert_eq!(drawn(MeshData { boundary: BoundaryRule::None, holes: vec![6], ..grid(4, 3) }), [5]);
    assert_eq!(drawn(MeshData { boundary: BoundaryRule::None, ..grid(2, 2) }), [0; 0]);
    // And it is said that there is nothing to see.
    let notices = |data: MeshData| {
        let mesh = ControlMesh::new(data).unwrap();
        prepare(&mesh, 0).unwrap().notices(&plan(&mesh))
    };
    assert_eq!(notices(MeshData { boundary: BoundaryRule::None, ..grid(2, 2) }), [Notice::NothingDrawn]);
    assert_eq!(notices(MeshData { holes: vec![0, 1, 2, 3], ..grid(2, 2) }), [Notice::NothingDrawn]);
    assert_eq!(notices(MeshData { holes: vec![0, 1, 2], ..grid(2, 2) }), []);
    assert_eq!(
        Notice::NothingDrawn.to_string(),
        "no face is drawn: all are holes, or touch a boundary where the rule for boundaries is to draw none of those"
    );
    // The same faces where the mesh is refined.
    let mesh = ControlMesh::new(MeshData { boundary: BoundaryRule::None, ..grid(4, 3) }).unwrap();
    for (refine, children) in [(1, 4), (2, 16)] {
        let prepared = prepare(&mesh, refine).unwrap();
        let origins = prepared.plan(Scheme::Gregory, Fallback::Refuse).unwrap().origins();
        let of = |face| origins.iter().filter(|origin| origin.face == face).count();
        assert_eq!((origins.len(), of(5), of(6)), (2 * children, children, children), "refined {refine} times");
    }
    // A hole is no boundary: its neighbours are as regular as without it.
    let mesh = ControlMesh::new(MeshData { holes: vec![4], ..grid(3, 3) }).unwrap();
    assert_eq!(plan(&mesh).count(PatchKind::Regular), 8);
}

#[test]
fn positions_that_single_precision_cannot_hold_are_an_error() {
    let mut data = shape("cube").unwrap().into_data();
    data.positions[3][1] = -1e39;
    let error = ControlMesh::new(data).unwrap_err().to_string();
    let [x, _, z] = shape("cube").unwrap().data().positions[3];
    assert_eq!(
        error,
        format!("vertex 3 is at ({x}, {}, {z}): positions must be finite numbers of at most 3.4e38", -1e39)
    );
}
