//! `subdiv bench`.

mod findings;
mod reports;

use crate::{fails, folder, json, keys, length, run};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

const SMALL: &str = "--size 32x32 --frames 6 --warm-up 0";

/// A run that was made once, as a file.
fn measured(folder: &Path, arguments: &str) -> (PathBuf, Value) {
    let results = json(&format!("bench {SMALL} {arguments}"));
    let path = folder.join("results.json");
    fs::write(&path, results.to_string()).unwrap();
    (path, results)
}

// Longer than a screen: every claim is about the same costly run.
#[test]
fn bench_measures_every_path_on_every_kind_of_patch() {
    let results =
        json(&format!("bench {SMALL} --shape torus,tetrahedron --factors 3,1 --spacing odd,even --validation"));
    assert_eq!(keys(&results), ["command", "device", "left_out", "measured", "meshes", "options", "program", "rows"]);
    assert!(results["command"].as_str().unwrap().starts_with("subdiv bench --size 32x32"), "{results}");
    assert_eq!(results["options"]["frames"], 6);
    // A torus in 5 schemes and 3 constructions and in ACC as published, a tetrahedron in 3 schemes; each in 2 floors, 2 spacings
    // and 2 factors.
    // Left out: 2 schemes without triangles in 3 constructions, ACC as published among them, and 5 ways to evaluate uniform grids of
    // 5 schemes, which have no such spacing, with ACC as published, instanced, and the CPU's vertices, for either mesh.
    let rows = results["rows"].as_array().unwrap();
    // Subdivision has no factor 3.
    let patches = ((5 * 3 + 1 + 2 + 3 * 3 + 2) * 4, (2 * 3 + 1) * 2 + (5 * 5 + 2) * 2 * 2);
    assert_eq!((rows.len(), length(&results["left_out"])), (patches.0 + 2 * 2, patches.1 + 2 * 2));
    for row in rows {
        assert_eq!(
            keys(row),
            [
                "adaptive",
                "bytes",
                "compute_invocations",
                "construction",
                "construction_ms",
                "creases",
                "cull",
                "drawn_by",
                "factor",
                "fence_ms",
                "first_frame_ms",
                "frames_ms",
                "geometry_ms",
                "geometry_ratio",
                "gpu_ms",
                "gpu_ratio",
                "mesh",
                "motion",
                "normals",
                "passes",
                "patches",
                "path",
                "pipelines_ms",
                "scheme",
                "setup_ms",
                "spacing",
                "sums",
                "tables_ms",
                "tes_invocations",
                "traffic_bytes",
                "triangles",
                "upload_ms",
                "view",
                "visible_triangles",
            ]
        );
        for times in [&row["gpu_ms"], &row["geometry_ms"]] {
            assert_eq!(keys(times), ["mad", "max", "median", "min"]);
            let [min, median, max] = ["min", "median", "max"].map(|key| times[key].as_f64().unwrap());
            assert!(0.0 < min && min <= median && median <= max, "{row}");
        }
        assert!(row["bytes"]["total"].as_u64().unwrap() > 0 && row["triangles"].as_u64().unwrap() > 0);
        assert_eq!(length(&row["frames_ms"]["gpu"]), 6);
    }
    // Less than a floor with the tessellation stages says nothing of paths without.
    let tessellated = ["tessellation", "acc-published"].map(|path| json!(path));
    assert!(rows.iter().all(|row| row["construction_ms"].is_null() != tessellated.contains(&row["path"])));
    assert!(rows.iter().all(|row| (row["path"] == "compute") <= (row["compute_invocations"].as_u64() > Some(0))));
    // The first row of each group is what the others are compared with.
    assert_eq!(rows[0]["gpu_ratio"], json!({ "value": 1.0, "low": 1.0, "high": 1.0 }));
    assert_eq!((&rows[0]["factor"], &rows[0]["spacing"]), (&json!(1.0), &json!("odd")));
    assert!(rows.iter().any(|row| row["path"] == "bilinear" && row["scheme"] == "none"));
}

