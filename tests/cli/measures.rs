//! `subdiv error`, and the limit surface of `subdiv sample`.

use crate::{assert_close, fails, folder, json, keys, length, run};
use ash_subdiv::Scheme;

#[test]
fn error_measures_every_scheme_there_is() {
    let report = json("error --shape tetrahedron --samples 5 --nearest 500");
    let known =
        "area diagonal irregular_patches mesh nearest_floor_rms nearest_samples patches samples schemes undefined";
    assert_eq!(keys(&report), known.split(' ').collect::<Vec<_>>());
    assert_eq!((&report["mesh"], &report["irregular_patches"]), (&"tetrahedron".into(), &4.into()));
    let [measured, undefined] = ["schemes", "undefined"].map(|key| keys(&report[key]));
    assert!(["gregory", "gregory-fitted", "pm"].iter().all(|name| measured.contains(name)), "{measured:?}");
    assert!(["acc", "c-patch"].iter().all(|name| undefined.contains(name)), "{undefined:?}");
    assert_eq!(measured.len() + undefined.len(), Scheme::ALL.len());
    let gregory = &report["schemes"]["gregory"];
    for key in ["position_rms", "position_max", "nearest_rms", "nearest_max", "normal_rms", "normal_max"] {
        assert!(gregory[key].as_f64().unwrap() > 0.0, "{key}: {gregory}");
        // All of its faces are irregular.
        assert_eq!(gregory[key], gregory["irregular"][key], "{key}");
    }
    // What is measured of the exact surface is a small part of it.
    assert!(report["nearest_floor_rms"].as_f64().unwrap() < 0.1 * gregory["nearest_rms"].as_f64().unwrap());
    let torus = json("error --shape torus --samples 2 --nearest 0 --scheme acc --scheme acc");
    assert_eq!(keys(&torus["schemes"]), ["acc"]);
    let acc = &torus["schemes"]["acc"];
    assert!(acc["irregular"].is_null() && acc["nearest_rms"].is_null(), "{acc}");
}

#[test]
fn error_measures_the_fallback() {
    let report = json("error --shape creature-mixed --samples 2 --nearest 0 --fallback gregory");
    let mut schemes = Scheme::ALL.map(Scheme::name);
    schemes.sort();
    assert_eq!(keys(&report["schemes"]), schemes);
    let triangles = json("info --shape creature-mixed")["patches"]["triangle"].clone();
    let fallen = |scheme: &str| report["schemes"][scheme]["fallen_back"].clone();
    assert_eq!([fallen("acc"), fallen("gregory"), fallen("pm")], [triangles, 0.into(), 0.into()]);
    let text = String::from_utf8(run("error --shape fan --samples 2 --nearest 0 --fallback gregory").stdout).unwrap();
    assert!(text.contains("\nacc has no patches for "), "{text}");
}

#[test]
fn error_writes_tables() {
    let output = run("error --shape tetrahedron --samples 3 --nearest 0");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("scheme ") && text.ends_with("\n") && text.contains("\npm "), "{text}");
    let notes = String::from_utf8(output.stderr).unwrap();
    let note = "note: face 0: the scheme acc has no patches for triangles: choose the scheme gregory, which has, or name it as \
         fallback\n";
    assert!(notes.starts_with(note), "{notes}");
    let csv = String::from_utf8(run("error --shape tetrahedron --samples 3 --nearest 0 --csv").stdout).unwrap();
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{csv}");
    assert_eq!((lines.len(), &lines[1][..2], lines[1][5]), (7, &["gregory", "all"][..], ""));
}

#[test]
fn error_plots_refined_meshes() {
    let prefix = folder("plots").join("new/tetrahedron");
    let name = prefix.display();
    let report = json(&format!("error --shape tetrahedron --samples 9 --nearest 500 --plot {name} --plot-steps 2"));
    let steps = report["refinements"].as_array().unwrap();
    let of_steps = |key: &str| steps.iter().map(|step| step[key].as_u64().unwrap()).collect::<Vec<_>>();
    assert_eq!((of_steps("refine"), of_steps("patches")), (vec![0, 1, 2], vec![4, 12, 48]));
    assert_eq!(of_steps("samples"), [9, 5, 5]);
    assert_eq!((keys(&steps[0]["schemes"]).len(), keys(&steps[1]["schemes"]).len()), (3, 5));
    let gregory = |key: &str| steps.iter().map(|s| s["schemes"]["gregory"][key].as_f64().unwrap()).collect::<Vec<_>>();
    assert_eq!(gregory("normal_rms")[0], report["schemes"]["gregory"]["normal_rms"].as_f64().unwrap());
    assert!(gregory("normal_rms").is_sorted_by(|a, b| a > b), "{report}");
    for (step, bytes) in gregory("table_bytes").into_iter().enumerate() {
        let info = json(&format!("info --shape tetrahedron --refine {step}"));
        assert_eq!(info["bytes"]["total"].as_f64().unwrap(), bytes);
    }

    let svg = std::fs::read_to_string(prefix.with_extension("svg")).unwrap();
    assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"));
    for text in ["tetrahedron: distance", "gregory", "acc", "pm", "c-patch", "normal rms, radians", "1e-4"] {
        assert!(svg.contains(text), "{text}");
    }
    // A dot for each step in each panel, and in the legend: schemes that start one step later have fewer.
    let dots = |colour: &str| svg.lines().filter(|l| l.starts_with("<circle") && l.contains(colour)).count();
    assert_eq!((dots("#0072B2"), dots("#009E73")), (3 * 6 + 1, 2 * 6 + 1));
    let png = image::open(prefix.with_extension("png")).unwrap().to_rgba8();
    assert_eq!((png.dimensions(), png.get_pixel(0, 0).0), ((1500, 940), [255; 4]));
    for colour in [[0, 114, 178, 255], [0, 158, 115, 255]] {
        assert!(png.pixels().filter(|pixel| pixel.0 == colour).count() > 100, "{colour:?}");
    }
    // Exact surfaces have no errors to plot.
    let torus = json(&format!("error --shape torus --samples 3 --nearest 0 --plot {name}.png --plot-steps 0"));
    assert_eq!(length(&torus["refinements"]), 1);
    assert!(std::fs::read_to_string(prefix.with_extension("svg")).unwrap().contains("no error, or not measured"));
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn error_prints_what_was_published() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/meshes/bigguy.obj");
    let output = run(&format!("error {path} --samples 2 --nearest 0 --published"));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("\npm           0.072   0.88  0.00783   1.10"), "{text}");
    assert!(text.contains("Metro") && text.contains("not the paper's mesh"), "{text}");
}

