//! The program `subdiv`, run as a user runs it.
#![cfg(feature = "cli")]

use serde_json::Value;
use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn subdiv() -> Command {
    Command::new(env!("CARGO_BIN_EXE_subdiv"))
}

/// Runs the program with these arguments, one a word.
fn run(arguments: &str) -> Output {
    subdiv().args(arguments.split_whitespace()).output().unwrap()
}

/// What the program writes as JSON when all is well.
#[track_caller]
fn json(arguments: &str) -> Value {
    let output = run(&format!("{arguments} --json"));
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments}: {stderr}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The program ends with this exit code and one line on standard error, and says nothing else.
#[track_caller]
fn fails(arguments: &str, code: i32, message: &str) {
    let output = run(arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(stderr, format!("error: {message}\n"), "{arguments}");
    assert_eq!(output.status.code(), Some(code), "{arguments}");
    assert!(output.stdout.is_empty(), "{arguments}");
}

/// An empty folder for a test.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli").join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn keys(value: &Value) -> Vec<&str> {
    let mut keys: Vec<&str> = value.as_object().unwrap().keys().map(String::as_str).collect();
    keys.sort_unstable();
    keys
}

fn length(value: &Value) -> usize {
    value.as_array().unwrap().len()
}

/// All numbers of nested arrays, in order.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(all) => all.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().unwrap()],
    }
}

#[track_caller]
fn assert_close(a: &Value, b: &Value, tolerance: f64) {
    let (a, b) = (numbers(a), numbers(b));
    assert_eq!(a.len(), b.len());
    let worst = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < tolerance, "{worst}");
}

#[test]
fn help_and_version_succeed() {
    for arguments in ["--help", "render --help", "info -h", "--version"] {
        let output = run(arguments);
        assert!(output.status.success() && output.stderr.is_empty() && !output.stdout.is_empty(), "{arguments}");
    }
    assert!(String::from_utf8_lossy(&run("render --help").stdout).contains("Examples:"));
}

#[test]
fn info_counts() {
    let info = json("info --shape cube");
    assert_eq!((&info["vertices"], &info["edges"], &info["faces"]), (&8.into(), &12.into(), &6.into()));
    assert_eq!(info["patches"], serde_json::json!({ "regular": 0, "irregular_quad": 6, "triangle": 0 }));
    assert_eq!(info["valence"], serde_json::json!({ "3": 8 }));
    assert_eq!((&info["boundary_edges"], &info["creased_edges"]), (&0.into(), &0.into()));
    assert_eq!(info["connectivity_types"], 1);
    let bytes = info["bytes"].as_object().unwrap();
    let total: u64 = bytes.iter().filter(|(name, _)| *name != "total").map(|(_, n)| n.as_u64().unwrap()).sum();
    assert_eq!(bytes["total"], total);
    assert_eq!(bytes["positions"], 8 * 12);

    let info = json("info --shape cube --refine 1 --construction stencil");
    assert_eq!(info["patches"]["irregular_quad"], 24);
    assert_eq!((&info["faces"], &info["construction"]), (&6.into(), &"stencil".into()));
    assert!(info["bytes"]["stencil_types"].is_u64());

    let info = json("info --shape polygons");
    assert!(info["ngons"].as_u64().unwrap() > 0 && length(&info["notices"]) == 1, "{info}");

    let info = json("info --shape strip");
    assert_eq!(info["boundary_edges"], 18);
    assert_eq!(info["valence"], serde_json::json!({ "2": 4, "3": 14 }));
}

#[test]
fn text_is_for_people() {
    let output = run("info --shape creature");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("\nfaces ") && text.contains("bytes, two-stage"), "{text}");
    assert!(output.stderr.is_empty());
    let shapes = String::from_utf8(run("shapes").stdout).unwrap();
    assert!(shapes.contains("machine-part") && shapes.lines().all(|line| line.trim_end() == line), "{shapes}");
    assert!(String::from_utf8(run("devices").stdout).unwrap().contains("largest factor"));
    let patches = String::from_utf8(run("patches --shape tetrahedron --construction cpu").stdout).unwrap();
    assert!(patches.starts_with("face 0: triangle\n  p0 ") && patches.lines().count() == 4 * 16, "{patches}");
    let samples = String::from_utf8(run("sample --shape tetrahedron --cpu --grid 3").stdout).unwrap();
    assert!(samples.contains("\nface 1: triangle\n  1.0000 0.0000 "), "{samples}");
}

