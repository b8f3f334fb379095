//! Reading files by path: the shared meshes, a large mesh, and paths that are wrong.

use ash_subdiv::mesh::{ReadOptions, read};
use std::path::{Path, PathBuf};

/// A folder of its own for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn shared_meshes_have_the_vertices_and_faces_their_text_has() {
    let mut read_count = 0;
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/meshes")).unwrap() {
        let path = entry.unwrap().path();
        // Three faces meet at edges of the fan: the test below, and those of `repair`.
        if path.extension().is_none_or(|ending| ending != "obj") || path.ends_with("catmark_fan.obj") {
            continue;
        }
        // This shape alone has a vertex without faces.
        let isolated = usize::from(path.ends_with("catmark_nonman_verts.obj"));
        let options = ReadOptions { drop_isolated: isolated > 0, ..ReadOptions::default() };
        let mesh = read(&path, &options).unwrap_or_else(|error| panic!("{error}"));
        let text = std::fs::read_to_string(&path).unwrap();
        let starting = |with: &str| text.lines().filter(|line| line.starts_with(with)).collect::<Vec<_>>();
        let corners: usize = starting("f ").iter().map(|face| face.split_whitespace().count() - 1).sum();
        let counts = [mesh.vertex_count(), mesh.face_count(), mesh.corner_count(), mesh.data().creases.len()];
        let expected = [starting("v ").len() - isolated, starting("f ").len(), corners, starting("t crease ").len()];
        assert_eq!(counts, expected, "{}", path.display());
        assert_eq!(mesh.data().texcoords.is_some(), text.contains("/") && text.contains("vt "), "{}", path.display());
        read_count += 1;
    }
    assert!(read_count >= 30, "only {read_count} files");
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn the_shared_meshes_that_are_errors_by_default() {
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/meshes");
    let isolated = "line 150: vertex 48 belongs to no face: \
                    remove it, or read the file with isolated vertices dropped";
    assert_error(&meshes.join("catmark_nonman_verts.obj"), &ReadOptions::default(), isolated);
    let third = "line 65: face 9 is the third face at the edge 7-8: \
                 an edge has one or two faces; separate the surfaces there";
    assert_error(&meshes.join("catmark_fan.obj"), &ReadOptions::default(), third);
}

#[track_caller]
fn assert_error(path: &Path, options: &ReadOptions, expected: &str) {
    let error = read(path, options).unwrap_err();
    assert_eq!(error.to_string(), format!("{}: {expected}", path.display()));
}

#[test]
fn paths_that_are_wrong() {
    let folder = folder("paths");
    let default = ReadOptions::default();
    assert_error(&folder.join("none.obj"), &default, "there is no such file");
    assert_error(&folder.join("none.GLB"), &default, "there is no such file");
    assert_error(&folder.join("a.stl"), &default, "files ending in .stl can't be read: use .obj, .ply, .gltf or .glb");
    assert_error(&folder.join("a"), &default, "the name has no ending: it must be .obj, .ply, .gltf or .glb");
    std::fs::create_dir_all(folder.join("folder.obj")).unwrap();
    assert_error(&folder.join("folder.obj"), &default, "this is a directory: name a file in it");
}

#[test]
fn contents_that_are_wrong() {
    let path = folder("contents").join("bad.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0\n").unwrap();
    assert_error(&path, &ReadOptions::default(), "line 2: \"v\" needs 3 numbers, but has 2");
    let options = ReadOptions { mesh: Some("a".into()), ..ReadOptions::default() };
    let expected = "\"a\" can't be chosen: an OBJ file is read as one mesh; leave the name out";
    assert_error(&path, &options, expected);
}

#[test]
fn isolated_vertices_are_dropped_on_request() {
    let path = folder("isolated").join("quad.OBJ");
    std::fs::write(&path, "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 2 3 4 5\n").unwrap();
    let expected = "line 1: vertex 0 belongs to no face: remove it, or read the file with isolated vertices dropped";
    assert_error(&path, &ReadOptions::default(), expected);
    let options = ReadOptions { drop_isolated: true, ..ReadOptions::default() };
    assert_eq!(read(&path, &options).unwrap().vertex_count(), 4);
}

#[cfg(feature = "gltf")]
const GLTF: &str = r#"{
    "asset": { "version": "2.0" },
    "buffers": [{ "byteLength": 36, "uri": "corners.bin" }],
    "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
    "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
    "meshes": [{ "name": "Three", "primitives": [{ "attributes": { "POSITION": 0 } }] }]
}"#;

#[cfg(feature = "gltf")]
#[test]
fn gltf_with_a_file_next_to_it() {
    let folder = folder("gltf");
    let path = folder.join("three.gltf");
    std::fs::write(&path, GLTF).unwrap();
    let corners = [[0f32, 0., 0.], [1., 0., 0.], [0., 1., 0.]];
    std::fs::write(
        folder.join("corners.bin"),
        corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>(),
    )
    .unwrap();
    assert_eq!(read(&path, &ReadOptions::default()).unwrap().face_count(), 1);
    let named = |name: &str| ReadOptions { mesh: Some(name.into()), ..ReadOptions::default() };
    assert_eq!(read(&path, &named("Three")).unwrap().face_count(), 1);
    let expected = "there is no mesh or node named \"Four\" in the scene: choose one of \"Three\"";
    assert_error(&path, &named("Four"), expected);
    std::fs::write(folder.join("alone.gltf"), GLTF.replace("corners", "none")).unwrap();
    let expected = "buffer 0: there is no file \"none.bin\" next to this one";
    assert_error(&folder.join("alone.gltf"), &ReadOptions::default(), expected);
}

#[cfg(not(feature = "gltf"))]
#[test]
fn gltf_without_the_feature() {
    let path = folder("no-gltf").join("a.glb");
    std::fs::write(&path, "").unwrap();
    assert_error(&path, &ReadOptions::default(), "this build can't read glTF: turn on the cargo feature \"gltf\"");
}

/// Prints how long it took (with `--nocapture`) for a grid of a million faces, 87 MB.
#[test]
#[ignore = "slow in debug builds; a measurement: run it with --release"]
fn a_million_faces() {
    use std::fmt::Write as _;
    let n = 1000;
    let mut text = String::new();
    for i in 0..=n {
        for j in 0..=n {
            writeln!(
                text,
                "v {} {} {}\nvt {} {}",
                f64::from(i) / 7.,
                f64::from(j) / 7.,
                f64::from(i * j) / 1e5,
                f64::from(i) / 1e3,
                f64::from(j) / 1e3
            )
            .unwrap();
        }
    }
    for i in 0..n {
        for j in 0..n {
            let a = i * (n + 1) + j + 1;
            let [b, c, d] = [a + n + 1, a + n + 2, a + 1];
            writeln!(text, "f {a}/{a} {b}/{b} {c}/{c} {d}/{d}").unwrap();
        }
    }
    let start = std::time::Instant::now();
    let mesh = ash_subdiv::ControlMesh::from_obj_str(&text, &ash_subdiv::mesh::ObjOptions::default()).unwrap();
    println!("{} MB, {} faces: {:?}", text.len() / 1_000_000, mesh.face_count(), start.elapsed());
    assert_eq!(mesh.face_count(), 1_000_000);
}
