//! Each kind of fault, alone: what becomes of it, and what is said.

use super::*;
use crate::mesh::{BoundaryRule, Change, Corner, Crease, Edit, FaceVarying, SHARPNESS_INFINITE, shape, shapes};

fn mesh(positions: &[[f64; 3]], faces: &[&[u32]]) -> MeshData {
    MeshData {
        positions: positions.to_vec(),
        face_sizes: faces.iter().map(|face| face.len() as u32).collect(),
        face_vertices: faces.concat(),
        ..MeshData::default()
    }
}

/// Vertices where nobody looks: none at the same place.
fn somewhere(count: usize) -> Vec<[f64; 3]> {
    (0..count).map(|i| [i as f64, (i * i) as f64, 1.0]).collect()
}

/// The repaired mesh, whose notes are these.
#[track_caller]
fn repaired(data: MeshData, notes: &[&str]) -> (ControlMesh, Repairs) {
    let (mesh, repairs) = ControlMesh::repaired(data, &RepairOptions::default()).unwrap();
    let said: Vec<String> = repairs.list.iter().map(ToString::to_string).collect();
    assert_eq!(said, notes);
    (mesh, repairs)
}

fn faces(mesh: &ControlMesh) -> Vec<&[u32]> {
    (0..mesh.face_count() as u32).map(|face| mesh.face(face)).collect()
}

#[test]
fn meshes_without_fault_stay_as_they_are() {
    let mut meshes: Vec<MeshData> = shapes().iter().map(|info| shape(info.name).unwrap().into_data()).collect();
    // A pillow, and two tetrahedra that touch in a point.
    meshes.push(mesh(&somewhere(4), &[&[0, 1, 2, 3], &[3, 2, 1, 0]]));
    let tetrahedra: [&[u32]; 8] =
        [&[0, 1, 2], &[0, 2, 3], &[0, 3, 1], &[1, 3, 2], &[0, 4, 5], &[0, 5, 6], &[0, 6, 4], &[4, 6, 5]];
    meshes.push(mesh(&somewhere(7), &tetrahedra));
    for data in meshes {
        let (same, repairs) = repair(data.clone(), &RepairOptions::default());
        assert!(same == data && repairs == Repairs::default(), "{repairs:?}");
    }
}

#[test]
fn vertices_without_faces_go_with_their_tags() {
    let mut data = mesh(&somewhere(6), &[&[1, 2, 4]]);
    data.positions[0] = [f64::NAN; 3];
    data.creases = vec![Crease { vertices: [4, 2], sharpness: 2.0 }];
    data.corners = vec![Corner { vertex: 3, sharpness: 1.0 }, Corner { vertex: 4, sharpness: 3.0 }];
    let (mesh, repairs) = repaired(data, &["3 vertices belong to no face and are left out (the first: vertex 0)"]);
    assert_eq!((mesh.face(0), mesh.vertex_count()), (&[0, 1, 2][..], 3));
    assert_eq!(mesh.data().creases, [Crease { vertices: [2, 1], sharpness: 2.0 }]);
    assert_eq!(mesh.data().corners, [Corner { vertex: 2, sharpness: 3.0 }]);
    assert_eq!(repairs.vertices, [1, 2, 4]);
    assert_eq!(repairs.given_vertex(2), 4);
}

#[test]
fn repeated_corners_spikes_and_small_faces_go() {
    let data =
        mesh(&somewhere(6), &[&[0, 1, 1, 2, 3, 3], &[1, 0], &[4, 0, 3, 4], &[], &[5, 4, 3, 2, 1, 2], &[2, 5, 2, 5]]);
    let (mesh, repairs) = repaired(
        data,
        &[
            "5 repeated corners are left out (the first: face 0)",
            "3 faces of fewer than three corners are left out (the first: face 1)",
        ],
    );
    // The corner 1 of face 4 is a spike, and 2 is there once only.
    assert_eq!(faces(&mesh), [&[0, 1, 2, 3][..], &[4, 0, 3], &[5, 4, 3, 2]]);
    assert_eq!(repairs.faces, [0, 2, 4]);
    // Spikes and repetitions across the end.
    for face in [&[0, 1, 2, 0][..], &[0, 3, 0, 1, 2], &[0, 1, 2, 0, 3], &[3, 0, 1, 2, 0], &[0, 1, 2, 2, 0, 0]] {
        let data = mesh_with_last(face);
        let (mesh, _) = ControlMesh::repaired(data, &RepairOptions::default()).unwrap();
        let mut vertices = mesh.face(0).to_vec();
        vertices.sort_unstable();
        assert_eq!(vertices, [0, 1, 2], "{face:?}");
    }
}