#[test]
fn notices_go_to_standard_error() {
    let output = run("patches --shape polygons --construction cpu --json");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.starts_with("note: ") && stderr.contains("the whole mesh is refined once"), "{stderr}");
    assert!(serde_json::from_slice::<Value>(&output.stdout).is_ok());
}

#[test]
fn patches_are_the_same_from_all_makers() {
    for (shape, refine) in [("valences", 0), ("creature-mixed", 0), ("polygons", 0), ("fan", 1)] {
        let of = |maker| json(&format!("patches --shape {shape} --refine {refine} --construction {maker}"));
        let (cpu, two_stage, stencil) = (of("cpu"), of("two-stage"), of("stencil"));
        assert_eq!(keys(&cpu), ["construction", "patches"]);
        let patches = cpu["patches"].as_array().unwrap();
        let places: Vec<_> =
            patches.iter().map(|p| (p["face"].as_u64().unwrap(), p["sub"].as_i64().unwrap())).collect();
        assert!(places.is_sorted() && !places.is_empty());
        for (i, patch) in patches.iter().enumerate() {
            assert_eq!(keys(patch), ["face", "kind", "points", "sub"]);
            let count = match patch["kind"].as_str().unwrap() {
                "regular" => 16,
                "irregular_quad" => 20,
                "triangle" => 15,
                other => panic!("{other}"),
            };
            assert_eq!(length(&patch["points"]), count);
            for other in [&two_stage, &stencil] {
                let other = &other["patches"][i];
                for key in ["face", "sub", "kind"] {
                    assert_eq!(patch[key], other[key]);
                }
                assert_close(&patch["points"], &other["points"], 1e-5);
            }
        }
        // Whole faces have no part; parts of polygons count from 0.
        let refined = shape == "polygons" || refine > 0;
        assert_eq!(places[0].1, if refined { 0 } else { -1 });
    }
}

#[test]
fn samples_are_the_same_on_both_sides() {
    for shape in ["creature-mixed", "cloth"] {
        let cpu = json(&format!("sample --shape {shape} --grid 4 --cpu"));
        let gpu = json(&format!("sample --shape {shape} --grid 4 --construction stencil"));
        assert_eq!(keys(&cpu), ["construction", "faces", "grid"]);
        assert_eq!(
            (&cpu["grid"], &cpu["construction"], &gpu["construction"]),
            (&4.into(), &"cpu".into(), &"stencil".into())
        );
        assert_eq!(length(&cpu["faces"]), length(&gpu["faces"]));
        for (a, b) in cpu["faces"].as_array().unwrap().iter().zip(gpu["faces"].as_array().unwrap()) {
            assert_eq!(keys(a), ["face", "normals", "positions", "sub"]);
            assert_eq!((&a["face"], &a["sub"]), (&b["face"], &b["sub"]));
            assert!([10, 16].contains(&length(&a["positions"])));
            assert_close(&a["positions"], &b["positions"], 1e-5);
            assert_close(&a["normals"], &b["normals"], 2e-3);
        }
    }
}

