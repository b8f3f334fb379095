//! Files that announce more than they hold, or draw more than anyone wants: one clear error, before memory is taken.

use ash_subdiv::mesh::{Limits, MeshError, ObjOptions, ReadOptions, RepairOptions, read, read_animated, read_repaired};
use ash_subdiv::{ControlMesh, MeshData};
use std::fmt::Write;
use std::path::{Path, PathBuf};

fn written(name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("limits");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn limited(limits: &[(&str, u64)]) -> ReadOptions {
    let with = |all: Limits, &(name, limit): &(&str, u64)| all.with(name, limit).unwrap();
    ReadOptions { limits: limits.iter().fold(Limits::default(), with), ..ReadOptions::default() }
}

#[track_caller]
fn assert_error(path: &Path, options: &ReadOptions, expected: &str) {
    let expected = format!("{}: {expected}", path.display());
    assert_eq!(read(path, options).unwrap_err().to_string(), expected);
    assert_eq!(read_repaired(path, options, &RepairOptions::default()).unwrap_err().to_string(), expected);
    assert_eq!(read_animated(path, options, None).unwrap_err().to_string(), expected);
}

const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

#[test]
fn each_limit_is_named_where_it_is_passed_and_read_up_to() {
    let path = written("quad.obj", QUAD);
    let bytes = QUAD.len() as u64;
    for (name, what, count) in
        [("bytes", "bytes", bytes), ("vertices", "vertices", 4), ("faces", "faces", 1), ("corners", "face corners", 4)]
    {
        let max = count - 1;
        let expected = format!(
            "the file has {count} {what} or more: at most {max} are read; raise the limit \"{name}\" if they are meant"
        );
        assert_error(&path, &limited(&[(name, max)]), &expected);
        assert!(read(&path, &limited(&[(name, count)])).is_ok(), "{name}");
    }
    assert!(Limits::default().with("verticess", 1).is_none());
}

#[test]
#[cfg(unix)]
fn a_file_without_end_is_read_up_to_the_limit() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("limits-endless.obj");
    let _ = std::fs::remove_file(&path);
    std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
    let expected =
        "the file has 1000001 bytes or more: at most 1000000 are read; raise the limit \"bytes\" if they are meant";
    assert_error(&path, &limited(&[("bytes", 1_000_000)]), expected);
}

#[test]
fn a_ply_header_may_claim_anything() {
    let header = |vertices: u64, faces: u64| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
             element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
        )
    };
    let path = written("claims.ply", header(4_000_000_000, 1));
    let of = |count, what| {
        format!(
            "the file has {count} {what} or more: at most 50000000 are read; raise the limit \"{what}\" if they are meant"
        )
    };
    assert_error(&path, &ReadOptions::default(), &of(4_000_000_000u64, "vertices"));
    let path = written("claims-faces.ply", header(3, u64::MAX));
    assert_error(&path, &ReadOptions::default(), &of(u64::MAX, "faces"));
    // As many as may be, but nothing is there.
    let path = written("claims-less.ply", header(50_000_000, 1));
    let expected = "element \"vertex\", row 0: the file ends there: write or copy it again";
    assert_error(&path, &ReadOptions::default(), expected);
    let list = header(3, 1) + "0 0 0 1 0 0 1 1 0\n4000000000 0 1 2\n";
    let expected = "element \"face\", row 0: the file ends there: write or copy it again";
    assert_error(&written("list.ply", list), &ReadOptions::default(), expected);
}

#[test]
fn nonsense_of_some_megabytes_is_one_short_error() {
    // As long as no byte is ASCII, no byte is valid UTF-8, and no line ends.
    let nonsense = vec![0xff; 8 << 20];
    let path = written("nonsense.obj", &nonsense);
    assert_error(&path, &ReadOptions::default(), "the mesh has no vertices: a control mesh needs at least one face");
    let path = written("nonsense-face.obj", [b"f ".as_slice(), &nonsense].concat());
    let error = read(&path, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("line 1: ") && error.len() < 3000, "{} bytes", error.len());
    let path = written("nonsense.ply", [b"ply\n".as_slice(), &nonsense, b"\n"].concat());
    let error = read(&path, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.ends_with("can't be read: write the file again") && error.len() < 3000, "{} bytes", error.len());
}