/// The face, and one at vertex 3 that keeps it.
fn mesh_with_last(face: &[u32]) -> MeshData {
    mesh(&somewhere(6), &[face, &[3, 4, 5]])
}

#[test]
fn attributes_go_with_their_corners() {
    let mut data = mesh(&somewhere(4), &[&[0, 0, 1, 2], &[2, 1], &[0, 2, 3]]);
    let values: Vec<[f32; 2]> = (0..9).map(|i| [i as f32, 0.0]).collect();
    data.texcoords = Some(FaceVarying { values, indices: (0..9).collect() });
    data.holes = vec![2];
    let notes = ["1 repeated corner is left out (face 0)", "1 face of fewer than three corners is left out (face 1)"];
    let (mesh, _) = repaired(data, &notes);
    assert_eq!(mesh.data().texcoords.as_ref().unwrap().indices, [0, 2, 3, 6, 7, 8]);
    assert_eq!(mesh.data().holes, [1]);
}

#[test]
fn normals_and_texture_coordinates_that_are_none_become_zero() {
    let mut data = mesh(&somewhere(4), &[&[0, 1, 2], &[2, 1, 3]]);
    let normals = vec![[0., 0., 1.], [f32::NAN, 0., 1.]];
    data.normals = Some(FaceVarying { values: normals, indices: vec![0, 0, 0, 0, 1, 7] });
    data.texcoords = Some(FaceVarying { values: vec![[0.5, 0.5]], indices: vec![0, u32::MAX, 0, 0, 0, 0] });
    let notes = [
        "2 corners have normals that are not there or no numbers: the surface has its own (the first: face 1)",
        "1 corner has a texture coordinate that is not there or no number: it gets (0, 0) (face 0)",
    ];
    let (mesh, _) = repaired(data, &notes);
    let normals = mesh.data().normals.as_ref().unwrap();
    let of_corners: Vec<f32> = normals.indices.iter().map(|&i| normals.values[i as usize][2]).collect();
    assert_eq!(of_corners, [1., 1., 1., 1., 0., 0.]);
    let texcoords = mesh.data().texcoords.as_ref().unwrap();
    let of_corners: Vec<f32> = texcoords.indices.iter().map(|&i| texcoords.values[i as usize][0]).collect();
    assert_eq!(of_corners, [0.5, 0., 0.5, 0.5, 0.5, 0.5]);
}

#[test]
fn faces_on_others_go() {
    // The same way round from another corner, and back to back beside a neighbour.
    let data = mesh(&somewhere(6), &[&[0, 1, 2, 3], &[2, 3, 0, 1], &[3, 2, 4, 5], &[3, 2, 1, 0]]);
    let (mesh, repairs) = repaired(data, &["2 faces on others are left out (the first: face 1)"]);
    assert_eq!((faces(&mesh), repairs.faces), (vec![&[0, 1, 2, 3][..], &[3, 2, 4, 5]], vec![0, 2]));
}

#[test]
fn a_sheet_with_a_back_keeps_its_front() {
    let front: [&[u32]; 2] = [&[0, 1, 4, 3], &[1, 2, 5, 4]];
    let data = mesh(&somewhere(6), &[front[0], front[1], &[3, 4, 1, 0], &[4, 5, 2, 1]]);
    let (mesh, _) = repaired(data, &["2 faces on others are left out (the first: face 2)"]);
    assert_eq!(faces(&mesh), front);
}

/// Two boxes, one on the other, with a wall between.
fn boxes() -> MeshData {
    let positions: Vec<[f64; 3]> = (0..12).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
    let mut faces = Vec::new();
    for low in [0, 4] {
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            faces.push(face.map(|vertex| vertex + low));
        }
    }
    mesh(&positions, &faces.iter().map(|face| &face[..]).collect::<Vec<_>>())
}

#[test]
fn solids_that_touch_with_a_face_keep_their_shared_line() {
    let (mesh, repairs) =
        repaired(boxes(), &["4 edges of three or more faces are sharp (the first: edge 4-6 of face 6)"]);
    assert_eq!((mesh.face_count(), mesh.vertex_count()), (12, 4 * 6));
    // All four faces at an edge are apart, and meet in the same corners.
    assert_eq!(mesh.boundary_edge_count(), 16);
    assert!((0..24).filter(|&v| mesh.vertex_sharpness(v) >= SHARPNESS_INFINITE).count() == 16);
    for vertex in 12..24 {
        assert_eq!(mesh.position(vertex), mesh.position(repairs.given_vertex(vertex)));
    }
}

