//! `subdiv tessellate`.

use super::{fails, folder, json, keys, run, subdiv};
use std::fs;
use std::path::Path;

/// Files in a folder, hidden ones too.
fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn surfaces_are_written_closed() {
    let folder = folder("surfaces_are_written_closed");
    let path = |name: &str| folder.join(name).display().to_string();
    let out = json(&format!("tessellate --shape creature --tolerance 0.02 --quads -o {}", path("a.obj")));
    let expected = [
        "bytes",
        "depth_histogram",
        "faces",
        "file",
        "frames",
        "largest_error",
        "mesh",
        "quads",
        "seconds",
        "time",
        "triangles",
        "vertices",
    ];
    assert_eq!(keys(&out), expected);
    assert!(out["largest_error"].as_f64().unwrap() <= 0.02 && out["triangles"].as_u64().unwrap() > 0, "{out}");
    assert_eq!(out["bytes"], fs::metadata(folder.join("a.obj")).unwrap().len());
    // One surface without a boundary, as the program itself reads it.
    let read = json(&format!("info {}", path("a.obj")));
    assert_eq!((&read["boundary_edges"], &read["faces"]), (&0.into(), &out["faces"]));
    let characteristic = |info: &serde_json::Value| {
        let [v, e, f] = ["vertices", "edges", "faces"].map(|key| info[key].as_i64().unwrap());
        v - e + f
    };
    assert_eq!(characteristic(&read), characteristic(&json("info --shape creature")));

    let out = json(&format!("tessellate --shape creature --depth 1 -o {}", path("new/a.glb")));
    assert_eq!((&out["faces"], &out["quads"]), (&(1320 * 8).into(), &0.into()));
    let read = json(&format!("info --rebuild-quads off {}", path("new/a.glb")));
    assert_eq!((&read["boundary_edges"], &read["faces"]), (&0.into(), &out["faces"]));

    let out = json(&format!("tessellate --shape torus --depth 2 -o {}", path("a.ply")));
    let ply = fs::read(folder.join("a.ply")).unwrap();
    let header = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", out["vertices"]);
    assert!(ply.starts_with(header.as_bytes()), "{}", String::from_utf8_lossy(&ply[..200]));
    assert_eq!(files(&folder), ["a.obj", "a.ply", "new"]);
}

#[test]
fn cameras_and_height_maps_take_part() {
    let folder = folder("cameras_and_height_maps_take_part");
    let path = folder.join("a.ply").display().to_string();
    let faces =
        |options: &str| json(&format!("tessellate --shape creature {options} -o {path}"))["faces"].as_u64().unwrap();
    let far = faces("--pixels 8 --size 300x300");
    assert!(far < faces("--pixels 4 --size 300x300"));
    assert!(far < faces("--pixels 8 --size 600x600"));
    // What the camera does not see stays coarse.
    assert!(faces("--pixels 8 --size 600x600 --zoom 8") < faces("--pixels 1 --size 600x600"));
    assert!(faces("--edge-length 0.2") < faces("--edge-length 0.1"));

    let flat = json(&format!("tessellate --shape creature --depth 2 -o {path}"));
    let before = fs::read(&path).unwrap();
    let scaly = json(&format!("tessellate --shape creature --depth 2 --displacement scales -o {path}"));
    assert_eq!((&flat["faces"], &flat["bytes"]), (&scaly["faces"], &scaly["bytes"]));
    assert!(scaly["largest_error"].is_null() && before != fs::read(&path).unwrap());
}