#[test]
fn a_million_tags_are_read() {
    let mut text = QUAD.to_owned();
    for tag in 0..250_000 {
        writeln!(text, "t crease 2/1/0 0 {} 2\nt corner 1/1/0 {} 2", tag % 4, tag % 5).unwrap();
        writeln!(text, "t hole 1/0/0 {}\nt vertexedit 2/3/3 1 0 0 0 1 add P value", tag % 2).unwrap();
    }
    // Each has one fault: edges that are none, or paths that are too short.
    let error = ControlMesh::from_obj_str(&text, &ObjOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("line 9: path 0 has 1 number: "), "{error}");
    let text = text.replace("2/3/3 1 0 0 0 1", "3/3/3 2 0 0 0 0 1");
    let (mesh, repairs) = ControlMesh::from_obj_bytes_repaired(text.as_bytes(), &RepairOptions::default()).unwrap();
    assert_eq!((mesh.position(0).z, mesh.data().holes.as_slice()), (250_000.0, [0].as_slice()));
    let gone: usize = repairs.list.iter().map(|repair| repair.count).sum();
    // Of four creases two are edges, of five corners four are there, of two holes one.
    assert_eq!(gone, 125_000 + 50_000 + 125_000);
}

#[test]
fn arrays_beyond_numbering_are_errors() {
    let data = MeshData { face_sizes: vec![u32::MAX; 3], ..MeshData::default() };
    let (data, _) = ash_subdiv::mesh::repair(data, &RepairOptions::default());
    assert_eq!(ControlMesh::new(data), Err(MeshError::Empty { what: "vertices" }));
    let data = MeshData { positions: vec![[0.0; 3]; 3], face_sizes: vec![u32::MAX; 3], ..MeshData::default() };
    assert!(matches!(ControlMesh::new(data), Err(MeshError::CornerCount { given: 0, .. })));
}

#[cfg(feature = "gltf")]
mod gltf {
    use super::*;
    use serde_json::{Value, json};

    /// A triangle.
    fn file(edit: impl FnOnce(&mut Value)) -> Vec<u8> {
        let mut json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
            "accessors": [
                { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
                { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" },
            ],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 12 }],
            "buffers": [{ "byteLength": 48, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAABAAIA" }],
        });
        edit(&mut json);
        serde_json::to_vec(&json).unwrap()
    }

    #[test]
    fn counts_of_accessors_may_be_anything() {
        assert!(
            read_repaired(written("fine.gltf", file(|_| {})), &ReadOptions::default(), &RepairOptions::default())
                .is_ok()
        );
        for (accessor, count) in [(0, u64::MAX), (1, u64::MAX), (0, 1 << 60), (1, 4_000_000_000)] {
            let path = written("count.gltf", file(|json| json["accessors"][accessor]["count"] = count.into()));
            assert_error(
                &path,
                &ReadOptions::default(),
                &format!("accessor {accessor} reaches beyond its buffer view"),
            );
        }
        // Without data there may be any number of elements; those that faces name are read.
        let edit = |json: &mut Value| {
            json["accessors"][0] = json!({ "componentType": 5126, "count": u64::MAX, "type": "VEC3" });
        };
        let error = read(written("unbacked.gltf", file(edit)), &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.ends_with("the scene has no triangles: points and lines have no surface"), "{error}");
    }

    /// A mesh of many primitives at many nodes.
    fn many(nodes: usize, primitives: usize) -> Vec<u8> {
        file(|json| {
            json["scenes"][0]["nodes"] = (0..nodes).collect();
            json["nodes"] = vec![json!({ "mesh": 0 }); nodes].into();
            let primitive = json["meshes"][0]["primitives"][0].clone();
            json["meshes"][0]["primitives"] = vec![primitive; primitives].into();
        })
    }

    #[test]
    fn a_mesh_that_is_drawn_many_times_is_counted_before_it_is_built() {
        let corners = 20_000u64 * 20_000 * 7;
        let expected = format!(
            "the file has {corners} face corners or more: at most 200000000 are read; raise the limit \"corners\" if they are meant"
        );
        let path = written("many.gltf", many(20_000, 20_000));
        assert_error(&path, &ReadOptions::default(), &expected);
        // Raised limits let it through.
        let path = written("some.gltf", many(3, 5));
        let twice = RepairOptions::default();
        assert!(read_repaired(&path, &limited(&[("corners", 104)]), &twice).is_err());
        assert!(read_repaired(&path, &limited(&[("corners", 105)]), &twice).is_ok());
        assert!(read_repaired(&path, &limited(&[("faces", 1)]), &twice).is_err());
        assert!(read_repaired(&path, &limited(&[("vertices", 3)]), &twice).is_err());
    }

