//! Faces, welding, and the ways numbers are stored.

use super::*;

fn ngons(indices: &[u16]) -> MeshData {
    let mut file = File::new(&std::array::from_fn::<_, 8, _>(|i| [i as f32, (i * i) as f32, 0.]), indices);
    file.primitive_mut()["extensions"] = json!({ NGONS: {} });
    file.read()
}

#[test]
fn fans_become_polygons() {
    let data = ngons(&[0, 1, 2, 0, 2, 3, 0, 3, 4, 2, 1, 5, 4, 3, 6, 4, 6, 7]);
    assert_eq!(data.face_sizes, [5, 3, 4]);
    assert_eq!(data.face_vertices, [0, 1, 2, 3, 4, 2, 1, 5, 4, 3, 6, 7]);
}

#[test]
fn a_triangle_that_does_not_go_on_begins_a_polygon() {
    let data = ngons(&[0, 1, 2, 0, 3, 4, 0, 4, 5]);
    assert_eq!(data.face_sizes, [3, 4]);
}

#[test]
fn without_the_extension_triangles_stay() {
    let data = File::new(&SQUARE, &[0, 1, 2, 0, 2, 3]).read();
    assert_eq!((data.face_sizes, data.face_vertices), (vec![3, 3], vec![0, 1, 2, 0, 2, 3]));
    assert_eq!((data.texcoords, data.normals), (None, None));
}

#[test]
fn strips_fans_and_modes_without_surface() {
    let with_mode = |mode: u32, indices: &[u16]| {
        let mut file = File::new(&[SQUARE[0], SQUARE[1], SQUARE[3], SQUARE[2], [2., 0., 0.]], indices);
        // Fans of a whole primitive are no polygons, with the extension or without.
        file.primitive_mut()["extensions"] = json!({ NGONS: {} });
        file.primitive_mut()["mode"] = json!(mode);
        file.try_read(None)
    };
    let strip = with_mode(5, &[0, 1, 2, 3]).unwrap();
    // Vertices are numbered as faces reach them.
    assert_eq!(strip.face_vertices, [0, 1, 2, 1, 3, 2]);
    // Joined by triangles that draw nothing.
    let strips = with_mode(5, &[0, 1, 2, 2, 3, 3, 3, 1, 4]).unwrap();
    assert_eq!(strips.face_vertices, [0, 1, 2, 3, 1, 4]);
    let fan = with_mode(6, &[0, 1, 3, 2]).unwrap();
    assert_eq!(fan.face_vertices, [0, 1, 2, 0, 2, 3]);
    for mode in 0..4 {
        let error = with_mode(mode, &[0, 1, 2, 3]).unwrap_err();
        assert_eq!(error.to_string(), "the scene has no triangles: points and lines have no surface");
    }
    let error = with_mode(7, &[0, 1, 2]).unwrap_err();
    assert_eq!(error.to_string(), "a primitive has an unknown mode: it must be 0 to 6");
}

#[test]
fn triangles_that_draw_nothing_are_passed_over() {
    // With a corner twice, with two corners at one place, and the only ones at a place.
    let pole = [SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[0], [9., 9., 9.]];
    let data = File::new(&pole, &[0, 1, 2, 0, 2, 3, 1, 1, 2, 4, 4, 1]).read();
    assert_eq!((data.face_vertices, data.positions.len()), (vec![0, 1, 2], 3));
}

#[test]
fn lines_beside_triangles_are_passed_over() {
    let mut file = File::square();
    let mut lines = file.primitive(&SQUARE, &[0, 1]);
    lines["mode"] = json!(1);
    file.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(lines);
    file.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(json!({ "attributes": {} }));
    assert_eq!(file.read().face_sizes, [4]);
}

#[test]
fn without_indices_vertices_are_drawn_in_order() {
    let mut file = File::new(&[SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[0], SQUARE[2], SQUARE[3]], &[]);
    file.primitive_mut().as_object_mut().unwrap().remove("indices");
    assert_eq!(file.read().face_vertices, [0, 1, 2, 0, 2, 3]);
}

/// A strip of two squares whose middle edge is split, with the texture coordinates `0, 1, ...` and two normals.
fn seam() -> File {
    let positions = [SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[3], SQUARE[1], [2., 0., 0.], [2., 1., 0.], SQUARE[2]];
    let mut file = File::new(&positions, &[0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7]);
    let texcoords = file.floats(&std::array::from_fn::<[f32; 2], 8, _>(|i| [i as f32, 0.5]));
    let normals = file.floats(&[[[0., 0., 1.]; 4], [[0., 2., 0.]; 4]].concat());
    file.primitive_mut()["attributes"]["TEXCOORD_0"] = json!(texcoords);
    file.primitive_mut()["attributes"]["NORMAL"] = json!(normals);
    file.primitive_mut()["extensions"] = json!({ NGONS: {} });
    file
}

