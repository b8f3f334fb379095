//! Files as people have them: what is odd about them is mended and said once, or refused with `--strict`.

use super::{fails, folder, json, run, subdiv};
use serde_json::Value;
use std::path::{Path, PathBuf};

const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// What `info` finds in a file, and the notes on standard error.
#[track_caller]
fn info(path: &Path) -> (Value, Vec<String>) {
    let info = subdiv().arg("info").arg(path).arg("--json").output().unwrap();
    assert!(info.status.success(), "{}: {}", path.display(), String::from_utf8_lossy(&info.stderr));
    let text = subdiv().arg("info").arg(path).output().unwrap();
    let stderr = String::from_utf8(text.stderr).unwrap();
    let notes = stderr.lines().map(|line| line.strip_prefix("note: ").unwrap().to_owned()).collect();
    (serde_json::from_slice(&info.stdout).unwrap(), notes)
}

fn written(test: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let path = folder(test).join("mesh.obj");
    std::fs::write(&path, text).unwrap();
    path
}

// Longer than a screen: a list of cases.
#[test]
fn what_is_odd_about_a_file_is_said_once_and_refused_when_strict() {
    let cases = [
        (
            format!("{CUBE}v 9 9 9\nv 8 8 nan\nl 1 9\np 10\n"),
            "isolated_vertices",
            "2 vertices belong to no face and are left out (the first: vertex 8, line 15)",
            "line 16: \"nan\" is not a finite number: write it like 1.5 or -2e3",
        ),
        (
            CUBE.replace("f 5 6 7 8", "f 5 5 6 7 8"),
            "repeated_corners",
            "1 repeated corner is left out (face 1, line 10)",
            "line 10: face 1 names vertex 4 twice: remove the repeated vertex, or split the face there",
        ),
        (
            format!("{CUBE}f 1 2\n"),
            "small_faces",
            "1 face of fewer than three corners is left out (face 6, line 15)",
            "line 15: face 6 has 2 vertices: a face needs at least three",
        ),
        (
            format!("{CUBE}f 6 7 8 5\n"),
            "doubled_faces",
            "1 face on another is left out (face 6, line 15)",
            "line 15: face 6 is the third face at the edge 5-6: an edge has one or two faces; separate the surfaces there",
        ),
        (
            CUBE.replace("f 2 3 7 6", "f 2 6 7 3"),
            "turned_faces",
            "1 face is turned over to go with its neighbours (face 3, line 12)",
            "line 12: faces 2 and 3 both run along the edge 1-5 in the same direction: turn one of them round so that all \
             faces are counter-clockwise from outside",
        ),
        (
            format!("{CUBE}v 2 0 0\nv 2 0 1\nf 2 9 10 6\n"),
            "crowded_edges",
            "1 edge of three or more faces is sharp (edge 1-5 of face 6, line 17)",
            "line 17: face 6 is the third face at the edge 1-5: an edge has one or two faces; separate the surfaces there",
        ),
        (
            format!("{CUBE}t crease 2/1/0 0 6 2\nt corner 1/1/0 8 2\n"),
            "tags_on_nothing",
            "2 tags on nothing are left out (the first: crease 0, line 15)",
            "line 16: corner 0 names vertex 8, but the mesh has 8 vertices",
        ),
        (
            CUBE.replace("f 1 4 3 2", "vn -nan(ind) 0 1\nf 1//1 4//1 3//1 2//1"),
            "normals",
            "4 corners have normals that are not there or no numbers: the surface has its own (the first: face 0, line 10)",
            "line 9: \"-nan(ind)\" is not a finite number: write it like 1.5 or -2e3",
        ),
        (
            CUBE.replace("f 1 4 3 2", "vn 0 0 1\nf 1//1 4//0 3//7 2//1"),
            "normals",
            "2 corners have normals that are not there or no numbers: the surface has its own (the first: face 0, line 10)",
            "line 10: \"0\" is not the index of a normal: indices count from 1, or back from -1",
        ),
        (
            CUBE.replace("f 1 4 3 2", "vt 0 0\nf 1/1 4/1 3 2/1"),
            "texture_coordinates",
            "1 corner has a texture coordinate that is not there or no number: it gets (0, 0) (face 0, line 10)",
            "line 10: some corners of the face have a texture coordinate and some have none: give it to all or none",
        ),
    ];
    for (number, (text, kind, note, error)) in cases.into_iter().enumerate() {
        let path = written(&format!("odd{number}"), &text);
        let (info, notes) = info(&path);
        assert_eq!(notes, [note], "{kind}");
        let repairs = info["repairs"].as_array().unwrap();
        assert_eq!((repairs.len(), &repairs[0]["kind"], &repairs[0]["note"]), (1, &kind.into(), &note.into()));
        assert!(repairs[0]["line"].is_u64());
        let faces = if kind == "crowded_edges" { 7 } else { 6 };
        assert_eq!((&info["faces"], &info["boundary_edges"]), (&faces.into(), &((faces - 6) * 4).into()), "{kind}");
        fails(&format!("info --strict {}", path.display()), 1, &format!("{}: {error}", path.display()));
    }
}

