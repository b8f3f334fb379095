use super::*;
use crate::mesh::{GltfOptions, shape, shapes};

/// Vertices of faces in the place where they are, each face from its least place on.
fn faces(mesh: &ControlMesh) -> Vec<Vec<[u64; 3]>> {
    let place = |&vertex: &u32| mesh.position(vertex).to_array().map(|x| (f64::from(x as f32) + 0.0).to_bits());
    let face = |face: &[u32]| {
        let mut places: Vec<_> = face.iter().map(place).collect();
        let least = (0..places.len()).min_by_key(|&k| places[k]).unwrap_or(0);
        places.rotate_left(least);
        places
    };
    corners_of(mesh).map(face).collect()
}

/// Texture coordinates of each face, sorted.
fn texcoords(mesh: &ControlMesh) -> Option<Vec<Vec<[u32; 2]>>> {
    let texcoords = mesh.data().texcoords.as_ref()?;
    let of_face = |face: u32| {
        let corners = mesh.face_corners(face);
        let value = |corner| texcoords.values[texcoords.indices[corner] as usize].map(|x: f32| (x + 0.0).to_bits());
        let mut values: Vec<_> = corners.map(value).collect();
        values.sort_unstable();
        values
    };
    Some((0..mesh.face_count() as u32).map(of_face).collect())
}

#[test]
fn glb_and_ply_are_read_back_with_their_polygons() {
    for info in shapes() {
        let mesh = shape(info.name).unwrap();
        let (mut glb, mut ply) = (Vec::new(), Vec::new());
        write_glb(&mesh, &mut glb).unwrap();
        write_ply(&mesh, &mut ply).unwrap();
        let glb = ControlMesh::from_gltf_bytes(&glb, &GltfOptions::default()).unwrap();
        let ply = ControlMesh::from_ply_bytes(&ply).unwrap();
        for (format, read) in [("glb", &glb), ("ply", &ply)] {
            assert_eq!(faces(read), faces(&mesh), "{} {format}", info.name);
            let counts = |mesh: &ControlMesh| [mesh.vertex_count(), mesh.edge_count(), mesh.boundary_edge_count()];
            assert_eq!(counts(read), counts(&mesh), "{} {format}", info.name);
        }
        assert_eq!(texcoords(&glb), texcoords(&mesh), "{}", info.name);
        assert_eq!(ply.data().texcoords.is_some(), mesh.data().texcoords.is_some());
    }
}