#[test]
fn error_says_what_is_wrong() {
    fails(
        "error --shape cube --published",
        2,
        "--published: there are figures for the monster frog and for bigguy, not for \"cube\"",
    );
    fails(
        "error --shape cube --plot-steps 1",
        2,
        "the following required arguments were not provided: --plot <PREFIX>",
    );
    fails(
        "error --shape cube --samples 1 --nearest 0 --plot /dev/null/x",
        1,
        "/dev/null/x.svg: its folder can't be made: File exists (os error 17)",
    );
    fails(
        "error --shape tetrahedron --scheme acc",
        1,
        "face 0: the scheme acc has no patches for triangles: choose the scheme gregory, which has, or name it as fallback",
    );
    fails(
        "error --shape cube --scheme limit",
        2,
        &format!(
            "invalid value 'limit' for '--scheme <SCHEME>' [possible values: {}]",
            Scheme::ALL.map(Scheme::name).join(", ")
        ),
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
    assert_eq!(keys(&limit["faces"][0]), ["face", "normals", "positions", "scheme", "sub"]);
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
    let message = "--scheme limit: the limit surface has no faces without patches: leave out --fallback";
    fails("sample --shape cube --scheme limit --cpu --fallback gregory", 2, message);
    let message = "--scheme limit: refinement does not change the limit surface: leave out --refine";
    fails("sample --shape cube --scheme limit --cpu --refine 1", 2, message);
}

#[test]
fn screen_tells_pixels_and_triangles() {
    let out = json("screen --shape torus --size 128x96 --pixels 6,3 --bend 0.5 --cull back");
    assert_eq!(keys(&out), ["construction", "device", "mesh", "rows", "size", "spacing"]);
    assert_eq!(
        (&out["mesh"], &out["size"], &out["spacing"]),
        (&"torus".into(), &serde_json::json!([128, 96]), &"equal".into())
    );
    let rows = out["rows"].as_array().unwrap();
    let names: Vec<_> =
        rows.iter().map(|row| (row["metric"].as_str().unwrap(), row["value"].as_f64().unwrap())).collect();
    let uniform = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0].map(|factor| ("uniform", factor));
    assert_eq!(names[..3], [("pixels", 6.0), ("pixels", 3.0), ("bend", 0.5)]);
    assert_eq!(names[3..], uniform);
    for row in rows {
        assert_eq!(keys(row), ["equal", "facets", "metric", "samples", "shape", "shift", "triangles", "value"]);
        for deviation in ["facets", "shape", "shift"] {
            let [rms, p99, max] = ["rms", "p99", "max"].map(|key| row[deviation][key].as_f64().unwrap());
            assert!(0.0 < rms && rms <= max && p99 <= max, "{row}");
        }
        let equal = &row["equal"];
        if row["metric"] == "uniform" {
            assert!(equal.is_null());
        } else {
            assert_eq!(keys(equal), ["facets", "shape", "shift"]);
            let Some(factor) = equal["facets"]["factor"].as_f64() else { panic!("{row}") };
            let level = &rows[3..].iter().find(|row| row["value"] == factor).unwrap();
            assert_eq!(level["triangles"], equal["facets"]["triangles"]);
            assert!(level["facets"]["p99"].as_f64().unwrap() <= 1.05 * row["facets"]["p99"].as_f64().unwrap());
        }
    }
    // What faces away is not drawn.
    assert!(rows[3]["triangles"].as_u64().unwrap() < 200, "{}", rows[3]);
    let text = String::from_utf8(run("screen --shape single-quad --size 64x64").stdout).unwrap();
    assert!(text.contains("\npixels 4, facets: ") && text.contains("uniform 1 is as good with 2"), "{text}");
}

#[test]
fn screen_refuses_what_makes_no_sense() {
    fails(
        "screen --shape cube --pixels 0",
        2,
        "invalid value '0' for '--pixels <PIXELS>': it must be a number above 0",
    );
    fails(
        "screen --shape cube --size 0x9",
        2,
        "invalid value '0x9' for '--size <WxH>': it must be WxH in pixels, such as 1024x768",
    );
}
