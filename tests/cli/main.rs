//! The program `subdiv`, run as a user runs it.
#![cfg(feature = "cli")]

mod adaptive;
mod animation;
mod bench;
#[path = "../common/mod.rs"]
mod common;
mod error_maps;
mod errors;
mod files;
mod measures;
mod pictures;
mod seams;
mod shadings;
mod tessellate;

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

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
    assert_eq!(info["patches"], serde_json::json!({ "regular": 0, "irregular_quad": 6, "triangle": 0, "pentagon": 0 }));
    assert_eq!(info["valence"], serde_json::json!({ "3": 8 }));
    assert_eq!((&info["boundary_edges"], &info["creased_edges"]), (&0.into(), &0.into()));
    assert_eq!(info["connectivity_types"], 1);
    let bytes = info["bytes"].as_object().unwrap();
    let total: u64 = bytes.iter().filter(|(name, _)| *name != "total").map(|(_, n)| n.as_u64().unwrap()).sum();
    assert_eq!(bytes["total"], total);
    assert_eq!(bytes["positions"], 8 * 16);

    let info = json("info --shape cube --refine 1 --construction stencil");
    assert_eq!(info["patches"]["irregular_quad"], 24);
    assert_eq!((&info["faces"], &info["construction"]), (&6.into(), &"stencil".into()));
    assert!(info["bytes"]["stencil_types"].is_u64());

    // Cut in wedges: three of each triangle, for all touch larger faces.
    let info = json("info --shape polygons");
    assert_eq!((&info["ngons"], length(&info["notices"])), (&32.into(), 0), "{info}");
    assert_eq!(
        info["patches"],
        serde_json::json!({ "regular": 0, "irregular_quad": 90, "triangle": 3 * 60 + 5 * 12 + 6 * 20, "pentagon": 0 })
    );
    let info = json("info --shape polygons --scheme acc");
    assert!(length(&info["notices"]) == 1 && info["patches"]["triangle"] == 0, "{info}");

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
    let cases = [("valences", 0, ""), ("creature-mixed", 0, "--scheme acc --fallback gregory"), ("polygons", 0, "")];
    for (shape, refine, more) in cases.into_iter().chain([("fan", 1, "")]) {
        let of = |maker| json(&format!("patches --shape {shape} --refine {refine} {more} --construction {maker}"));
        let (cpu, two_stage, stencil, cached) = (of("cpu"), of("two-stage"), of("stencil"), of("cached"));
        assert_eq!(keys(&cpu), ["construction", "patches"]);
        let patches = cpu["patches"].as_array().unwrap();
        let places: Vec<_> =
            patches.iter().map(|p| (p["face"].as_u64().unwrap(), p["sub"].as_i64().unwrap())).collect();
        assert!(places.is_sorted() && !places.is_empty());
        for (i, patch) in patches.iter().enumerate() {
            assert_eq!(keys(patch), ["face", "kind", "points", "scheme", "sub"]);
            let count = match [&patch["kind"], &patch["scheme"]].map(|name| name.as_str().unwrap()) {
                ["regular", _] => 16,
                ["irregular_quad", "gregory"] => 20,
                ["irregular_quad", "acc"] => 32,
                ["triangle", "gregory"] => 15,
                other => panic!("{other:?}"),
            };
            assert_eq!(length(&patch["points"]), count);
            for other in [&two_stage, &stencil, &cached] {
                let other = &other["patches"][i];
                for key in ["face", "sub", "kind", "scheme"] {
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

/// A pentagonal prism: with the scheme pm each of its pentagons is five patches, made and evaluated alike by all.
#[test]
fn pentagons_are_five_patches() {
    let prism = folder("prism").join("prism.obj");
    let at = |i: usize, y: f64| {
        let (sin, cos) = (i as f64 * 72f64.to_radians()).sin_cos();
        format!("v {cos} {y} {}\n", -sin)
    };
    let vertices: String = (0..10).map(|i| at(i % 5, (i / 5) as f64)).collect();
    let sides: String = (1..6).map(|i| format!("f {i} {} {} {}\n", i % 5 + 1, i % 5 + 6, i + 5)).collect();
    fs::write(&prism, format!("{vertices}f 6 7 8 9 10\nf 5 4 3 2 1\n{sides}")).unwrap();
    let of = |command: &str| json(&format!("{command} {} --scheme pm", prism.display()));
    let kinds = serde_json::json!({ "regular": 0, "irregular_quad": 5, "triangle": 0, "pentagon": 10 });
    assert_eq!(of("info")["patches"], kinds);
    let (cpu, gpu) = (of("patches --construction cpu"), of("patches --construction stencil"));
    for (i, (a, b)) in cpu["patches"].as_array().unwrap().iter().zip(gpu["patches"].as_array().unwrap()).enumerate() {
        let sub = if i < 10 { (i % 5) as i64 } else { -1 };
        assert_eq!((&a["sub"], length(&a["points"])), (&sub.into(), if i < 10 { 30 } else { 24 }));
        assert_close(&a["points"], &b["points"], 1e-5);
    }
    let (cpu, gpu) = (of("sample --grid 4 --cpu"), of("sample --grid 4"));
    for (a, b) in cpu["faces"].as_array().unwrap().iter().zip(gpu["faces"].as_array().unwrap()) {
        assert_close(&a["positions"], &b["positions"], 1e-5);
    }
    let text = String::from_utf8(
        run(&format!("render {} --scheme pm -o {}", prism.display(), prism.with_extension("png").display())).stdout,
    )
    .unwrap();
    assert!(text.contains("15 patches (0 regular, 5 irregular, 0 triangles, 10 of pentagons)"), "{text}");
}

#[test]
fn samples_are_the_same_on_both_sides() {
    for shape in ["creature-mixed --scheme c-patch --fallback gregory", "cloth"] {
        let cpu = json(&format!("sample --shape {shape} --grid 4 --cpu"));
        let gpu = json(&format!("sample --shape {shape} --grid 4 --construction stencil"));
        assert_eq!(keys(&cpu), ["construction", "faces", "grid"]);
        assert_eq!(
            (&cpu["grid"], &cpu["construction"], &gpu["construction"]),
            (&4.into(), &"cpu".into(), &"stencil".into())
        );
        assert_eq!(length(&cpu["faces"]), length(&gpu["faces"]));
        for (a, b) in cpu["faces"].as_array().unwrap().iter().zip(gpu["faces"].as_array().unwrap()) {
            assert_eq!(keys(a), ["face", "normals", "positions", "scheme", "sub"]);
            assert_eq!((&a["face"], &a["sub"], &a["scheme"]), (&b["face"], &b["sub"], &b["scheme"]));
            assert!([10, 16].contains(&length(&a["positions"])));
            assert_close(&a["positions"], &b["positions"], 1e-5);
            assert_close(&a["normals"], &b["normals"], 2e-3);
        }
    }
}

#[test]
fn corners_of_the_uniform_grid_are_corners_of_the_face() {
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