#[test]
fn bench_writes_tables_and_csv() {
    let few = "--shape cube --factors 2 --schemes gregory --constructions two-stage";
    let output = run(&format!("bench {SMALL} {few}"));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("cube: 6 patches, factor 2, equal spacing\nscheme "), "{text}");
    assert!(text.lines().nth(2).unwrap().contains(" tessellation          48  "), "{text}");
    assert!(
        text.contains("\ngregory  two-stage ") && text.contains("\nnone     none          vertex-buffer"),
        "{text}"
    );
    assert!(output.stderr.is_empty());
    let csv = String::from_utf8(run(&format!("bench {SMALL} {few} --replicate 1,4 --csv")).stdout).unwrap();
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{csv}");
    assert_eq!((lines.len(), lines[0][..3].join(" ")), (11, "mesh spacing motion".into()));
    let patches = lines[0].iter().position(|name| *name == "patches").unwrap();
    assert_eq!((lines[6][0], lines[6][patches]), ("cube x4", "24"));
    for name in ["gpu_ms_mad", "gpu_ratio_low", "geometry_ratio_high", "fence_ms_gpu_median", "upload_ms"] {
        let column = lines[0].iter().position(|other| *other == name).unwrap();
        assert!(lines[1..].iter().all(|line| line[column].parse::<f64>().is_ok()), "{name}: {csv}");
    }
    let text = run(&format!("bench {SMALL} {few} --replicate 1,4 --motion moving,still"));
    let text = String::from_utf8(text.stdout).unwrap();
    assert!(text.contains("\ncube x4: 24 patches, factor 2, equal spacing, still vertices\n"), "{text}");
    assert_eq!(
        text.split("\ntime grows as patches^").nth(1).map(|grown| grown.trim_end().lines().count()),
        Some(11),
        "{text}"
    );
}

#[test]
fn bench_measures_normals_culling_and_views_beside_each_other() {
    let results = json(&format!(
        "bench {SMALL} --shape creature --factors 2 --schemes gregory --constructions two-stage --paths \
         tessellation,bilinear --normals own,shared --cull frustum,back --cull-by compute,control --view fit,clipped"
    ));
    let rows = results["rows"].as_array().unwrap();
    let named = |row: &Value| ["view", "path", "normals", "cull"].map(|key| row[key].as_str().unwrap().to_owned());
    let of_view = |view: &str| {
        [
            ["tessellation", "own", "none"],
            ["tessellation", "own", "back+frustum"],
            ["tessellation", "own", "back+frustum by compute"],
            ["tessellation", "shared", "none"],
            ["tessellation", "shared", "back+frustum"],
            ["tessellation", "shared", "back+frustum by compute"],
            ["bilinear", "own", "none"],
        ]
        .map(|[path, normals, cull]| [view, path, normals, cull].map(str::to_owned))
    };
    let expected: Vec<_> = ["fit", "clipped"].into_iter().flat_map(of_view).collect();
    assert_eq!(rows.iter().map(named).collect::<Vec<_>>(), expected);
    for rows in rows.chunks(7) {
        assert_eq!(rows[0]["gpu_ratio"]["value"], 1.0);
        assert_eq!(rows[1]["triangles"], rows[2]["triangles"]);
    }
    let views = results["views"].as_array().unwrap();
    assert_eq!(views.iter().map(named).collect::<Vec<_>>(), expected[7..]);
    let (view, of) = (&views[0], |row: &Value| row["visible_triangles"].as_f64().unwrap());
    let frames =
        |row: &Value| row["frames_ms"]["gpu"].as_array().unwrap().iter().map(|ms| ms.as_f64().unwrap()).collect();
    let (near, far): (Vec<f64>, Vec<f64>) = (frames(&rows[7]), frames(&rows[0]));
    let mut ratios: Vec<f64> = near.iter().zip(&far).map(|(near, far)| near / far).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    let expected = (ratios[2] + ratios[3]) / 2.0 * of(&rows[0]) / of(&rows[7]);
    assert!((view["gpu"]["value"].as_f64().unwrap() - expected).abs() < 1e-9, "{view}");
}

