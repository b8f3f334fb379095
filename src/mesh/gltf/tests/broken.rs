//! Containers, buffers, accessors and meshes that are wrong.

use super::*;
use base64::Engine as _;

#[track_caller]
fn assert_bytes_error(bytes: &[u8], expected: &str) {
    let error = ControlMesh::from_gltf_bytes(bytes, &GltfOptions::default()).unwrap_err();
    assert_eq!(error.to_string(), expected);
}

#[test]
fn containers() {
    let good = File::square().glb();
    let cut_off = "the GLB file is cut off: write or copy it again";
    for length in 4..good.len() {
        assert_bytes_error(&good[..length], cut_off);
    }
    let with = |offset: usize, number: u32| {
        let mut bytes = good.clone();
        bytes[offset..offset + 4].copy_from_slice(&number.to_le_bytes());
        bytes
    };
    assert_bytes_error(&with(4, 1), "GLB version 1 can't be read: save the file as glTF 2.0");
    assert_bytes_error(&with(8, 11), cut_off);
    assert_bytes_error(&with(8, 15), cut_off);
    assert_bytes_error(&with(12, u32::MAX), cut_off);
    assert_bytes_error(&glb(&[]), "the GLB file has no JSON chunk: write it again");
    assert_bytes_error(b"", "the file is not glTF 2.0: EOF while parsing a value at line 1 column 0");
    assert_bytes_error(b"{}", "the file is not glTF 2.0: missing field `asset`");
    assert_bytes_error(b"v 0 0 0", "the file is not glTF 2.0: expected value at line 1 column 1");
}

#[test]
fn chunks_of_extensions_are_passed_over() {
    let mut file = File::square();
    file.json["buffers"] = json!([{ "byteLength": file.buffer.len() }]);
    let json = file.json_bytes();
    let bytes = glb(&[(b"XTRA", b"1234"), (b"JSON", &json), (b"XTRA", b""), (b"BIN\0", &file.buffer)]);
    assert!(ControlMesh::from_gltf_bytes(&bytes, &GltfOptions::default()).is_ok());
}

#[test]
fn parts_that_are_not_geometry_do_not_matter() {
    let mut file = File::square();
    file.json["materials"] = json!("broken");
    file.json["textures"] = json!([{ "extensions": { "EXT_texture_webp": {} } }]);
    file.json["extensionsRequired"] = json!([
        "EXT_texture_webp",
        "KHR_texture_basisu",
        "KHR_lights_punctual",
        "MSFT_texture_dds",
        "KHR_xmp_json_ld",
        "KHR_animation_pointer",
    ]);
    assert_eq!(file.read().face_sizes, [4]);
}

#[test]
fn required_extensions() {
    let mut file = File::square();
    file.json["extensionsRequired"] = json!([NGONS]);
    assert_eq!(file.read().face_sizes, [4]);
    let mut file = File::square();
    file.json["extensionsRequired"] = json!([NGONS, "KHR_draco_mesh_compression"]);
    let expected = "the file requires the extension KHR_draco_mesh_compression, which is not supported: \
                    export it without";
    file.assert_error(expected);
}

#[test]
fn compressed_geometry_is_named_where_it_is_not_required() {
    let mut file = File::square();
    for accessor in file.json["accessors"].as_array_mut().unwrap() {
        accessor.as_object_mut().unwrap().remove("bufferView");
    }
    file.primitive_mut()["extensions"] = json!({ "KHR_draco_mesh_compression": { "bufferView": 0, "attributes": {} } });
    file.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    let expected =
        "the file requires the extension KHR_draco_mesh_compression, which is not supported: export it without";
    file.assert_error(expected);
}

/// The square as JSON alone, with its buffer at `uri`.
fn with_uri(uri: &str) -> Vec<u8> {
    let mut file = File::square();
    file.json["buffers"] = json!([{ "byteLength": file.buffer.len(), "uri": uri }]);
    file.json_bytes()
}

#[test]
fn buffers_in_data_uris() {
    let encoded = base64::engine::general_purpose::STANDARD.encode(File::square().buffer);
    for encoded in [encoded.as_str(), encoded.trim_end_matches('=')] {
        let bytes = with_uri(&format!("data:application/octet-stream;base64,{encoded}"));
        let mesh = ControlMesh::from_gltf_bytes(&bytes, &GltfOptions::default()).unwrap();
        assert_eq!(mesh.into_data(), File::square().read());
    }
    assert_bytes_error(&with_uri("data:,x"), "buffer 0: the data URI is not in base64: encode it so");
    let expected = "buffer 0: the data URI is not valid base64: Invalid symbol 33, offset 0.";
    assert_bytes_error(&with_uri("data:;base64,!"), expected);
}