#[test]
fn a_line_that_runs_on_is_a_crease_and_its_ends_are_corners() {
    // A strip of 2 x 3 quads, and a fin on its middle line 1-4-7-10.
    let positions: Vec<[f64; 3]> = (0..4).flat_map(|j| (0..3).map(move |i| [f64::from(i), f64::from(j), 0.])).collect();
    let fin = (0..4).map(|j| [1., f64::from(j), 1.]);
    let positions: Vec<_> = positions.into_iter().chain(fin).collect();
    let mut faces = Vec::new();
    for j in 0..3u32 {
        faces.push([3 * j, 3 * j + 1, 3 * j + 4, 3 * j + 3]);
        faces.push([3 * j + 1, 3 * j + 2, 3 * j + 5, 3 * j + 4]);
        faces.push([3 * j + 1, 3 * j + 4, 13 + j, 12 + j]);
    }
    let mut data = mesh(&positions, &faces.iter().map(|face| &face[..]).collect::<Vec<_>>());
    data.creases = vec![Crease { vertices: [4, 3], sharpness: 2.0 }, Crease { vertices: [4, 1], sharpness: 1.0 }];
    data.corners = vec![Corner { vertex: 7, sharpness: 3.0 }];
    let (mesh, repairs) = repaired(data, &["3 edges of three or more faces are sharp (the first: edge 1-4 of face 2)"]);
    assert_eq!(mesh.vertex_count(), 16 + 2 * 4);
    let copies = |given: u32| (0..24).filter(|&vertex| repairs.given_vertex(vertex) == given).collect::<Vec<u32>>();
    let sharpness = |given: u32| copies(given).iter().map(|&v| mesh.vertex_sharpness(v)).collect::<Vec<_>>();
    assert_eq!(sharpness(1), [SHARPNESS_INFINITE; 3], "at the boundary");
    assert_eq!(sharpness(4), [0.0; 3], "the line runs on");
    assert_eq!(sharpness(7), [3.0; 3], "as it was tagged");
    // A crease that leads to the line ends at the copy of its own surface.
    let crease = mesh.data().creases[0];
    let own: Vec<u32> = copies(4).into_iter().filter(|v| mesh.face(0).contains(v)).collect();
    assert_eq!((crease.vertices, crease.sharpness), ([3, own[0]], 2.0));
    assert_eq!(mesh.boundary_edge_count(), 10 + 3 + 2 + 3 * 3);
}

#[test]
fn under_no_boundary_rule_surfaces_along_a_shared_line_are_drawn() {
    let mut data = boxes();
    data.boundary = BoundaryRule::None;
    let (mesh, _) = ControlMesh::repaired(data, &RepairOptions::default()).unwrap();
    let drawn = crate::topology::draws_face(&crate::topology::Topology::new(&mesh));
    assert_eq!(drawn, [true; 12]);
}

#[test]
fn faces_are_turned_to_go_with_most_of_their_piece() {
    let mut data = shape("cube").unwrap().into_data();
    data.texcoords = Some(FaceVarying { values: vec![[0.; 2]; 24], indices: (0..24).collect() });
    let cube = data.clone();
    for face in [1, 4] {
        data.face_vertices[4 * face + 1..4 * face + 4].reverse();
        data.texcoords.as_mut().unwrap().indices[4 * face + 1..4 * face + 4].reverse();
    }
    let (mesh, _) = repaired(data, &["2 faces are turned over to go with their neighbours (the first: face 1)"]);
    assert!(mesh.into_data() == cube);
}

/// A band of quads around a ring, with a half turn.
fn moebius(quads: u32) -> MeshData {
    let positions: Vec<[f64; 3]> = (0..2 * quads)
        .map(|i| {
            let (turn, side) = (f64::from(i / 2) / f64::from(quads), f64::from(i % 2) - 0.5);
            let (around, tilt) = (turn * std::f64::consts::TAU, turn * std::f64::consts::PI);
            let radius = 2.0 + side * tilt.cos();
            [radius * around.cos(), radius * around.sin(), side * tilt.sin()]
        })
        .collect();
    let mut faces: Vec<[u32; 4]> = (0..quads - 1).map(|k| [2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2]).collect();
    faces.push([2 * quads - 2, 2 * quads - 1, 0, 1]);
    mesh(&positions, &faces.iter().map(|face| &face[..]).collect::<Vec<_>>())
}

#[test]
fn a_moebius_band_is_parted_along_one_edge() {
    let (mesh, repairs) = ControlMesh::repaired(moebius(12), &RepairOptions::default()).unwrap();
    let count = |kind| repairs.list.iter().find(|repair| repair.kind == kind).map(|repair| repair.count);
    assert_eq!(count(RepairKind::OneSidedSheets), Some(1));
    assert!(count(RepairKind::TurnedFaces).unwrap_or(0) <= 6);
    assert_eq!((mesh.vertex_count(), mesh.boundary_edge_count()), (24 + 2, 24 + 2));
}