#[test]
fn edits_of_a_file_are_made() {
    let folder = folder("edits_of_a_file_are_made");
    let path = |name: &str| folder.join(name).display().to_string();
    let cube = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let edits = "t faceedit 4/0/1 3 1 2 0 hole\nt vertexedit 4/3/3 3 1 0 0 0 0 1 add P value\n";
    fs::write(folder.join("edited.obj"), format!("{cube}{edits}")).unwrap();
    for (name, options) in [("a.obj", "--quads"), ("a.ply", "--quads"), ("a.glb", "")] {
        let out = json(&format!("tessellate {} --depth 3 {options} -o {}", path("edited.obj"), path(name)));
        let faces = if options.is_empty() { 2 } else { 1 } * (6 * 64 - 4);
        // Without the vertex in the middle of the hole.
        assert_eq!((&out["faces"], &out["vertices"]), (&faces.into(), &(6 * 64 + 2 - 1).into()), "{name}");
    }
    let read = json(&format!("info {}", path("a.obj")));
    assert_eq!((&read["boundary_edges"], &read["vertices"]), (&8.into(), &385.into()));
    assert!(read["bounds"][1][2].as_f64().unwrap() > 0.9, "{read}");
    // Commands that draw patches refine the mesh.
    let read = json(&format!("info {}", path("edited.obj")));
    assert_eq!((&read["edits"], &read["faces"]), (&2.into(), &6.into()));
    let patches: u64 = read["patches"].as_object().unwrap().values().map(|count| count.as_u64().unwrap()).sum();
    assert_eq!(patches, 6 * 16 - 1);
    let notice =
        "2 edits are at levels down to 2: the whole mesh is refined to this level, into 16 faces for each quad";
    assert_eq!(read["notices"], serde_json::json!([notice]));
    let read = json(&format!("info {} --refine 2", path("edited.obj")));
    assert_eq!(read["notices"], serde_json::json!([]));
}

#[test]
fn rules_are_those_of_the_package_that_is_named() {
    let folder = folder("rules_are_those_of_the_package_that_is_named");
    let path = |name: &str| folder.join(name).display().to_string();
    // A sheet of 3 x 3 quads, with texture coordinates.
    let at = |i: usize| (i % 4, i / 4);
    let vertices: String = (0..16).map(at).map(|(i, j)| format!("v {i} {j} 0\nvt {i} {}\n", j * j)).collect();
    let corner = |i: usize, j: usize| format!("{0}/{0}", 4 * j + i + 1);
    let face = |(i, j)| [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)].join(" ");
    let faces: String = (0..9).map(|k| format!("f {}\n", face((k % 3, k / 3)))).collect();
    fs::write(folder.join("plain.obj"), format!("{vertices}{faces}")).unwrap();
    let tags = "t interpolateboundary 1/0/0 2\nt facevaryinginterpolateboundary 1/0/0 4\n";
    fs::write(folder.join("tagged.obj"), format!("{vertices}{faces}{tags}")).unwrap();
    // Whether the corner is kept, the texture coordinates of the first edge and of the inside, and notes.
    let made = |mesh: &str, options: &str| {
        let output = run(&format!("tessellate {} {options} --depth 1 --quads -o {}", path(mesh), path("out.obj")));
        let text = fs::read_to_string(folder.join("out.obj")).unwrap();
        let has = |line: &str| text.lines().any(|other| other == line);
        let count = text.lines().filter(|line| line.starts_with("f ")).count();
        assert!(output.status.success());
        // The middle of an edge of the boundary, where a curve is not straight; the first inner vertex.
        let linear = [has("vt 0 2.5"), has("vt 1 1")];
        (count, has("v 0 0 0"), linear, String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let none = String::new;
    for (options, count, keeps_corner, linear) in [
        ("", 36, true, [true, true]),
        ("--rules blender", 36, false, [true, false]),
        ("--rules maya", 36, true, [true, false]),
        ("--rules houdini", 36, true, [true, false]),
        ("--rules renderman", 36, true, [false, false]),
        ("--rules arnold", 36, true, [false, false]),
        ("--rules opensubdiv", 4, false, [false, true]),
        ("--rules opensubdiv --boundary edge-only", 36, false, [true, true]),
        ("--rules blender --uv all", 36, false, [true, true]),
        ("--uv none", 36, true, [false, false]),
    ] {
        assert_eq!(made("plain.obj", options), (count, keeps_corner, linear, none()), "{options}");
    }
    // What a file has chosen is left alone unless it is asked for; then the option counts, and a note says so.
    assert_eq!(made("tagged.obj", ""), (36, false, [true, false], none()));
    assert_eq!(made("tagged.obj", "--rules blender"), (36, false, [true, false], none()));
    let note = "note: boundary rule edge-and-corner takes the place of the file's edge-only\n";
    assert_eq!(made("tagged.obj", "--rules maya"), (36, true, [true, false], note.into()));
    let note = "note: texture coordinate rule all takes the place of the file's boundaries\n";
    assert_eq!(made("tagged.obj", "--uv all"), (36, false, [true, true], note.into()));
}

#[test]
fn what_cannot_be_tessellated_is_told() {
    let folder = folder("what_cannot_be_tessellated_is_told");
    let path = |name: &str| folder.join(name).display().to_string();
    let (glb, txt) = (path("a.glb"), path("a.txt"));
    let of = |options: &str| format!("tessellate --shape cube {options}");
    fails(&of(&format!("-o {txt}")), 2, &format!("--output {txt}: name a file that ends in .obj, .ply or .glb"));
    fails(&of(&format!("--quads -o {glb}")), 2, &format!("--quads: {glb} has triangles only: choose .obj or .ply"));
    let message = "depth 0: a mesh is subdivided once at least, and 10 times at most: choose 1 to 10";
    fails(&of(&format!("--depth 0 -o {glb}")), 1, message);
    let message =
        "the tessellation has 6291458 vertices and 251658288 bytes, more than --max-vertices 1000: ask for less depth";
    fails(&of(&format!("--depth 10 --max-vertices 1e3 -o {glb}")), 1, message);
    let message = "--refine: refinement does not change the limit surface: choose a --depth";
    fails(&of(&format!("--refine 1 -o {glb}")), 2, message);
    let message = "--adaptive: all of the surface is exact: leave it out";
    fails(&of(&format!("--adaptive 1 -o {glb}")), 2, message);
    let message = "--displacement-vectors: only heights are baked in: leave it out";
    fails(&of(&format!("--displacement scales --displacement-vectors -o {glb}")), 2, message);
    assert!(files(&folder).is_empty());
    let output = run(&of(&format!("--tolerance 1e-4 --max-depth 2 -o {glb}")));
    let note = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.success() && note.starts_with("note: --tolerance 0.0001: at --max-depth 2 the error may be "),
        "{note}"
    );
}

