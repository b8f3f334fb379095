use super::*;
use crate::mesh::ObjOptions;

/// Two quads that share an edge, and a triangle beside them; vertex 7 is vertex 1 with another normal.
fn polygons() -> Polygons<'static> {
    const POSITIONS: [[f32; 3]; 8] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.25],
        [2.0, 0.0, 1.0],
        [2.0, 1.0, 1.0],
        [3.0, 0.5, 1.0],
        [1.0, 0.0, 0.0],
    ];
    const NORMALS: [[f32; 3]; 8] = [[0.0, 0.0, 1.0]; 8];
    const TEXCOORDS: [[f32; 2]; 8] =
        [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [1.5, 0.5], [0.75, 0.0]];
    Polygons {
        positions: &POSITIONS,
        normals: &NORMALS,
        texcoords: Some(&TEXCOORDS),
        copies: (7, &[1]),
        quads: &[[0, 1, 2, 3], [7, 4, 5, 2]],
        triangles: &[[4, 6, 5]],
    }
}

#[test]
fn obj_is_read_back_as_one_surface() {
    let mut text = Vec::new();
    write_obj(&polygons(), &mut text).unwrap();
    let mesh = crate::ControlMesh::from_obj_str(&String::from_utf8(text).unwrap(), &ObjOptions::default()).unwrap();
    assert_eq!((mesh.vertex_count(), mesh.face_count(), mesh.boundary_edge_count()), (7, 3, 7));
    assert_eq!(mesh.face(1), [1, 4, 5, 2]);
    let texcoords = mesh.data().texcoords.as_ref().unwrap();
    assert_eq!(texcoords.values[texcoords.indices[4] as usize], [0.75, 0.0]);
}

#[test]
fn ply_has_what_its_header_says() {
    let mut bytes = Vec::new();
    write_ply(&polygons(), &mut bytes).unwrap();
    let end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let header = String::from_utf8(bytes[..end].to_vec()).unwrap();
    assert!(header.contains("element vertex 8\n") && header.contains("element face 3\n"), "{header}");
    let body = &bytes[end..];
    assert_eq!(body.len(), 8 * 8 * 4 + 2 * (1 + 16) + (1 + 12));
    let number = |at: usize| f32::from_le_bytes(body[4 * at..4 * at + 4].try_into().unwrap());
    // Vertex 3: position, normal, texture coordinates.
    let vertex: Vec<f32> = (24..32).map(number).collect();
    assert_eq!(vertex, [0.0, 1.0, 0.25, 0.0, 0.0, 1.0, 0.0, 0.0]);
    assert_eq!(&body[8 * 32..8 * 32 + 9], &[4, 0, 0, 0, 0, 1, 0, 0, 0]);
    assert_eq!(body[8 * 32 + 34], 3);
}

#[cfg(feature = "gltf")]
#[test]
fn glb_is_read_back() {
    let mut bytes = Vec::new();
    write_glb(&Polygons { triangles: &[[0, 1, 2], [0, 2, 3], [4, 6, 5]], ..polygons() }, &mut bytes).unwrap();
    assert_eq!(u32::from_le_bytes(bytes[8..12].try_into().unwrap()) as usize, bytes.len());
    let document = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = document.blob.as_deref().unwrap();
    let primitive = document.meshes().next().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(blob));
    let mesh = polygons();
    assert_eq!(reader.read_positions().unwrap().collect::<Vec<_>>(), mesh.positions);
    assert_eq!(reader.read_normals().unwrap().collect::<Vec<_>>(), mesh.normals);
    assert_eq!(reader.read_tex_coords(0).unwrap().into_f32().collect::<Vec<_>>(), mesh.texcoords.unwrap());
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    assert_eq!(indices, [0, 1, 2, 0, 2, 3, 4, 6, 5]);
    assert_eq!(primitive.bounding_box().max, [3.0, 1.0, 1.0]);
}