#[test]
fn corners_of_the_lattice_are_corners_of_the_face() {
    // A flat unit square with sharp corners is its own limit.
    let square = folder("square").join("square.obj");
    fs::write(&square, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").unwrap();
    let samples = json(&format!("sample {} --grid 3 --cpu", square.display()));
    let positions = &samples["faces"][0]["positions"];
    for (index, corner) in [(0, [0.0, 0.0, 0.0]), (2, [1.0, 0.0, 0.0]), (8, [1.0, 1.0, 0.0]), (6, [0.0, 1.0, 0.0])] {
        assert_close(&positions[index], &serde_json::json!(corner), 1e-12);
    }
    assert_close(&samples["faces"][0]["normals"][4], &serde_json::json!([0.0, 0.0, 1.0]), 1e-12);
}

#[test]
fn grids_as_fine_as_the_device_and_no_finer() {
    let samples = json("sample --shape single-quad --grid 65");
    assert_eq!(length(&samples["faces"][0]["positions"]), 65 * 65);
    let output = run("sample --shape single-quad --grid 66");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(
        stderr.starts_with("error: --grid 66: ") && stderr.ends_with(" evaluates at most 65; more with --cpu\n"),
        "{stderr}"
    );
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(length(&json("sample --shape single-quad --grid 66 --cpu")["faces"][0]["positions"]), 66 * 66);
    fails("sample --shape cube --grid 1", 2, "invalid value '1' for '--grid <N>': 1 is not in 2..=4097");
    fails(
        "sample --shape cube --cpu --construction stencil",
        2,
        "the argument '--cpu' cannot be used with '--construction <HOW>'",
    );
}

/// The pixels of a picture that was drawn with these further arguments.
fn picture(path: &Path, arguments: &str) -> (Value, image::RgbaImage) {
    let told = json(&format!("render --validation --size 96x64 {arguments} -o {}", path.display()));
    (told, image::open(path).unwrap().to_rgba8())
}

#[test]
fn pictures_in_every_shading() {
    let folder = folder("shadings");
    let mut seen = Vec::new();
    for shading in ["lit", "normals", "patches", "wireframe", "cage", "control-mesh"] {
        let path = folder.join(format!("{shading}.png"));
        let (told, pixels) =
            picture(&path, &format!("--shape creature-mixed --shading {shading} --background 9,20,200"));
        assert_eq!(told["file"], path.to_str().unwrap());
        assert_eq!((&told["size"], &told["shading"]), (&serde_json::json!([96, 64]), &shading.into()));
        assert_eq!((&told["factor"], &told["samples"]), (&8.0.into(), &4.into()));
        assert!(told["patches"]["triangle"].as_u64().unwrap() > 0 && told["device"].is_string());
        assert_eq!(pixels.dimensions(), (96, 64));
        assert_eq!(pixels.get_pixel(0, 0).0, [9, 20, 200, 255]);
        assert!(!seen.contains(&pixels), "{shading}");
        seen.push(pixels);
    }
    // Nothing but the pictures: no half-written files.
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 6);
}

#[test]
fn constructions_draw_the_same_and_options_are_obeyed() {
    let folder = folder("options");
    let draw = |arguments: &str| picture(&folder.join("x.png"), &format!("--shape creature {arguments}")).1;
    let base = draw("");
    let differing = |other: &image::RgbaImage| base.pixels().zip(other.pixels()).filter(|(a, b)| a != b).count();
    assert!(differing(&draw("--construction stencil")) < 20);
    for other in ["--factor 1", "--samples 1", "--yaw 40", "--pitch -5", "--zoom 2", "--fov 60", "--up 0,0,1"] {
        assert!(differing(&draw(other)) > 20, "{other}");
    }
    // Seen from far away through a narrow angle, the target is in the middle.
    let far = draw("--eye -60,1,50 --target 0,1,0 --fov 3");
    assert_ne!(far.get_pixel(48, 32), far.get_pixel(0, 0));
    let beside = draw("--eye -60,1,50 --target 30,1,0 --fov 3");
    assert!(beside.pixels().all(|pixel| pixel == beside.get_pixel(0, 0)));
    for (name, kind) in [("equal", "equal"), ("odd", "odd"), ("even", "even")] {
        let path = folder.join("s.png");
        let (told, _) = picture(&path, &format!("--shape cube --factor 3.5 --spacing {name}"));
        assert_eq!((&told["spacing"], &told["factor"]), (&kind.into(), &3.5.into()));
    }
}

#[test]
fn kinds_of_patches_have_their_colours() {
    let folder = folder("kinds");
    // Gold is more red than blue, purple more blue than green, green more green than red.
    type Is = fn([u8; 4]) -> bool;
    let kinds: [(&str, Is); 3] = [
        ("torus", |[r, _, b, _]| r > b && b < 110),
        ("cube", |[_, g, b, _]| b > g),
        ("tetrahedron", |[r, g, _, _]| g > r),
    ];
    for (shape, is) in kinds {
        let (_, pixels) = picture(&folder.join("x.png"), &format!("--shape {shape} --shading patches --samples 1"));
        let background = *pixels.get_pixel(0, 0);
        let mut drawn = pixels.pixels().filter(|pixel| **pixel != background).peekable();
        assert!(drawn.peek().is_some() && drawn.all(|pixel| is(pixel.0)), "{shape}");
    }
}