#[test]
fn bench_records_crowds() {
    let few = "--shape tetrahedron --recording 4 --schemes gregory,acc --constructions two-stage,cached";
    let results = json(&format!("bench {SMALL} {few}"));
    // Gregory in six ways and subdivision, three crowds each; ACC has no triangles, and floors are not recorded.
    let recording = results["recording"].as_array().unwrap();
    assert_eq!((recording.len(), length(&results["left_out"]), length(&results["rows"])), (21, 6, 0));
    assert_eq!(
        keys(&recording[0]),
        [
            "adaptive",
            "construction",
            "creases",
            "crowd",
            "cull",
            "draw_ms",
            "drawn_by",
            "frame_ms",
            "mesh",
            "models",
            "normals",
            "path",
            "prepare_ms",
            "scheme",
            "sums"
        ]
    );
    let crowds: Vec<_> = recording.iter().take(3).map(|r| r["crowd"].as_str().unwrap()).collect();
    assert_eq!((crowds, &recording[0]["models"]), (vec!["instances", "models", "moving"], &json!(4)));
    let [frame, draw] = ["frame_ms", "draw_ms"].map(|key| recording[2][key]["max"].as_f64().unwrap());
    assert!(frame >= draw && draw > 0.0);
    let report = folder("bench-recording");
    let text = run(&format!("bench {SMALL} {few} --paths tessellation --report {}", report.display()));
    let text = String::from_utf8(text.stdout).unwrap();
    assert!(text.starts_with("recorded ") && text.lines().count() == 7, "{text}");
    let page = fs::read_to_string(report.join("index.html")).unwrap();
    assert!(page.contains("What the host takes to record a frame"));
    assert!(!page.contains("Plots") && !page.contains("<h2>Rows"));
    let csv = fs::read_to_string(report.join("results.csv")).unwrap();
    let columns = "mesh,scheme,construction,path,normals,adaptive,creases,sums,drawn_by,cull,crowd,models,";
    assert!(csv.starts_with(columns) && csv.lines().count() == 7, "{csv}");
    fails("bench --recording 0", 2, "invalid value '0' for '--recording <MODELS>': 0 is not in 1..=100000");
}

#[test]
fn bench_draws_subsets_and_files() {
    let cube = folder("bench-file").join("a cube, of mine.obj");
    crate::subdiv().args(["shapes", "cube", "--obj"]).arg(&cube).output().unwrap();
    let mut command = crate::subdiv();
    command.args(
        "bench --csv --factors 1 --paths tessellation --schemes acc --constructions stencil --patches irregular"
            .split(' '),
    );
    let output = command.args(SMALL.split(' ')).arg(&cube).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    // Commas in names are quoted.
    assert!(text.lines().nth(1).unwrap().starts_with("\"a cube, of mine.obj\",equal,moving,"), "{text}");
    let alone = folder("bench-isolated").join("alone.obj");
    fs::write(&alone, fs::read_to_string(&cube).unwrap() + "v 9 9 9\n").unwrap();
    let few = format!("bench {SMALL} --factors 1 --paths bilinear {}", alone.display());
    let told = |options: &str| String::from_utf8(run(&format!("{few} {options}")).stderr).unwrap();
    assert!(told("--strict").contains("vertex 8 belongs to no face"));
    assert!(run(&format!("{few} --strict --drop-isolated")).status.success());
    let mended = run(&few);
    let note = String::from_utf8(mended.stderr).unwrap();
    assert!(mended.status.success() && note.contains("1 vertex"), "{note}");
    fails("bench --shape torus --patches irregular", 1, "torus: it has no irregular patches: choose others");
}