#[test]
fn files_without_fault_are_read_without_a_word() {
    let (info, notes) = info(&written("clean", CUBE));
    assert_eq!((notes.len(), info["repairs"].as_array().unwrap().len()), (0, 0));
}

#[test]
fn positions_that_are_needed_must_be_numbers() {
    let path = written("needed", CUBE.replace("v 1 1 1", "v 1 nan 1"));
    let shown = path.display();
    let error =
        format!("{shown}: line 7: vertex 6 is at (1, NaN, 1): positions must be finite numbers of at most 3.4e38");
    fails(&format!("info {shown}"), 1, &error);
}

#[test]
fn every_command_mends_and_says_so() {
    let path = written("commands", format!("{CUBE}v 9 9 9\n"));
    let shown = path.display();
    let note = "note: 1 vertex belongs to no face and is left out (vertex 8, line 15)\n";
    for command in ["patches --construction cpu", "sample --cpu --grid 2", "error --samples 2", "info"] {
        let output = run(&format!("{command} {shown}"));
        assert!(output.status.success(), "{command}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), note, "{command}");
    }
}

/// The faces of the cube, each with vertices of its own, moved by up to `off`.
fn loose_cube(off: f64) -> String {
    let positions: Vec<&str> = CUBE.lines().filter(|line| line.starts_with("v ")).collect();
    let (mut text, mut count) = (String::new(), 0);
    for face in CUBE.lines().filter_map(|line| line.strip_prefix("f ")) {
        for vertex in face.split(' ') {
            let xyz: Vec<f64> =
                positions[vertex.parse::<usize>().unwrap() - 1][2..].split(' ').map(|x| x.parse().unwrap()).collect();
            count += 1;
            let shift = off * f64::from(count % 3) / 2.0;
            text += &format!("v {} {} {}\n", xyz[0] + shift, xyz[1] - shift, xyz[2]);
        }
        text += &format!("f {} {} {} {}\n", count - 3, count - 2, count - 1, count);
    }
    text
}

#[test]
fn loose_faces_are_joined_on_request_and_said_otherwise() {
    let path = written("loose", loose_cube(0.0));
    let (loose, notes) = info(&path);
    assert_eq!((&loose["boundary_edges"], &loose["loose_edges"]), (&24.into(), &24.into()));
    assert_eq!(notes, ["24 edges on boundaries lie on others without being joined: --weld 1e-6 joins them"]);
    let welded = json(&format!("info {} --weld 0", path.display()));
    assert_eq!(
        (&welded["vertices"], &welded["boundary_edges"], &welded["loose_edges"]),
        (&8.into(), &0.into(), &0.into())
    );
    assert_eq!(welded["repairs"][0]["note"], "16 vertices are joined with others (the first: vertex 8, line 11)");
    // Nearly there: half of the tolerance (of the diagonal, 1.73) is enough, and more than it is not.
    let near = written("near", loose_cube(1e-4));
    assert_eq!(info(&near).1.len(), 0, "too far off for the note");
    for (tolerance, boundary) in [("3e-4", 0), ("2e-5", 24)] {
        let info = json(&format!("info {} --weld {tolerance}", near.display()));
        assert_eq!(info["boundary_edges"], boundary, "{tolerance}");
    }
    let message =
        "invalid value '2' for '--weld <TOLERANCE>': it must be a part of the diagonal, from 0 to 0.1, such as 1e-6";
    fails("info x.obj --weld 2", 2, message);
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn cases_of_loose_faces() {
    for (name, faces) in [("obj_unwelded/soup.obj", 6), ("gltf_seam_last_bit/sphere_seam.glb", 0)] {
        let path = case(name);
        let (loose, notes) = info(&path);
        assert!(loose["boundary_edges"].as_u64() > Some(0));
        assert!(notes.last().is_some_and(|note| note.ends_with("--weld 1e-6 joins them")), "{name}: {notes:?}");
        let welded = json(&format!("info {} --weld 1e-6", path.display()));
        assert_eq!(welded["boundary_edges"], 0, "{name}");
        assert!(faces == 0 || welded["faces"] == faces, "{name}");
    }
    for (name, faces, edges) in [
        ("gltf_touching_parts/cubes_touch_edge.glb", 12, 24),
        ("gltf_touching_parts/cubes_touch_face.glb", 12, 24),
        ("more/cubes_touch_edge.glb", 12, 24),
        ("more/decal_same_mesh.glb", 0, 0),
    ] {
        let (info, mut notes) = info(&case(name));
        notes.retain(|note| !note.contains("quads are put together"));
        assert_eq!(notes, [""; 0], "{name}");
        if faces > 0 {
            assert_eq!((&info["faces"], &info["edges"]), (&faces.into(), &edges.into()), "{name}");
            assert_eq!((&info["vertices"], &info["boundary_edges"]), (&16.into(), &0.into()), "{name}");
        }
    }
}

/// A file of the shared cases.
fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/cases").join(name)
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn the_cases_are_read() {
    // Faces, boundary edges, repairs.
    let cases: [(&str, u64, u64, &[&str]); 13] = [
        ("obj_nan_normals/nan_vn.obj", 6, 0, &["normals"]),
        ("obj_zero_normal_index/zero_vn.obj", 6, 0, &["normals"]),
        ("obj_zero_normal_index/missing_vn.obj", 6, 0, &["normals"]),
        ("obj_corner_without_uv/mixed_corners.obj", 6, 0, &["texture_coordinates"]),
        ("obj_repeated_corner/repeated.obj", 6, 0, &["repeated_corners"]),
        ("one_face_turned/oneflip.obj", 6, 0, &["turned_faces"]),
        ("obj_loose_lines/lines.obj", 6, 0, &["isolated_vertices"]),
        ("fin/fin.obj", 7, 4, &["crowded_edges"]),
        ("more/fin.obj", 7, 4, &["crowded_edges"]),
        ("more/isolated_crease_line.obj", 6, 0, &["tags_on_nothing"]),
        ("more/vnmissing.obj", 6, 0, &["normals"]),
        ("obj_cr_lines/cr.obj", 6, 0, &[]),
        ("obj_latin1/latin1.obj", 6, 0, &[]),
    ];
    for (name, faces, boundary, kinds) in cases {
        let (info, notes) = info(&case(name));
        let found: Vec<&Value> = info["repairs"].as_array().unwrap().iter().map(|repair| &repair["kind"]).collect();
        assert_eq!(found, kinds, "{name}");
        assert_eq!((&info["faces"], &info["boundary_edges"]), (&faces.into(), &boundary.into()), "{name}");
        assert_eq!(notes.len(), kinds.len(), "{name}: {notes:?}");
    }
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn every_shared_mesh_is_read() {
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/meshes")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "obj") {
            json(&format!("info {}", path.display()));
        }
    }
}

/// The pixels of a picture that the program draws.
fn pixels(arguments: &str, name: &str) -> image::RgbaImage {
    let path = folder(&format!("pixels-{name}")).join("a.png");
    let output = run(&format!("render {arguments} --size 96x96 -o {}", path.display()));
    assert!(output.status.success(), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
    image::open(path).unwrap().into_rgba8()
}

const SHEET: &str = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\n\
    vt 0 0\nvt 0.5 0\nvt 1 0\nvt 0 0.5\nvt 0.5 0.5\nvt 1 0.5\nvt 0 1\nvt 0.5 1\nvt 1 1\n\
    f 1/1 2/2 5/5 4/4\nf 2/2 3/3 6/6 5/5\nf 4/4 5/5 8/8 7/7\nf 5/5 6/6 9/9 8/8\n";

#[test]
fn in_obj_v_runs_up_the_image() {
    let folder = folder("upside");
    // White above, black below.
    let map = folder.join("map.png");
    image::GrayImage::from_fn(8, 8, |_, y| image::Luma([if y < 4 { 255 } else { 0 }])).save(&map).unwrap();
    let mesh = folder.join("sheet.obj");
    std::fs::write(&mesh, SHEET).unwrap();
    let smooth = folder.join("smooth.obj");
    let options = "--displacement-scale 0.1 --depth 4";
    json(&format!("tessellate {} --displacement {} {options} -o {}", mesh.display(), map.display(), smooth.display()));
    let text = std::fs::read_to_string(smooth).unwrap();
    let vertices = text.lines().filter_map(|line| line.strip_prefix("v "));
    let [mut above, mut below] = [0, 0];
    for vertex in vertices {
        let [_, y, z] =
            <[f64; 3]>::try_from(vertex.split(' ').map(|x| x.parse().unwrap()).collect::<Vec<_>>()).unwrap();
        if (1.3..1.7).contains(&y) {
            assert!(z > 0.2, "the upper half comes out: {vertex}");
            above += 1;
        } else if (0.3..0.7).contains(&y) {
            assert!(z.abs() < 1e-6, "the lower half stays: {vertex}");
            below += 1;
        }
    }
    assert!(above > 50 && below > 50);
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn cases_that_are_drawn_alike() {
    let at = |name: &str| case(name).display().to_string();
    let pairs = [
        (
            "displacement_upside_down/sheet_uv.obj",
            "displacement_upside_down/sheet_uv.glb",
            "displacement_upside_down/tophalf.png",
        ),
        ("exr_one_channel/sheet_uv.obj", "exr_one_channel/sheet_uv.obj", "exr_one_channel/e_y.exr"),
    ];
    for (number, (one, other, map)) in pairs.into_iter().enumerate() {
        let other_map = map.replace("e_y", "e_rgb");
        let draw = |mesh: &str, map: &str, name: &str| {
            let options = "--displacement-scale 0.1 --factor 16 --yaw 30";
            pixels(&format!("{} --displacement {} {options}", at(mesh), at(map)), &format!("{name}{number}"))
        };
        assert!(draw(one, map, "one") == draw(other, &other_map, "other"), "{one} {map}");
    }
    let house = |name: &str| pixels(&format!("{} --up 0,0,1", at(&format!("far_from_origin/{name}.obj"))), name);
    let (far, near) = (house("utm_house"), house("utm_house_local"));
    let worst = far.iter().zip(near.iter()).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
    assert!(worst <= 2, "{worst}");
}

/// The cube, `size` wide, from `low` on.
fn placed(test: &str, size: f64, low: f64) -> String {
    let place = |line: &str| match line.strip_prefix("v ") {
        Some(xyz) => {
            let xyz: Vec<String> =
                xyz.split(' ').map(|x| (low + size * x.parse::<f64>().unwrap()).to_string()).collect();
            format!("v {}\n", xyz.join(" "))
        }
        None => format!("{line}\n"),
    };
    written(test, CUBE.lines().map(place).collect::<String>()).display().to_string()
}

#[test]
fn size_and_place_do_not_matter() {
    let like = pixels(&placed("size0", 1.0, 0.0), "size0");
    for (number, (size, low)) in
        [(1e-10, 0.0), (1e-30, 0.0), (1e10, 0.0), (1e30, 0.0), (20.0, 2e7)].into_iter().enumerate()
    {
        let path = placed(&format!("size{}", number + 1), size, low);
        let picture = pixels(&path, &format!("size{}", number + 1));
        let worst = like.iter().zip(picture.iter()).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
        assert!(worst <= 2, "{size} from {low}: {worst}");
        // The eye stands where the file has it.
        let eye = |size: f64, low: f64| [3.0, 2.0, 5.0].map(|x: f64| (low + size * x).to_string()).join(",");
        let one = pixels(&format!("{} --eye {}", placed("size0", 1.0, 0.0), eye(1.0, 0.0)), "eye0");
        let other = pixels(&format!("{path} --eye {}", eye(size, low)), "eye");
        let worst = one.iter().zip(other.iter()).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
        assert!(worst <= 2, "{size} from {low} by hand: {worst}");
    }
}

#[test]
fn figures_are_in_the_units_of_the_file() {
    let (size, low) = (20.0, 2e7);
    let [one, other] = [placed("units0", 1.0, 0.0), placed("units1", size, low)];
    for command in ["sample --grid 3", "patches --construction two-stage", "patches --construction stencil"] {
        let [one, other] = [&one, &other].map(|path| json(&format!("{command} {path}")));
        let key = if command.starts_with("sample") { "faces" } else { "patches" };
        let points = if command.starts_with("sample") { "positions" } else { "points" };
        let all = |value: &Value| {
            let parts = value[key].as_array().unwrap().iter().map(|part| super::numbers(&part[points]));
            parts.collect::<Vec<_>>().concat()
        };
        let (one, other) = (all(&one), all(&other));
        assert!(!one.is_empty() && one.len() == other.len(), "{command}");
        let worst = one.iter().zip(&other).map(|(a, b)| (low + size * a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-5, "{command}: {worst}");
    }
}

#[test]
fn quads_of_gltf_are_put_together() {
    let path = folder("quads").join("cube.glb");
    json(&format!("tessellate --shape cube --depth 2 -o {}", path.display()));
    let (quads, notes) = info(&path);
    assert_eq!((&quads["face_sizes"], &quads["rebuilt_quads"]), (&serde_json::json!({ "4": 96 }), &96.into()));
    assert_eq!(notes, ["96 quads are put together out of triangles: --rebuild-quads off keeps the triangles"]);
    let triangles = json(&format!("info {} --rebuild-quads off", path.display()));
    assert_eq!(triangles["face_sizes"], serde_json::json!({ "3": 192 }));
}

#[test]
fn meshes_are_converted() {
    let folder = folder("convert");
    let at = |name: &str| folder.join(name).display().to_string();
    let obj = at("fin.obj");
    std::fs::write(&obj, format!("{CUBE}v 9 9 9\nt crease 2/1/0 0 1 2.5\n")).unwrap();
    let output = run(&format!("convert {obj} {}", at("a.glb")));
    assert_eq!(
        String::from_utf8_lossy(&output.stderr),
        "note: 1 vertex belongs to no face and is left out (vertex 8, line 15)\n\
         note: creases are left out: they have no place in the file\n"
    );
    assert!(String::from_utf8_lossy(&output.stdout).ends_with("a.glb: 8 vertices, 6 faces\n"));
    json(&format!("convert {} {}", at("a.glb"), at("b.ply")));
    json(&format!("convert {} {}", at("b.ply"), at("c.obj")));
    json(&format!("convert {obj} {}", at("d.obj")));
    for (name, creases) in [("a.glb", 0), ("b.ply", 0), ("c.obj", 0), ("d.obj", 1)] {
        let info = json(&format!("info {}", at(name)));
        assert_eq!((&info["face_sizes"], &info["edges"]), (&serde_json::json!({ "4": 6 }), &12.into()), "{name}");
        assert_eq!((&info["creased_edges"], &info["vertices"]), (&creases.into(), &8.into()), "{name}");
    }
    let wrong = at("x.stl");
    fails(
        &format!("convert {obj} {wrong}"),
        2,
        &format!("{wrong}: control meshes are written to files ending in .obj, .glb or .ply"),
    );
}

#[test]
fn limits_are_lowered_and_raised() {
    let path = written("limits", CUBE);
    let path = path.display();
    let error = format!(
        "{path}: the file has 6 faces or more: at most 5 are read; raise the limit \"faces\" if they are meant"
    );
    fails(&format!("info {path} --limit vertices=8 --limit faces=5"), 1, &error);
    assert_eq!(json(&format!("info {path} --limit faces=5 --limit faces=6"))["faces"], 6);
    for wrong in ["face=5", "faces", "faces=5.5"] {
        let output = subdiv().args(["info", &path.to_string(), "--limit", wrong]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{wrong}");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(
            stderr.contains("write NAME=COUNT, with one of bytes, vertices") || stderr.contains("is no count"),
            "{stderr}"
        );
    }
}

#[test]
fn meshes_without_extent_are_said_to_have_none() {
    let at_one_place = |line: &str| if line.starts_with('v') { "v 1 2 3\n".into() } else { format!("{line}\n") };
    let (_, notes) = info(&written("point", CUBE.lines().map(at_one_place).collect::<String>()));
    let expected = "all vertices are at one place, so there is nothing to see: look for a scale of 0 in the file, or among its nodes";
    assert_eq!(notes, [expected]);
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn a_scale_of_zero_is_noted() {
    let (_, notes) = info(&case("more/zero_scale.glb"));
    assert!(notes.iter().any(|note| note.starts_with("all vertices are at one place")), "{notes:?}");
}