#[test]
fn transparent_pictures_keep_their_colours_at_the_rim() {
    // A square seen from the front: one normal, one colour, wherever it covers a part of a pixel.
    let folder = folder("transparent");
    let (_, pixels) = picture(
        &folder.join("x.png"),
        "--shape single-quad --shading normals --background transparent --yaw 7 --pitch 40",
    );
    let full = *pixels.pixels().find(|pixel| pixel.0[3] == 255).unwrap();
    let partial: Vec<_> = pixels.pixels().filter(|pixel| ![0, 255].contains(&pixel.0[3])).collect();
    assert!(!partial.is_empty() && pixels.get_pixel(0, 0).0 == [0; 4]);
    for pixel in partial {
        let worst = (0..3).map(|c| pixel.0[c].abs_diff(full.0[c])).max().unwrap();
        assert!(worst <= 3, "{pixel:?} {full:?}");
    }
}

#[test]
fn shapes_are_listed_and_written() {
    let all = json("shapes");
    assert_eq!(keys(&all[0]), ["faces", "name", "summary", "vertices"]);
    let path = folder("shapes").join("made/cloth.obj");
    let told = json(&format!("shapes cloth --obj {}", path.display()));
    assert_eq!(told["file"], path.to_str().unwrap());
    let from_file = json(&format!("patches {} --construction cpu", path.display()));
    assert_eq!(from_file, json("patches --shape cloth --construction cpu"));
}

#[test]
fn devices_are_listed() {
    let devices = json("devices");
    assert!(length(&devices) > 0);
    for key in ["index", "name", "type", "driver", "samples", "max_tessellation_level", "missing"] {
        assert!(devices[0].get(key).is_some(), "{key}");
    }
    let output = run("render --shape cube -o x.png --device no-such-device");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(
        stderr.starts_with("error: device \"no-such-device\" (SUBDIV_DEVICE or --device): there is none"),
        "{stderr}"
    );
}

#[test]
fn wrong_usage_is_said_in_one_line() {
    fails("", 2, "no command is given: try 'subdiv --help'");
    fails("info", 2, "no mesh is given: name a file, or a built-in shape with --shape (`subdiv shapes` lists them)");
    fails("info a.obj --shape cube", 2, "both a mesh (a.obj) and --shape cube are given: leave one out");
    fails("rendr", 2, "unrecognized subcommand 'rendr' tip: a similar subcommand exists: 'render'");
    fails("render --shape cube", 2, "the following required arguments were not provided: --output <FILE>");
    for bad in ["0", "65", "nan", "x"] {
        let message = format!("invalid value '{bad}' for '--factor <FACTOR>': it must be a number from 1 to 64");
        fails(&format!("render --shape cube -o x.png --factor {bad}"), 2, &message);
    }
    for bad in ["0x4", "4", "4xx"] {
        let message = format!("invalid value '{bad}' for '--size <WxH>': it must be WxH in pixels, such as 1024x768");
        fails(&format!("render --shape cube -o x.png --size {bad}"), 2, &message);
    }
    fails(
        "render --shape cube -o x.png --background red",
        2,
        "invalid value 'red' for '--background <COLOUR>': it must be R,G,B from 0 to 255, #rrggbb, or transparent",
    );
    fails(
        "render --shape cube -o x.png --eye 1,2",
        2,
        "invalid value '1,2' for '--eye <X,Y,Z>': it must be three numbers with commas between, such as 1,2.5,-3",
    );
    fails("render --shape cube -o x.png --eye 1,2,3 --target 1,2,3", 2, "--eye and --target are the same point");
    fails(
        "render --shape cube -o x.png --eye 0,5,0 --target 0,0,0",
        2,
        "--up points along the view: choose another direction",
    );
    fails("render --shape cube -o x.jpg", 2, "--output x.jpg: pictures are PNG files: let the name end in .png");
    fails(
        "info --shape cube --scheme loop",
        2,
        "invalid value 'loop' for '--scheme <SCHEME>' [possible values: gregory]",
    );
}

