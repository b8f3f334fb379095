//! `subdiv error`, and the limit surface of `subdiv sample`.

use crate::{assert_close, fails, json, keys, length, run};

#[test]
fn error_measures_every_scheme_there_is() {
    let report = json("error --shape tetrahedron --samples 5 --nearest 500");
    let known = "area diagonal irregular_patches mesh nearest_samples patches samples schemes undefined";
    assert_eq!(keys(&report), known.split(' ').collect::<Vec<_>>());
    assert_eq!((&report["mesh"], &report["irregular_patches"]), (&"tetrahedron".into(), &4.into()));
    assert_eq!(keys(&report["schemes"]), ["gregory", "gregory-fitted", "pm"]);
    assert_eq!(keys(&report["undefined"]), ["acc", "c-patch"]);
    let gregory = &report["schemes"]["gregory"];
    for key in ["position_rms", "position_max", "nearest_rms", "nearest_max", "normal_rms", "normal_max"] {
        assert!(gregory[key].as_f64().unwrap() > 0.0, "{key}: {gregory}");
        // All of its faces are irregular.
        assert_eq!(gregory[key], gregory["irregular"][key], "{key}");
    }
    let torus = json("error --shape torus --samples 2 --nearest 0 --scheme acc --scheme acc");
    assert_eq!(keys(&torus["schemes"]), ["acc"]);
    let acc = &torus["schemes"]["acc"];
    assert!(acc["irregular"].is_null() && acc["nearest_rms"].is_null(), "{acc}");
}

#[test]
fn error_writes_tables() {
    let output = run("error --shape tetrahedron --samples 3 --nearest 0");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("scheme ") && text.ends_with("\n") && text.contains("\npm "), "{text}");
    let notes = String::from_utf8(output.stderr).unwrap();
    let note = "note: face 0: the scheme acc has no patches for triangles: choose the scheme gregory, which has\n";
    assert!(notes.starts_with(note), "{notes}");
    let csv = String::from_utf8(run("error --shape tetrahedron --samples 3 --nearest 0 --csv").stdout).unwrap();
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{csv}");
    assert_eq!((lines.len(), &lines[1][..2], lines[1][4]), (7, &["gregory", "all"][..], ""));
}

#[test]
fn error_says_what_is_wrong() {
    fails(
        "error --shape tetrahedron --scheme acc",
        1,
        "face 0: the scheme acc has no patches for triangles: choose the scheme gregory, which has",
    );
    fails(
        "error --shape cube --scheme limit",
        2,
        "invalid value 'limit' for '--scheme <SCHEME>' [possible values: gregory, gregory-fitted, acc, pm, c-patch]",
    );
    fails("error --shape cube --samples 0", 2, "invalid value '0' for '--samples <N>': 0 is not in 1..=1025");
    fails("error --shape cube --csv --json", 2, "the argument '--csv' cannot be used with '--json'");
    let help = String::from_utf8(run("error --help").stdout).unwrap();
    assert!(help.contains("weighted by area"), "{help}");
}

#[test]
fn the_limit_surface_is_sampled() {
    let limit = json("sample --shape polygons --scheme limit --cpu --grid 3");
    assert_eq!((&limit["grid"], &limit["construction"]), (&3.into(), &"cpu".into()));
    assert_eq!(keys(&limit["faces"][0]), ["face", "normals", "positions", "sub"]);
    let sizes = json("info --shape polygons")["face_sizes"].clone();
    let parts = |(size, count): (&String, &serde_json::Value)| match size.as_str() {
        "4" => count.as_u64().unwrap(),
        _ => size.parse::<u64>().unwrap() * count.as_u64().unwrap(),
    };
    let parts: u64 = sizes.as_object().unwrap().iter().map(parts).sum();
    assert_eq!(length(&limit["faces"]) as u64, parts);
    assert_eq!(length(&limit["faces"][0]["positions"]), 9);

    // Where all is regular it is what the patches are.
    let (limit, patches) =
        (json("sample --shape torus --scheme limit --cpu --grid 3"), json("sample --shape torus --cpu --grid 3"));
    for (a, b) in limit["faces"].as_array().unwrap().iter().zip(patches["faces"].as_array().unwrap()) {
        assert_eq!((&a["face"], &a["sub"]), (&b["face"], &b["sub"]));
        assert_close(&a["positions"], &b["positions"], 1e-12);
        assert_close(&a["normals"], &b["normals"], 1e-12);
    }
    let text = String::from_utf8(run("sample --shape tetrahedron --scheme limit --cpu --grid 2").stdout).unwrap();
    assert!(text.starts_with("face 0, part 0: limit\n") && text.lines().count() == 12 * 5, "{text}");
    let message = "--scheme limit: the limit surface is evaluated on the CPU: add --cpu";
    fails("sample --shape cube --scheme limit", 2, message);
    let message = "--scheme limit: refinement does not change the limit surface: leave out --refine";
    fails("sample --shape cube --scheme limit --cpu --refine 1", 2, message);
}