// Longer than a screen: a list of cases.
#[test]
fn bench_says_what_is_left_out_once() {
    let told = |arguments: &str| {
        let output = run(&format!("bench {SMALL} --factors 1,2 {arguments}"));
        assert!(output.status.success(), "{arguments}");
        String::from_utf8(output.stderr).unwrap()
    };
    let why = "face 0: the scheme acc has no patches for triangles: choose the scheme gregory, which has, or name it as fallback";
    let few = "--shape tetrahedron --schemes gregory,acc --constructions stencil,cached --paths";
    assert_eq!(
        told(&format!("{few} tessellation --spacing equal,odd")),
        format!("note: tetrahedron: acc stencil tessellation, acc cached tessellation are left out: {why}\n")
    );
    assert_eq!(
        told(&format!("{few} tessellation,instanced,compute --passes 1,2")),
        format!(
            "note: tetrahedron: acc stencil tessellation, acc cached tessellation, acc cached compute and 1 more are left out: {why}\n"
        )
    );
    // What does not go together is told where it is asked for, and only there.
    assert_eq!(
        told(
            "--shape cube --paths tessellation,compute,acc-published --constructions two-stage --schemes gregory,gregory"
        ),
        "note: compute is left out: compute goes with cached\nnote: acc-published is left out: acc-published goes with acc and two-stage\n"
    );
    assert_eq!(
        told("--shape cube --paths acc-published --schemes acc,pm --constructions two-stage,stencil"),
        "note: pm is left out: none of --paths goes with it\nnote: stencil is left out: none of --paths goes with it\n"
    );
    assert_eq!(
        told("--shape cube --paths tessellation,instanced --schemes acc --cull back --cull-by control"),
        "note: --cull changes nothing of instanced: it is for the paths tessellation and, by compute, instanced\n"
    );
    assert_eq!(told("--shape cube --constructions two-stage --schemes gregory"), "");
    let shared =
        told("--shape cube --paths tessellation --constructions two-stage --schemes acc,gregory --normals shared");
    assert!(shared.starts_with("note: acc is left out: shared normals go with watertight schemes"), "{shared}");
    assert_eq!(
        told("--shape cube --paths tessellation,instanced --schemes acc --spacing odd"),
        "note: cube: acc cached instanced is left out: it does not go with fractional spacing: do without, or choose the path tessellation\n"
    );
    assert_eq!(
        told("--shape cube --paths tessellation,subdivision --schemes gregory --constructions two-stage --factors 3"),
        "note: cube: subdivision is left out at factor 3: subdivision has the factors 1, 2, 4 and 8, for levels 0 to 3\n"
    );
    let recorded = run("bench --shape cube --schemes gregory --paths tessellation,bilinear --recording 3 --frames 6");
    assert_eq!(
        String::from_utf8_lossy(&recorded.stderr),
        "note: bilinear is left out: the renderer alone does not record it\n"
    );
    // What is asked for in vain.
    assert_eq!(
        told("--shape cube --paths instanced --constructions cached --cull back --cull-by control"),
        told("--shape cube --paths bilinear --cull back")
    );
    assert_eq!(
        told("--shape cube --paths bilinear --cull back"),
        "note: --cull changes nothing here: it is for the paths tessellation and, by compute, instanced\n"
    );
    let shared = told("--shape cube --paths tessellation --schemes pm --normals own,shared");
    assert!(shared.starts_with("note: --normals shared changes nothing here: shared normals go with"), "{shared}");
}