/// A disk that is full, and a user who has had enough, leave what was there before, and nothing else.
#[cfg(target_os = "linux")]
#[test]
fn nothing_half_written_is_left() {
    use std::os::unix::process::ExitStatusExt;
    let folder = folder("nothing_half_written_is_left");
    let path = folder.join("a.obj");
    fs::write(&path, "from before").unwrap();
    let command = format!("ulimit -f 64; exec \"$0\" tessellate --shape creature --depth 3 -o {}", path.display());
    let output =
        std::process::Command::new("bash").args(["-c", &command, env!("CARGO_BIN_EXE_subdiv")]).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(error, format!("error: {}: File too large (os error 27)\n", path.display()));
    assert_eq!(files(&folder), ["a.obj"]);

    let mut child = subdiv()
        .args(["tessellate", "--shape", "creature", "--depth", "6", "-o"])
        .arg(&path)
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    // Until it writes.
    while files(&folder).len() < 2 {
        assert!(child.try_wait().unwrap().is_none(), "it was too quick");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let status = child.wait().unwrap();
    assert!(kill.success() && !status.success(), "{status} {:?}", status.signal());
    assert_eq!(files(&folder), ["a.obj"]);
    assert_eq!(fs::read_to_string(&path).unwrap(), "from before");
}

/// Positions and faces of an OBJ file, read here: only what this program writes, but nothing of how.
fn plain_obj(path: &Path) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for line in std::fs::read_to_string(path).unwrap().lines() {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
                positions.push([numbers[0], numbers[1], numbers[2]]);
            }
            Some("f") => {
                let index = |word: &str| word.split('/').next().unwrap().parse::<usize>().unwrap() - 1;
                faces.push(words.map(index).collect());
            }
            _ => {}
        }
    }
    (positions, faces)
}

