//! Records of patches and edges: what they say of the caller's mesh, against its limit surface and its half-edges.

use ash_subdiv::limit::LimitSurface;
use ash_subdiv::mesh::{Corner, Crease};
use ash_subdiv::table::{CpuSurface, RingTable, prepare};
use ash_subdiv::topology::Topology;
use ash_subdiv::{ControlMesh, Fallback, MeshData, Scheme, shape};
use std::collections::HashMap;

const CORNERS: [[u32; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];

/// Face, level, place and first corner together say where on the caller's faces the corners of a patch are.
#[test]
fn cells_are_where_their_patches_are() {
    for (name, levels) in [("creature-mixed", 1), ("polygons", 2), ("cube", 3), ("strip", 2)] {
        let mesh = shape(name).unwrap();
        let limit = LimitSurface::new(&mesh).unwrap();
        let surface = CpuSurface::new(&mesh, Scheme::Gregory, levels).unwrap();
        let points = surface.control_points(|position| position);
        for (patch, points) in surface.plan().patches().iter().zip(&points) {
            let (id, origin) = (patch.id, surface.plan().origin(patch));
            assert_eq!(id.level(), levels);
            let side = 0.5f64.powi(id.level() as i32 - i32::from(origin.corner.is_some()));
            for (k, [u, v]) in CORNERS.into_iter().enumerate() {
                let [at_u, at_v] = CORNERS[(id.first() as usize + k) % 4];
                let [at_u, at_v] = [id.u() + at_u, id.v() + at_v].map(|at| side * f64::from(at));
                let sub = origin.corner.map_or(-1, |corner| corner as i32);
                let expected = limit.evaluate(origin.face, sub, at_u, at_v).position;
                let [u, v] = [u, v].map(f64::from);
                let found = patch.scheme.evaluate(patch.kind, points, u, v).position;
                assert!((found - expected).length() < 1e-9 * mesh.diagonal(), "{name} {id:?} corner {k}");
            }
        }
    }
}

#[test]
fn boundaries_and_sharp_edges_are_marked() {
    // Three by three quads, the edge between vertices 5 and 6 sharp, one too weak to be drawn so.
    let at = |i: u32| [f64::from(i % 4), f64::from(i / 4), 0.0];
    let quad = |i: u32| [i, i + 1, i + 5, i + 4];
    let mesh = ControlMesh::new(MeshData {
        positions: (0..16).map(at).collect(),
        face_sizes: vec![4; 9],
        face_vertices: [0, 1, 2, 4, 5, 6, 8, 9, 10].into_iter().flat_map(quad).collect(),
        creases: [([5, 6], 2.0), ([6, 10], 0.5)].map(|(vertices, sharpness)| Crease { vertices, sharpness }).into(),
        corners: vec![Corner { vertex: 5, sharpness: 10.0 }],
        ..MeshData::default()
    })
    .unwrap();
    let plan = prepare(&mesh, 0).unwrap().plan(Scheme::Gregory, Fallback::Refuse).unwrap();
    let mut boundaries = [0; 9];
    for patch in plan.patches() {
        assert_eq!((patch.id.face(), patch.id.level(), patch.id.first()), (patch.face, 0, 0));
        assert_eq!((patch.id.transition(), patch.id.has_crease()), (0, false));
        boundaries[patch.face as usize] = patch.id.boundary();
    }
    assert_eq!(boundaries, [0b1001, 0b0101, 0b0011, 0b1000, 0b0001, 0b0010, 0b1100, 0b0100, 0b0110]);
}

/// The parts of every curve follow one another from end to end, and those of the caller's edges are on these.
#[test]
fn edges_are_parts_of_curves() {
    for (name, levels) in [("creature-mixed", 1), ("polygons", 2), ("strip", 3), ("cube", 0)] {
        let mesh = shape(name).unwrap();
        let coarse = Topology::new(&mesh);
        let prepared = prepare(&mesh, levels).unwrap();
        let edges = prepared.edges(&prepared.plan(Scheme::Gregory, Fallback::Refuse).unwrap());
        let topology = prepared.topology();
        assert_eq!(edges.records.len(), prepared.mesh().edge_count());
        let mut curves: HashMap<u32, Vec<(u16, u8, [u32; 2])>> = HashMap::new();
        for (record, &ends) in edges.records.iter().zip(&edges.vertices) {
            curves.entry(record.part.curve).or_default().push((record.part.index, record.part.level, ends));
            let owned = [record.owner, topology.next(record.owner)].map(|h| topology.mesh_vertex(h));
            assert!(topology.twin(record.owner).is_none() || owned[0] < owned[1], "{name} {record:?}");
            assert!(owned == ends || owned == [ends[1], ends[0]], "{name} {record:?}");
            assert_eq!(record.is_sharp, !topology.is_within_rings(record.owner));
        }
        for parts in curves.values_mut() {
            parts.sort();
            assert_eq!(parts.len(), 1 << parts[0].1);
            assert!(parts.iter().zip(0..).all(|(part, index)| part.0 == index && part.1 == parts[0].1), "{name}");
            for pair in parts.windows(2) {
                assert!(pair[0].2.iter().any(|vertex| pair[1].2.contains(vertex)), "{name} {pair:?}");
            }
        }
        // Refinement keeps the numbers of vertices.
        let lower = (0..mesh.corner_count() as u32).filter(|&h| coarse.twin(h).is_none_or(|twin| h < twin));
        for (curve, h) in lower.enumerate() {
            let parts = &curves[&(curve as u32)];
            assert_eq!(u32::from(parts[0].1), levels);
            let ends = [h, coarse.next(h)].map(|h| coarse.mesh_vertex(h));
            for (part, end) in [&parts[0], &parts[parts.len() - 1]].into_iter().zip(ends) {
                assert!(part.2.contains(&end), "{name}: curve {curve} has {part:?} at its end {end}");
            }
        }
        let interior = curves.keys().filter(|&&curve| curve as usize >= mesh.edge_count()).count();
        assert_eq!(interior > 0, levels > 0);
    }
}

#[test]
fn control_vertices_come_before_refined_ones() {
    for (levels, first) in [(0, 0), (1, 8)] {
        let prepared = prepare(&shape("cube").unwrap(), levels).unwrap();
        let plan = prepared.plan(Scheme::Gregory, Fallback::Refuse).unwrap();
        let rings = RingTable::new(prepared.topology(), &plan);
        let vertices = rings.headers.iter().map(|header| header[0]).chain(rings.entries.iter().copied());
        assert_eq!(vertices.clone().min(), Some(first));
        assert_eq!(vertices.max(), Some(first + prepared.mesh().vertex_count() as u32 - 1));
    }
}

#[test]
fn cells_have_ten_levels() {
    let quad = ControlMesh::new(MeshData {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        face_sizes: vec![4],
        face_vertices: vec![0, 1, 2, 3],
        ..MeshData::default()
    })
    .unwrap();
    let error = prepare(&quad, 11).unwrap_err().to_string();
    assert_eq!(error, "the mesh has 11 levels of refinement: at most 10 can be addressed");
}