// Longer than a screen: a list of cases.
#[test]
fn bench_says_what_is_wrong() {
    fails(
        "bench --frames 5",
        2,
        "invalid value '5' for '--frames <N>': it must be a whole number from 6 to 100000: with fewer there is no interval that holds the median",
    );
    fails("bench --factors 4,0", 2, "invalid value '0' for '--factors <FACTOR>': it must be a number from 1 to 64");
    fails(
        "bench --preset x",
        2,
        "invalid value 'x' for '--preset <NAME>' [possible values: loop2009-table1, loop2009-table2, ni2008-table4, ni2008-table5, ni2008-nine, antal2007, niessner2012]",
    );
    fails(
        "bench --paths magic",
        2,
        "invalid value 'magic' for '--paths <PATH>' [possible values: tessellation, acc-published, acc-published-instanced, compute, instanced, geometry, geometry-two-pass, subdivision, cpu, bilinear, vertex-buffer]",
    );
    fails(
        "bench --results x.json --factors 1",
        2,
        "the argument '--results <FILE.json>' cannot be used with '--factors <FACTOR>'",
    );
    fails(
        "bench --paths compute,geometry --constructions two-stage",
        2,
        "none of --paths, --constructions, --schemes and --normals go together: compute goes with cached; geometry goes with stencil and cached",
    );
    fails(
        "bench --paths acc-published,subdivision --schemes gregory --normals shared",
        2,
        "none of --paths, --constructions, --schemes and --normals go together: acc-published goes with acc and two-stage; shared normals go with watertight schemes (gregory, gregory-fitted), and without tessellation with cached, but not with geometry-two-pass",
    );
    fails(
        "bench --preset loop2009-table1 --paths compute",
        2,
        "none of --paths, --constructions, --schemes and --normals go together: compute goes with cached; the preset is of gregory, acc, pm, two-stage, stencil",
    );
    fails("bench --view far", 2, "invalid value 'far' for '--view <WHERE>' [possible values: fit, clipped]");
    fails("bench --passes 1,0", 2, "invalid value '0' for '--passes <N>': 0 is not in 1..=64");
    fails("bench --compare no.json", 1, "no.json: there is no such file");
    fails("bench --compare .", 1, ".: this is a folder: name a file");
    fails("bench --factors -1", 2, "invalid value '-1' for '--factors <FACTOR>': it must be a number from 1 to 64");
    fails(
        "bench --recording 3 --paths bilinear",
        2,
        "none of --paths is recorded by the renderer alone: name one of tessellation, compute, instanced, geometry, geometry-two-pass, subdivision",
    );
    let what = "the mesh has 5280000000 face corners";
    let output = run("bench --shape creature --replicate 1000000");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.starts_with(&format!("error: creature x1000000: {what}")) && output.stdout.is_empty(), "{stderr}");
    fails(
        "bench --shape cube --replicate 1000000000",
        2,
        "invalid value '1000000000' for '--replicate <N>': 1000000000 is not in 1..=1000000",
    );
    let results = folder("bench-bad").join("bad.json");
    fs::write(&results, "{}").unwrap();
    let name = results.display();
    let message = format!("{name}: not what `subdiv bench --json` writes: missing field `program` at line 1 column 2");
    fails(&format!("bench --results {name}"), 1, &message);
    // Results with something wrong in them.
    let (_, good) = measured(&folder("bench-good"), "--shape cube,cube --factors 2 --paths bilinear");
    assert_eq!((length(&good["meshes"]), length(&good["rows"])), (1, 1));
    let wrong = |change: fn(&mut Value), why: &str| {
        let mut bad = good.clone();
        change(&mut bad);
        fs::write(&results, bad.to_string()).unwrap();
        fails(&format!("bench --results {name}"), 1, &format!("{name}: not what `subdiv bench --json` writes: {why}"));
    };
    wrong(|bad| bad["rows"] = json!([]), "it has no rows");
    wrong(|bad| bad["rows"][0]["gpu_ms"]["min"] = json!(0.0), "row 1 (bilinear): a time of it is not above 0");
    wrong(|bad| bad["rows"][0]["frames_ms"]["gpu"][1] = json!(-1.0), "row 1 (bilinear): a time of it is not above 0");
    wrong(|bad| bad["rows"][0]["frames_ms"] = json!({}), "row 1 (bilinear): it has no frames");
    wrong(|bad| bad["rows"][0]["factor"] = json!(-2.0), "row 1 (bilinear): its factor is not from 1 up");
    let (_, good) =
        measured(&folder("bench-good-recording"), "--shape cube --schemes gregory --paths instanced --recording 2");
    let wrong = |key: &str, value: f64, why: &str| {
        let mut bad = good.clone();
        bad["recording"][1][key]["max"] = json!(value);
        fs::write(&results, bad.to_string()).unwrap();
        fails(&format!("bench --results {name}"), 1, &format!("{name}: not what `subdiv bench --json` writes: {why}"));
    };
    wrong("draw_ms", 0.0, "recording 2 (gregory cached instanced): a time of it is not above 0");
    wrong("prepare_ms", -1.0, "recording 2 (gregory cached instanced): a time of it is not above 0");
    let output = run("bench --shape tetrahedron --schemes acc --paths tessellation");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.ends_with("error: nothing could be measured: face 0: the scheme acc has no patches for triangles: choose the scheme gregory, which has, or name it as fallback\n"), "{stderr}");
}