#[test]
fn a_face_that_passes_a_vertex_twice_is_parted_there() {
    // A square with a bridge from corner 0 to a square hole: C-shaped.
    let data = mesh(&somewhere(8), &[&[0, 1, 2, 3, 0, 4, 5, 6, 7, 4]]);
    let (mesh, repairs) =
        repaired(data, &["2 corners at vertices that their face has twice are parted (the first: face 0)"]);
    assert_eq!((mesh.corner_count(), mesh.vertex_count(), mesh.boundary_edge_count()), (10, 10, 10));
    let given: Vec<u32> = mesh.face(0).iter().map(|&vertex| repairs.given_vertex(vertex)).collect();
    assert_eq!(given, [0, 1, 2, 3, 0, 4, 5, 6, 7, 4]);
}

#[test]
fn tags_on_nothing_go() {
    let mut data = mesh(&somewhere(4), &[&[0, 1, 2], &[2, 1, 3]]);
    let crease = |vertices, sharpness| Crease { vertices, sharpness };
    data.creases = vec![crease([0, 1], 2.0), crease([0, 3], 2.0), crease([9, 1], 1.0), crease([1, 2], f32::NAN)];
    data.corners = vec![Corner { vertex: 4, sharpness: 1.0 }, Corner { vertex: 0, sharpness: -1.0 }];
    data.holes = vec![0, 2];
    let notes = [
        "4 tags on nothing are left out (the first: crease 1)",
        "2 tags whose sharpness is no number from 0 up are left out (the first: crease 3)",
    ];
    let (mesh, _) = repaired(data, &notes);
    assert_eq!(mesh.data().creases, [crease([0, 1], 2.0)]);
    assert_eq!((mesh.data().corners.len(), &mesh.data().holes[..]), (0, &[0][..]));
}

#[test]
fn edits_stay_with_their_faces_and_go_where_those_are_mended() {
    let edit = |face| Edit { face, children: vec![1], change: Change::Hole };
    let faces: [&[u32]; 4] = [&[0, 1, 1, 2, 3], &[1, 0], &[3, 2, 4, 5], &[4, 5, 6, 7]];
    let mut data = mesh(&somewhere(8), &faces);
    data.edits = (0..4).map(edit).collect();
    let (data, repairs) = repair(data, &RepairOptions::default());
    // The first two are other faces now, or none; of the last two, one is turned over.
    let lost = repairs.list.iter().find(|repair| repair.kind == RepairKind::LostEdits).unwrap();
    assert_eq!(lost.to_string(), "3 edits of faces that were mended are left out (the first: face 0)");
    let kept: Vec<u32> = data.edits.iter().map(|edit| repairs.given_face(edit.face)).collect();
    let turned = repairs.list.iter().find(|repair| repair.kind == RepairKind::TurnedFaces).unwrap();
    assert_eq!((kept, turned.first), (vec![2], Place::Face(3)));
}

#[test]
fn what_cannot_be_mended_has_the_numbers_that_were_given() {
    let error = |data| ControlMesh::repaired(data, &RepairOptions::default()).unwrap_err().to_string();
    let mut data = mesh(&somewhere(5), &[&[1, 1, 2], &[2, 3, 4]]);
    data.positions[3][1] = f64::NAN;
    assert!(error(data).starts_with("vertex 3 is at (3, NaN, 1)"));
    let data = mesh(&somewhere(3), &[&[0, 1, 2], &[0, 1, 5]]);
    assert_eq!(error(data), "face 1 names vertex 5, but the mesh has 3 vertices (0 to 2)");
    assert_eq!(error(mesh(&somewhere(3), &[&[0, 1]])), "the mesh has no faces: a control mesh needs at least one face");
    let mut data = mesh(&somewhere(3), &[&[0, 1, 2]]);
    data.normals = Some(FaceVarying { values: vec![], indices: vec![0] });
    assert_eq!(error(data), "normal are given for 1 face corners, but the mesh has 3");
}

/// Found by fuzzing: the error was that the first face is too small, which is mended.
#[test]
fn what_cannot_be_mended_is_the_error_whatever_else_could_be() {
    let data = MeshData {
        positions: vec![[0.0; 3]; 3],
        face_sizes: vec![0, 2, 4],
        face_vertices: vec![0, 0, 0, 1, 2, 7],
        ..MeshData::default()
    };
    let error = ControlMesh::repaired(data.clone(), &RepairOptions::default()).unwrap_err();
    assert_eq!(error, MeshError::IndexOutOfRange { face: 2, vertex: 7, count: 3 });
    let error = ControlMesh::repaired(MeshData { face_sizes: vec![0, 2, 3], ..data }, &RepairOptions::default());
    assert_eq!(error.unwrap_err(), MeshError::CornerCount { what: "vertices", given: 6, corners: 5 });
}
