//! Nothing that is read, however broken, may panic, run for long or use up memory.

use ash_subdiv::ControlMesh;
use ash_subdiv::mesh::{ObjOptions, RepairOptions};
use proptest::prelude::*;

const OBJ: &str = "# comment\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 1\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\n\
    f 1/1/1 2/2/1 3/1/1 4/2/1\nf -5 -2 \\\n -1 -4\nt crease 2/1/0 1 2 3\nt crease 3/2/0 0 1 4 1 2\n\
    t corner 1/1/0 0 2\nt hole 1/0/0 1\nt interpolateboundary 1/0/0 1\nt creasemethod 0/0/1 chaikin\n";

fn read_obj(bytes: &[u8]) {
    for drop_isolated in [false, true] {
        let _ = ControlMesh::from_obj_bytes(bytes, &ObjOptions { drop_isolated });
    }
    for weld in [None, Some(0.0), Some(0.01)] {
        let _ = ControlMesh::from_obj_bytes_repaired(bytes, &RepairOptions { weld });
    }
}

/// Words that are likely to mean something.
fn word() -> impl Strategy<Value = String> {
    prop_oneof![
        4 => (-7i64..8).prop_map(|x| x.to_string()),
        2 => prop::sample::select(vec![
            "v", "vt", "vn", "f", "t", "crease", "corner", "hole", "interpolateboundary", "creasemethod",
            "smoothtriangles", "2/1/0", "1/1/0", "1/0/0", "0/0/1", "chaikin", "smooth", "1/1", "2//1", "1/1/1", "/",
            "\\", "#", "\n", "\r\n", "\\\n", "nan", "inf", "1e400", "4294967295", "4294967296",
            "99999999999999999999/0/0", "18446744073709551615/1/1", "-9223372036854775808", "é",
        ]).prop_map(str::to_owned),
        1 => any::<f64>().prop_map(|x| x.to_string()),
    ]
}

/// Puts, takes out, changes and swaps bytes.
fn mutated(valid: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
    let edit = (any::<prop::sample::Index>(), any::<u8>(), 0..4u8);
    prop::collection::vec(edit, 1..8).prop_map(move |edits| {
        let mut bytes = valid.clone();
        for (place, byte, kind) in edits {
            if bytes.is_empty() {
                break;
            }
            let place = place.index(bytes.len());
            match kind {
                0 => bytes[place] = byte,
                1 => bytes.insert(place, byte),
                2 => drop(bytes.remove(place)),
                _ => bytes[place] ^= 1 << (byte % 8),
            }
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 1000, ..ProptestConfig::default() })]

    #[test]
    fn obj_of_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        read_obj(&bytes);
    }

    #[test]
    fn obj_of_words(words in prop::collection::vec(word(), 0..60)) {
        read_obj(words.join(" ").as_bytes());
        read_obj(format!("{OBJ}{}", words.join(" ")).as_bytes());
    }

    #[test]
    fn obj_mutated(bytes in mutated(OBJ.into())) {
        read_obj(&bytes);
    }

    #[test]
    fn obj_with_lines_in_any_order(lines in Just(OBJ.lines().collect::<Vec<_>>()).prop_shuffle()) {
        read_obj(lines.join("\n").as_bytes());
    }
}

#[cfg(feature = "gltf")]
pub(crate) mod gltf {
    use super::*;
    use ash_subdiv::mesh::GltfOptions;
    use serde_json::{Value, json};