    #[test]
    fn animations_that_name_the_same_numbers_many_times_are_counted() {
        let channel = json!({ "sampler": 0, "target": { "node": 0, "path": "translation" } });
        let edit = |json: &mut Value| {
            json["accessors"].as_array_mut().unwrap().extend([
                json!({ "bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR" }),
                json!({ "bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3" }),
            ]);
            // 0 and 1.
            json["bufferViews"].as_array_mut().unwrap().push(json!({ "buffer": 0, "byteOffset": 8, "byteLength": 8 }));
            json["animations"] = json!([{ "samplers": [{ "input": 2, "output": 3 }], "channels": vec![channel; 100] }]);
        };
        let path = written("animated.gltf", file(edit));
        let repair = RepairOptions::default();
        let read = |limit| read_animated(&path, &limited(&[("corners", limit)]), Some(&repair));
        let animated = read(401);
        assert!(animated.is_ok_and(|animated| !animated.animations.is_empty()));
        let error = read(400).unwrap_err().to_string();
        assert!(error.contains("the file has 401 numbers that move it or more: at most 400 are read"), "{error}");
    }

    #[test]
    fn values_of_json_are_counted_and_nested_no_deeper_than_128() {
        let path = written("values.gltf", file(|json| json["nodes"] = vec![json!({}); 5_000_000].into()));
        let error = read(&path, &ReadOptions::default()).unwrap_err().to_string();
        assert!(
            error.contains("values in its JSON or more: at most 4000000 are read; raise the limit \"json-values\""),
            "{error}"
        );
        // Commas in strings count nothing.
        let named = written("strings.gltf", file(|json| json["asset"]["copyright"] = ",[\\\"{".repeat(100).into()));
        let repair = RepairOptions::default();
        assert!(read_repaired(&named, &limited(&[("json-values", 80)]), &repair).is_ok());
        let deep = [b"{\"nodes\":".as_slice(), &[b'['; 100_000]].concat();
        let error = read(written("deep.gltf", deep), &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("the file is not glTF 2.0: recursion limit exceeded"), "{error}");
    }

    #[test]
    fn nodes_that_go_round_are_one_error() {
        let path = written("round.gltf", file(|json| json["nodes"][0]["children"] = json!([0])));
        assert_error(&path, &ReadOptions::default(), "node 0 is reached twice: give a node one parent");
    }

    #[test]
    fn a_file_that_many_buffers_name_is_read_up_to_the_limit() {
        let path = written(
            "buffers.gltf",
            file(|json| json["buffers"] = vec![json!({ "byteLength": 1, "uri": "data.bin" }); 50].into()),
        );
        std::fs::write(path.with_file_name("data.bin"), vec![0; 100_000]).unwrap();
        let error = read(&path, &limited(&[("bytes", 1_000_000)])).unwrap_err().to_string();
        assert!(error.contains("the file has 1100000 bytes or more: at most 1000000 are read"), "{error}");
    }

    #[test]
    fn messages_stay_short_whatever_the_file_names() {
        let long = "x".repeat(1 << 20);
        let edits: [fn(&mut Value, String); 3] = [
            |json, long| json["extensionsRequired"] = json!([long]),
            |json, long| json["buffers"][0]["uri"] = json!(long),
            |json, long| json["scene"] = json!(long),
        ];
        for edit in edits {
            let path = written("long.gltf", file(|json| edit(json, long.clone())));
            let error = read(&path, &ReadOptions::default()).unwrap_err().to_string();
            assert!(error.len() < 1500, "{} bytes", error.len());
        }
        let edit = |json: &mut Value| {
            json["nodes"] = (0..1000).map(|node| json!({ "mesh": 0, "name": format!("n{node:04}") })).collect();
            json["scenes"][0]["nodes"] = (0..1000).collect();
        };
        let options = ReadOptions { mesh: Some("other".into()), ..ReadOptions::default() };
        let error = read(written("names.gltf", file(edit)), &options).unwrap_err().to_string();
        assert!(error.ends_with("\"n0048\", \"n0049\" and 950 others"), "{error}");
    }
}