#[test]
fn seams_are_welded_and_their_attributes_kept() {
    let data = seam().read();
    assert_eq!(data.positions.len(), 6);
    assert_eq!(data.face_vertices, [0, 1, 2, 3, 1, 4, 5, 2]);
    let texcoords = data.texcoords.unwrap();
    let of_corners: Vec<f32> = texcoords.indices.iter().map(|&i| texcoords.values[i as usize][0]).collect();
    assert_eq!(of_corners, [0., 1., 2., 3., 4., 5., 6., 7.]);
    let normals = data.normals.unwrap();
    let of_corners: Vec<_> = normals.indices.iter().map(|&i| normals.values[i as usize]).collect();
    assert_eq!(of_corners, [[[0., 0., 1.]; 4], [[0., 1., 0.]; 4]].concat());
}

#[test]
fn zero_and_minus_zero_are_one_place() {
    let mut positions = SQUARE.to_vec();
    positions.push([-0., 0., -0.]);
    assert_eq!(File::new(&positions, &[0, 1, 2, 4, 2, 3]).read().positions.len(), 4);
}

#[test]
fn primitives_of_a_mesh_are_welded_and_may_lack_attributes() {
    let mut file = seam();
    let other = file.primitive(&[[0., 0., 0.], [0., 1., 0.], [-1., 0., 0.]], &[0, 1, 2]);
    file.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(other);
    let data = file.read();
    assert_eq!(data.positions.len(), 7);
    assert_eq!(data.face_vertices[8..], [0, 3, 6]);
    let texcoords = data.texcoords.unwrap();
    assert!(texcoords.indices[8..].iter().all(|&i| texcoords.values[i as usize] == [0., 0.]));
    let normals = data.normals.unwrap();
    assert!(normals.indices[8..].iter().all(|&i| normals.values[i as usize] == [0., 0., 0.]));
}

/// A mesh of boxes, each face with vertices of its own, as files have it that have flat normals: corner and turns of each.
fn boxes(lows: &[[f32; 3]]) -> File {
    const FACES: [[usize; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for low in lows {
        for face in FACES {
            let first = positions.len() as u16;
            positions.extend(
                face.map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|x| x as f32))
                    .map(|p| [p[0] + low[0], p[1] + low[1], p[2] + low[2]]),
            );
            indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
        }
    }
    let mut file = File::new(&positions, &indices);
    file.primitive_mut()["extensions"] = json!({ NGONS: {} });
    file
}

#[test]
fn pieces_that_touch_stay_apart() {
    // In a corner, along an edge, with a whole face; three around an edge; and eight that fill a cube.
    let around = [[0., 0., 0.], [1., 1., 0.], [1., 0., 0.]];
    let block: Vec<[f32; 3]> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|x| x as f32)).collect();
    let cases = [
        &[[0., 0., 0.], [1., 1., 1.]][..],
        &[[0., 0., 0.], [1., 1., 0.]],
        &[[0., 0., 0.], [1., 0., 0.]],
        &around,
        &block,
    ];
    for lows in cases {
        let data = boxes(lows).read();
        assert_eq!((data.positions.len(), data.face_sizes.len()), (8 * lows.len(), 6 * lows.len()), "{lows:?}");
        let mesh = ControlMesh::new(data).unwrap();
        assert_eq!(mesh.boundary_edge_count(), 0, "{lows:?}");
        // Each box is whole: its faces have its eight vertices.
        for part in 0..lows.len() as u32 {
            let mut vertices: Vec<u32> = (6 * part..6 * part + 6).flat_map(|face| mesh.face(face).to_vec()).collect();
            vertices.sort_unstable();
            vertices.dedup();
            assert_eq!(vertices.len(), 8);
        }
    }
}

#[test]
fn a_sheet_and_its_back_stay_apart() {
    let back = [SQUARE[3], SQUARE[2], SQUARE[1], SQUARE[0]];
    // Twice the same way round: a picture on a wall.
    for other in [back, SQUARE] {
        let mut file = File::new(&[SQUARE, other].concat(), &[0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7]);
        file.primitive_mut()["extensions"] = json!({ NGONS: {} });
        let mesh = ControlMesh::new(file.read()).unwrap();
        assert_eq!((mesh.vertex_count(), mesh.boundary_edge_count()), (8, 8));
    }
}

#[test]
fn a_fin_stays_apart_from_what_it_stands_on() {
    let fin = [[1., 0., 0.], [1., 1., 0.], [1., 1., 1.], [1., 0., 1.]];
    let right = [[1., 0., 0.], [2., 0., 0.], [2., 1., 0.], [1., 1., 0.]];
    let mut file =
        File::new(&[SQUARE, fin, right].concat(), &[0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7, 8, 9, 10, 8, 10, 11]);
    file.primitive_mut()["extensions"] = json!({ NGONS: {} });
    let data = file.read();
    assert_eq!(data.face_vertices, [0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 9, 2]);
}