#[test]
fn work_that_fails_is_said_in_one_line() {
    fails("info no-such.obj", 1, "no-such.obj: there is no such file");
    fails("info model.stl", 1, "model.stl: files ending in .stl can't be read: use .obj, .gltf or .glb");
    let known: Vec<String> =
        json("shapes").as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap().to_owned()).collect();
    let message = format!("there is no shape named \"dragon\": choose one of {}", known.join(", "));
    for command in ["info", "patches", "sample", "render -o x.png"] {
        fails(&format!("{command} --shape dragon"), 1, &message);
    }
    fails("shapes dragon --obj x.obj", 1, &message);

    let output = run("render --shape cube -o x.png --samples 3");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.starts_with("error: --samples 3: ") && stderr.ends_with(" has 1, 4\n"), "{stderr}");
    assert_eq!(output.status.code(), Some(1));
    let output = run("render --shape cube -o x.png --size 100000x2");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.starts_with("error: --size 100000x2: ") && stderr.contains(" draws at most "), "{stderr}");
    assert!(!Path::new("x.png").exists());
}

#[test]
fn bad_files_are_told_with_their_line() {
    let path = folder("bad").join("bad.obj");
    let fin = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\n# a fin\nf 1 2 5\n";
    for (text, message) in [
        (
            fin,
            "line 9: face 2 is the third face at the edge 0-1: an edge has one or two faces; separate the surfaces there",
        ),
        ("v 0 0 0\nf 1 2 3\n", "line 2: "),
        ("v 0 0 zero\n", "line 1: "),
        ("", "the mesh has no vertices: a control mesh needs at least one face"),
    ] {
        fs::write(&path, text).unwrap();
        for command in ["info", "patches", "sample --cpu", "render -o x.png"] {
            let output = run(&format!("{command} {}", path.display()));
            let stderr = String::from_utf8_lossy(&output.stderr);
            assert!(stderr.starts_with(&format!("error: {}: {message}", path.display())), "{command}: {stderr}");
            assert_eq!((stderr.lines().count(), output.status.code()), (1, Some(1)));
        }
    }
    fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\n").unwrap();
    let stderr = String::from_utf8(run(&format!("info {}", path.display())).stderr).unwrap();
    assert!(stderr.contains("vertex 3 belongs to no face"), "{stderr}");
    assert_eq!(json(&format!("info {} --drop-isolated", path.display()))["vertices"], 3);
}

#[test]
fn files_are_written_whole_or_not_at_all() {
    let folder = folder("whole");
    let file = folder.join("file");
    fs::write(&file, "here").unwrap();
    let below = file.join("x.png");
    fails(
        &format!("render --shape cube --size 8x8 -o {}", below.display()),
        1,
        &format!("{}: its folder can't be made: File exists (os error 17)", below.display()),
    );
    let taken = folder.join("taken.png");
    fs::create_dir(&taken).unwrap();
    fails(
        &format!("render --shape cube --size 8x8 -o {}", taken.display()),
        1,
        &format!("{}: this is a folder: name a file", taken.display()),
    );
    // A picture that is there stays as it is when the next one fails.
    let picture = folder.join("x.png");
    fs::write(&picture, "older").unwrap();
    assert!(!run(&format!("render --shape cube --samples 3 -o {}", picture.display())).status.success());
    assert_eq!(fs::read(&picture).unwrap(), b"older");
    assert!(run(&format!("render --shape cube --size 8x8 -o {}", picture.display())).status.success());
    assert!(fs::read(&picture).unwrap().starts_with(b"\x89PNG"));
    let mut names: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["file", "taken.png", "x.png"]);
}

#[test]
fn a_file_that_does_not_fit_leaves_the_older_one() {
    let folder = folder("full");
    let path = folder.join("x.obj");
    fs::write(&path, "older").unwrap();
    let script = "trap '' XFSZ; ulimit -f 1; exec \"$0\" shapes creature --obj \"$1\"";
    let output = Command::new("sh").args(["-c", script, env!("CARGO_BIN_EXE_subdiv")]).arg(&path).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(stderr, format!("error: {}: File too large (os error 27)\n", path.display()));
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(fs::read(&path).unwrap(), b"older");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    for arguments in ["patches --shape creature --construction cpu", "sample --shape creature --cpu --json"] {
        let mut child =
            subdiv().args(arguments.split_whitespace()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut start = [0; 16];
        child.stdout.take().unwrap().read_exact(&mut start).unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments}");
        assert!(output.status.success(), "{arguments}");
    }
}

#[test]
fn a_full_disk_is_an_error() {
    let Ok(mut full) = fs::OpenOptions::new().write(true).open("/dev/full") else { return };
    if full.write(b"x").is_ok() {
        return;
    }
    let output = subdiv().args(["info", "--shape", "cube"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("error: "), "{output:?}");
}