#[test]
fn buffers_in_files() {
    let folder = std::env::temp_dir().join(format!("ash-subdiv-gltf-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("a b")).unwrap();
    std::fs::write(folder.join("a b/ü.bin"), File::square().buffer).unwrap();
    let options = GltfOptions { folder: Some(folder.clone()), ..GltfOptions::default() };
    let read = |uri: &str| ControlMesh::from_gltf_bytes(&with_uri(uri), &options);
    // Blender 3.4 wrote names as they are.
    std::fs::write(folder.join("50% square.bin"), File::square().buffer).unwrap();
    std::fs::write(folder.join("%41.bin"), File::square().buffer).unwrap();
    for uri in ["a%20b/%C3%BC.bin", "a b/ü.bin", "50% square.bin", "50%25%20square.bin", "%41.bin"] {
        assert_eq!(read(uri).unwrap().into_data(), File::square().read());
    }
    let error = |uri: &str| read(uri).unwrap_err().to_string();
    assert_eq!(error("b.bin"), "buffer 0: there is no file \"b.bin\" next to this one");
    assert_eq!(error("a%20b"), "buffer 0: there is no file \"a b\" next to this one");
    let relative = "is not a relative file name: put the file next to this one";
    assert_eq!(error("/dev/zero"), format!("buffer 0: \"/dev/zero\" {relative}"));
    assert_eq!(error("http://a/b"), format!("buffer 0: \"http://a/b\" {relative}"));
    for uri in ["a%2", "a%", "a%zz", "a%ff"] {
        assert_eq!(error(uri), format!("buffer 0: there is no file \"{uri}\" next to this one"));
    }
    std::fs::remove_dir_all(folder).unwrap();
    let expected = "buffer 0: \"b.bin\" can't be found from memory: read the file by its path";
    assert_bytes_error(&with_uri("b.bin"), expected);
}

#[test]
fn buffers_that_are_missing_or_short() {
    let mut file = File::square();
    file.json["buffers"] = json!([{ "byteLength": 0 }, { "byteLength": 0 }]);
    file.assert_error("buffer 1 has no data: give it a URI or use GLB");
    let mut file = File::square();
    file.json["buffers"] = json!([{ "byteLength": 0 }]);
    assert_bytes_error(&file.json_bytes(), "buffer 0 has no data: give it a URI or use GLB");
    let mut file = File::square();
    file.json["buffers"] = json!([{ "byteLength": 1000 }]);
    file.assert_error("buffer 0 has 60 bytes, but 1000 are announced");
}

#[test]
fn accessors() {
    let error = |change: fn(&mut Value), expected: &str| {
        let mut file = File::square();
        change(&mut file.json);
        file.assert_error(expected);
    };
    let beyond = "accessor 0 reaches beyond its buffer view";
    error(|json| json["accessors"][0]["count"] = json!(5), beyond);
    error(|json| json["accessors"][0]["count"] = json!(u64::MAX), beyond);
    error(|json| json["accessors"][0]["byteOffset"] = json!(1), beyond);
    error(|json| json["accessors"][0]["byteOffset"] = json!(u64::MAX), beyond);
    error(|json| json["accessors"][0]["bufferView"] = json!(9), beyond);
    error(|json| json["bufferViews"][0]["buffer"] = json!(1), beyond);
    error(|json| json["bufferViews"][0]["byteOffset"] = json!(u64::MAX), beyond);
    error(|json| json["bufferViews"][0]["byteLength"] = json!(u64::MAX), beyond);
    error(|json| json["bufferViews"][0]["byteStride"] = json!(8), beyond);
    error(|json| json["bufferViews"][0]["byteStride"] = json!(u64::MAX), beyond);
    error(|json| json["accessors"][0]["type"] = json!("VEC2"), "accessor 0 is a VEC2, but a VEC3 is needed");
    error(|json| json["accessors"][0]["type"] = json!("VEC5"), "accessor 0 has an unknown type");
    error(|json| json["accessors"][0]["componentType"] = json!(5124), "accessor 0 has an unknown component type");
    let signed = "accessor 1 has indices that are not unsigned integers";
    error(|json| json["accessors"][1]["componentType"] = json!(5122), signed);
    let missing = "accessor 7 does not exist, but something names it";
    error(|json| json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(7), missing);
    error(|json| json["meshes"][0]["primitives"][0]["indices"] = json!(7), missing);
}

#[test]
fn attributes_and_indices_that_do_not_fit_the_positions() {
    let mut file = File::square();
    let texcoords = file.floats(&[[0f32; 2]; 3]);
    file.primitive_mut()["attributes"]["TEXCOORD_0"] = json!(texcoords);
    file.assert_error("TEXCOORD_0 has 3 elements, but POSITION has 4");
    let mut file = File::square();
    let normals = file.floats(&[[0f32; 3]; 5]);
    file.primitive_mut()["attributes"]["NORMAL"] = json!(normals);
    file.assert_error("NORMAL has 5 elements, but POSITION has 4");
    File::new(&SQUARE, &[0, 1, 4]).assert_error("an index is 4, but POSITION has 4 elements");
}

#[test]
fn meshes_that_are_wrong() {
    let mut pinched = File::new(&[SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[0]], &[0, 1, 2, 0, 2, 3]);
    pinched.primitive_mut()["extensions"] = json!({ NGONS: {} });
    pinched.assert_error("face 0 names vertex 0 twice: remove the repeated vertex, or split the face there");
    let turned = "faces 0 and 1 both run along the edge 0-2 in the same direction: \
                  turn one of them round so that all faces are counter-clockwise from outside";
    File::new(&SQUARE, &[0, 1, 2, 3, 2, 0]).assert_error(turned);
    let third = "face 2 is the third face at the edge 0-1: an edge has one or two faces; separate the surfaces there";
    let five = [SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[3], [0., 0., 1.]];
    File::new(&five, &[0, 1, 2, 1, 0, 3, 0, 1, 4]).assert_error(third);
    let infinite = [[0., 0., 0.], [1., f32::INFINITY, 0.], [0., 1., 0.]];
    File::new(&infinite, &[0, 1, 2])
        .assert_error("vertex 1 is at (1, inf, 0): positions must be finite numbers of at most 3.4e38");
    let none = "the scene has no triangles: points and lines have no surface";
    File::empty().assert_error(none);
    File::new(&SQUARE, &[0, 1]).assert_error(none);
}