    /// A file that has a bit of everything.
    fn valid_json() -> Value {
        json!({
            "asset": { "version": "2.0" },
            "extensionsUsed": ["FB_ngon_encoding"],
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [
                { "children": [1, 2], "translation": [1, 2, 3], "rotation": [0, 0, 1, 0], "scale": [1, -1, 1] },
                { "mesh": 0, "name": "node" },
                { "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] },
            ],
            "meshes": [{ "name": "mesh", "primitives": [
                { "attributes": { "POSITION": 0, "TEXCOORD_0": 2 }, "indices": 1, "mode": 4,
                  "extensions": { "FB_ngon_encoding": {} } },
            ] }],
            "accessors": [
                { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "sparse": {
                    "count": 1, "indices": { "bufferView": 1, "byteOffset": 2, "componentType": 5123 },
                    "values": { "bufferView": 0, "byteOffset": 12 } } },
                { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" },
                { "bufferView": 0, "byteOffset": 4, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC2" },
            ],
            "bufferViews": [
                { "buffer": 0, "byteLength": 48, "byteStride": 12 },
                { "buffer": 0, "byteOffset": 48, "byteLength": 12 },
            ],
            "buffers": [{ "byteLength": 60 }],
        })
    }

    pub(crate) fn glb(json: &Value) -> Vec<u8> {
        let mut json = serde_json::to_vec(json).unwrap();
        json.resize(json.len().next_multiple_of(4), b' ');
        let corners = [[0f32, 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        let mut buffer: Vec<u8> = corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        buffer.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
        let mut glb = b"glTF\x02\0\0\0".to_vec();
        glb.extend((28 + json.len() as u32 + buffer.len() as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", json), (b"BIN\0", buffer)] {
            glb.extend((chunk.len() as u32).to_le_bytes());
            glb.extend(kind);
            glb.extend(chunk);
        }
        glb
    }

    /// The same with a skin and an animation; its numbers are those of the mesh.
    #[cfg(all(feature = "exr", feature = "headless"))]
    pub(crate) fn animated_json() -> Value {
        let mut json = valid_json();
        json["nodes"][1]["skin"] = 0.into();
        json["skins"] = json!([{ "joints": [1, 2] }]);
        let accessors = json["accessors"].as_array_mut().unwrap();
        accessors
            .push(json!({ "bufferView": 0, "byteOffset": 8, "componentType": 5126, "count": 2, "type": "SCALAR" }));
        accessors.push(json!({ "bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3" }));
        accessors.push(json!({ "bufferView": 1, "componentType": 5121, "count": 4, "type": "VEC4", "byteOffset": 0 }));
        accessors
            .push(json!({ "bufferView": 0, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4" }));
        json["bufferViews"].as_array_mut().unwrap().push(json!({ "buffer": 0, "byteLength": 16, "byteOffset": 40 }));
        json["accessors"][5]["bufferView"] = 2.into();
        json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = 5.into();
        json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = 6.into();
        json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": 0 }]);
        json["animations"] = json!([{
            "samplers": [{ "input": 3, "output": 4 }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "scale" } }],
        }]);
        json
    }

    fn read_gltf(bytes: &[u8]) -> bool {
        let named = GltfOptions { mesh: Some("node".into()), quads: true, ..GltfOptions::default() };
        let _ = ControlMesh::from_gltf_bytes(bytes, &named);
        ControlMesh::from_gltf_bytes(bytes, &GltfOptions::default()).is_ok()
    }

    /// The pointers of all values in `value`.
    fn pointers(value: &Value, at: &str, found: &mut Vec<String>) {
        match value {
            Value::Object(members) => {
                members.iter().for_each(|(key, value)| pointers(value, &format!("{at}/{key}"), found))
            }
            Value::Array(items) => {
                items.iter().enumerate().for_each(|(i, value)| pointers(value, &format!("{at}/{i}"), found))
            }
            _ => {}
        }
        found.push(at.to_owned());
    }

    fn all_pointers() -> Vec<String> {
        let mut found = Vec::new();
        pointers(&valid_json(), "", &mut found);
        found
    }

    /// Values that are likely to be at the edge of something.
    fn edge_value() -> impl Strategy<Value = Value> {
        prop_oneof![
            prop::sample::select(vec![
                json!(null),
                json!([]),
                json!({}),
                json!(""),
                json!("VEC3"),
                json!("data:;base64,AAAA"),
                json!(-1),
                json!(0),
                json!(0.5),
                json!(1e308),
                json!(252),
                json!(5120),
                json!(5121),
                json!(5125),
                json!(5126),
                json!(u32::MAX),
                json!(1u64 << 32),
                json!(i64::MAX),
                json!(u64::MAX),
                json!(u64::MAX - 11),
            ]),
            (0..8u64).prop_map(|x| json!(x)),
        ]
    }

    #[test]
    fn the_file_that_is_mutated_is_valid() {
        assert!(read_gltf(&glb(&valid_json())));
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 2000, ..ProptestConfig::default() })]

        #[test]
        fn glb_of_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            read_gltf(&bytes);
            read_gltf(&[b"glTF\x02\0\0\0", bytes.as_slice()].concat());
        }

        #[test]
        fn glb_mutated(bytes in mutated(glb(&valid_json()))) {
            read_gltf(&bytes);
        }

        #[test]
        fn gltf_with_values_replaced(
            edits in prop::collection::vec((prop::sample::select(all_pointers()), edge_value()), 1..4),
        ) {
            let mut json = valid_json();
            for (pointer, value) in edits {
                if let Some(place) = json.pointer_mut(&pointer) {
                    *place = value;
                }
            }
            read_gltf(&glb(&json));
        }
    }
}

mod ply {
    use super::*;

    const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n";

    fn read_ply(bytes: &[u8]) {
        let _ = ControlMesh::from_ply_bytes(bytes);
        let _ = ControlMesh::from_ply_bytes_repaired(bytes, &RepairOptions::default());
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 1000, ..ProptestConfig::default() })]

        #[test]
        fn ply_mutated(bytes in mutated(PLY.into())) {
            read_ply(&bytes);
            let binary = String::from_utf8_lossy(&bytes).replace("ascii", "binary_big_endian");
            read_ply(binary.as_bytes());
        }
    }
}