/// The first vertex that lies inside an edge of other vertices, to a part of the edge's length.
fn inside_an_edge(positions: &[[f64; 3]], edges: &[[usize; 2]]) -> Option<(usize, [usize; 2])> {
    let longest = |[a, b]: [usize; 2]| (0..3).map(|k| (positions[a][k] - positions[b][k]).abs()).fold(0.0, f64::max);
    let size = edges.iter().map(|&edge| longest(edge)).fold(0.0, f64::max);
    let cell = |p: [f64; 3]| p.map(|x| (x / size).floor() as i64);
    let mut cells: std::collections::HashMap<[i64; 3], Vec<usize>> = std::collections::HashMap::new();
    (0..positions.len()).for_each(|vertex| cells.entry(cell(positions[vertex])).or_default().push(vertex));
    let lies_in = |vertex: usize, [a, b]: [usize; 2]| {
        let [p, a, b] = [vertex, a, b].map(|v| glam::DVec3::from(positions[v]));
        let t = (p - a).dot(b - a) / (b - a).length_squared();
        (1e-4..1.0 - 1e-4).contains(&t) && (p - a - t * (b - a)).length() < 1e-6 * (b - a).length()
    };
    edges.iter().find_map(|&edge| {
        let middle = [0, 1, 2].map(|k| (positions[edge[0]][k] + positions[edge[1]][k]) / 2.0);
        let [x, y, z] = cell(middle);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let near = around.filter_map(|cell| cells.get(&cell)).flatten();
        let inside = near.copied().find(|&vertex| !edge.contains(&vertex) && lies_in(vertex, edge));
        inside.map(|vertex| (vertex, edge))
    })
}

#[test]
fn no_vertex_of_a_file_is_inside_an_edge_of_others() {
    let folder = folder("t-junctions");
    // A cube that stays flat: there a vertex inside an edge would lie on it.
    let faces = [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
    let mut text: String = (0..8).map(|i| format!("v {} {} {}\n", i & 1, i >> 1 & 1, i >> 2)).collect();
    for face @ [a, b, c, d] in faces {
        text += &format!("f {a} {b} {c} {d}\n");
        (0..4).for_each(|k| text += &format!("t crease 2/1/0 {} {} 10\n", face[k] - 1, face[(k + 1) % 4] - 1));
    }
    let flat = folder.join("flat.obj");
    std::fs::write(&flat, text).unwrap();
    let flat = flat.display().to_string();
    let view = "--pixels 6 --size 200x200 --eye 1.5,1.6,1.7 --target 0,0,0 --fov 60";
    for (source, depth, closed) in [
        (flat.as_str(), view, true),
        ("--shape creature", "--tolerance 0.004", true),
        ("--shape machine-part", "--edge-length 0.12", true),
        ("--shape cloth", view, false),
    ] {
        for quads in ["", "--quads"] {
            let path = folder.join("out.obj");
            let told = json(&format!("tessellate {source} {depth} {quads} -o {}", path.display()));
            let depths = told["depth_histogram"].as_array().unwrap().iter().filter(|count| **count != 0).count();
            assert!(depths > 1, "{source}: depths differ");
            let (positions, faces) = plain_obj(&path);
            let mut sides = std::collections::HashMap::new();
            for face in &faces {
                for (k, &from) in face.iter().enumerate() {
                    let to = face[(k + 1) % face.len()];
                    assert!(sides.insert([from, to], ()).is_none(), "{source}: two faces run from {from} to {to}");
                }
            }
            let open = sides.keys().filter(|[a, b]| !sides.contains_key(&[*b, *a])).count();
            assert!(if closed { open == 0 } else { open > 0 }, "{source}: {open} open edges");
            let edges: Vec<[usize; 2]> = sides.into_keys().filter(|[a, b]| a < b || open > 0).collect();
            assert_eq!(inside_an_edge(&positions, &edges), None, "{source} {depth} {quads}");
        }
    }
    // It would be seen.
    let positions = [[0., 0., 0.], [1., 0., 0.], [0.5, 0., 0.], [0.5, 1., 0.]];
    assert_eq!(inside_an_edge(&positions, &[[0, 3], [0, 1]]), Some((2, [0, 1])));
}