#[test]
fn indices_of_every_type() {
    let bytes = |size: usize| [0u8, 1, 2, 0, 2, 3].map(|i| (i as u32).to_le_bytes()[..size].to_vec()).concat();
    for (component, size) in [(5121, 1), (5123, 2), (5125, 4)] {
        let mut file = File::square();
        let indices = file.accessor(&bytes(size), 6, "SCALAR", component);
        file.primitive_mut()["indices"] = json!(indices);
        assert_eq!(file.read().face_vertices, [0, 1, 2, 3], "{component}");
    }
}

#[test]
fn quantized_positions_and_texture_coordinates() {
    let mut file = File::square();
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization", "FB_ngon_encoding", "KHR_materials_unlit"]);
    // Three bytes and one of padding each.
    let corners = file.accessor(&[0, 0, 0, 9, 127, 0, 0, 9, 127, 129, 0, 9, 0, 128, 0, 9], 4, "VEC3", 5120);
    let view = file.json["accessors"][corners]["bufferView"].as_u64().unwrap() as usize;
    file.json["bufferViews"][view]["byteStride"] = json!(4);
    file.primitive_mut()["attributes"]["POSITION"] = json!(corners);
    let texcoords = [0u16, 0, 65535, 0, 65535, 65535, 0, 13107].map(u16::to_le_bytes).concat();
    let texcoords = file.accessor(&texcoords, 4, "VEC2", 5123);
    file.json["accessors"][texcoords]["normalized"] = json!(true);
    file.primitive_mut()["attributes"]["TEXCOORD_0"] = json!(texcoords);
    let data = file.read();
    assert_eq!(data.positions, [[0., 0., 0.], [127., 0., 0.], [127., -127., 0.], [0., -128., 0.]]);
    assert_eq!(data.texcoords.unwrap().values, [[0., 0.], [1., 0.], [1., 1.], [0., 0.2]]);
}

#[test]
fn normalized_integers_reach_from_minus_one_to_one() {
    let mut file = File::square();
    let corners = [0i16, 0, 0, 32767, 0, 0, 32767, -32767, 0, 0, -32768, 0].map(i16::to_le_bytes).concat();
    let corners = file.accessor(&corners, 4, "VEC3", 5122);
    file.json["accessors"][corners]["normalized"] = json!(true);
    file.primitive_mut()["attributes"]["POSITION"] = json!(corners);
    assert_eq!(file.read().positions, [[0., 0., 0.], [1., 0., 0.], [1., -1., 0.], [0., -1., 0.]]);
}

/// Makes the positions sparse: those of vertices 1 and 3 are replaced.
fn sparse(base: bool) -> File {
    let mut file = File::square();
    let indices = file.view(&[1, 3]);
    let values = file
        .view(&[[7f32, 0., 0.], [0., 8., 0.]].as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>());
    file.json["accessors"][0]["sparse"] = json!({
        "count": 2,
        "indices": { "bufferView": indices, "componentType": 5121 },
        "values": { "bufferView": values },
    });
    if !base {
        file.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    }
    file
}

#[test]
fn sparse_accessors() {
    let data = sparse(true).read();
    assert_eq!(data.positions, [[0., 0., 0.], [7., 0., 0.], [1., 1., 0.], [0., 8., 0.]]);
    let mut file = sparse(false);
    let indices = file.shorts(&[0, 1, 3]);
    file.primitive_mut()["indices"] = json!(indices);
    assert_eq!(file.read().positions, [[0., 0., 0.], [7., 0., 0.], [0., 8., 0.]]);
}

#[test]
fn sparse_accessors_that_are_wrong() {
    let mut file = sparse(true);
    let indices = file.view(&[3, 1]);
    file.json["accessors"][0]["sparse"]["indices"]["bufferView"] = json!(indices);
    file.assert_error("accessor 0 has sparse indices that do not increase or are out of range");
    let mut file = sparse(true);
    let indices = file.view(&[1, 4]);
    file.json["accessors"][0]["sparse"]["indices"]["bufferView"] = json!(indices);
    file.assert_error("accessor 0 has sparse indices that do not increase or are out of range");
    let mut file = sparse(true);
    file.json["accessors"][0]["sparse"]["indices"]["componentType"] = json!(5126);
    file.assert_error("accessor 0 has sparse indices of unknown type");
    let mut file = sparse(true);
    file.json["accessors"][0]["sparse"]["count"] = json!(3);
    file.assert_error("accessor 0 reaches beyond its buffer view");
    // A count without bytes behind it must not be believed.
    let mut file = sparse(false);
    file.json["accessors"][0]["count"] = json!(u64::MAX);
    file.primitive_mut().as_object_mut().unwrap().remove("indices");
    file.assert_error("positions that are drawn without indices need a buffer view: write the file again");
    let mut file = File::square();
    file.json["accessors"][1].as_object_mut().unwrap().remove("bufferView");
    file.json["accessors"][1]["count"] = json!(u64::MAX);
    file.assert_error("indices need a buffer view: write the file again");
}
