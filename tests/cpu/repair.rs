//! Any faces on any vertices become a mesh; edges of three faces are those of OpenSubdiv.

use crate::common;
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::mesh::{Corner, Crease, FaceVarying, ReadOptions, RepairOptions, read_repaired, repair};
use ash_subdiv::{ControlMesh, MeshData};
use proptest::prelude::*;

fn soup() -> impl Strategy<Value = MeshData> {
    let vertex = 0..8u32;
    let faces = prop::collection::vec(prop::collection::vec(vertex.clone(), 0..6), 1..14);
    let tags = prop::collection::vec((0..9u32, 0..9u32, -1f32..12.), 0..4);
    (faces, tags.clone(), tags, any::<bool>()).prop_map(|(faces, creases, corners, attributes)| {
        let face_vertices = faces.concat();
        let corner_count = face_vertices.len() as u32;
        let values = (0..corner_count).map(|i| [i as f32, 0.0]).collect();
        let texcoords = FaceVarying { values, indices: (0..corner_count).collect() };
        MeshData {
            positions: (0..8).map(|i| [f64::from(i), f64::from(i * i), f64::from(i % 3)]).collect(),
            face_sizes: faces.iter().map(|face| face.len() as u32).collect(),
            face_vertices,
            creases: creases.iter().map(|&(a, b, sharpness)| Crease { vertices: [a, b], sharpness }).collect(),
            corners: corners.iter().map(|&(vertex, _, sharpness)| Corner { vertex, sharpness }).collect(),
            holes: corners.iter().map(|&(_, face, _)| face).collect(),
            texcoords: attributes.then_some(texcoords),
            ..MeshData::default()
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 5000, ..ProptestConfig::default() })]

    #[test]
    fn any_faces_become_a_mesh(data in soup()) {
        let (mended, repairs) = repair(data.clone(), &RepairOptions::default());
        // Texture coordinates say which corner each was, and each corner is still at its vertex.
        if let Some(texcoords) = &mended.texcoords {
            for (&vertex, &index) in mended.face_vertices.iter().zip(&texcoords.indices) {
                prop_assert_eq!(repairs.given_vertex(vertex), data.face_vertices[index as usize]);
                let position = mended.positions[vertex as usize];
                prop_assert_eq!(position, data.positions[data.face_vertices[index as usize] as usize]);
            }
        }
        if mended.face_sizes.is_empty() {
            return Ok(());
        }
        let mesh = ControlMesh::new(mended.clone()).map_err(|error| TestCaseError::fail(error.to_string()))?;
        let (again, repairs) = repair(mended, &RepairOptions::default());
        prop_assert!(repairs.list.is_empty(), "{:?}", repairs);
        prop_assert!(ControlMesh::new(again).is_ok_and(|again| again == mesh));
    }

    #[test]
    fn a_mesh_stays_as_it_is(data in soup()) {
        if let Ok(mesh) = ControlMesh::new(data.clone()) {
            let (same, repairs) = repair(data, &RepairOptions::default());
            prop_assert!(repairs.list.is_empty() && ControlMesh::new(same).is_ok_and(|same| same == mesh));
        }
    }
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn three_faces_at_an_edge_are_as_opensubdiv_has_them() {
    let limit = common::limit::limit("catmark_fan");
    let path = common::shared().join("meshes/catmark_fan.obj");
    let (mesh, _) = read_repaired(path, &ReadOptions::default(), &RepairOptions::default()).unwrap();
    assert_eq!(mesh.data().boundary, limit.boundary);
    let surface = LimitSurface::new(&mesh).unwrap();
    let last = (limit.side - 1) as f64;
    assert!(limit.records.iter().map(|record| record.face).eq(0..13), "all faces");
    for record in &limit.records {
        for (index, theirs) in record.samples.iter().enumerate() {
            let [u, v] = [index % limit.side, index / limit.side].map(|i| i as f64 / last);
            let error = (surface.evaluate(record.face, record.sub, u, v).position - theirs.position).length();
            assert!(error < 1e-13, "face {} at ({u}, {v}): {error:e}", record.face);
        }
    }
}
