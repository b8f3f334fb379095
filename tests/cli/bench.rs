//! `subdiv bench`.

use crate::{fails, folder, json, keys, length, run};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const SMALL: &str = "--size 32x32 --frames 6 --warm-up 0";

/// A run that was made once, as a file.
fn measured(folder: &Path, arguments: &str) -> (PathBuf, Value) {
    let results = json(&format!("bench {SMALL} {arguments}"));
    let path = folder.join("results.json");
    fs::write(&path, results.to_string()).unwrap();
    (path, results)
}

#[test]
fn bench_measures_every_path_on_every_kind_of_patch() {
    let results =
        json(&format!("bench {SMALL} --shape torus,tetrahedron --factors 3,1 --spacing odd,even --validation"));
    assert_eq!(
        keys(&results),
        ["command", "device", "growth", "left_out", "measured", "meshes", "options", "program", "rows"]
    );
    assert!(results["command"].as_str().unwrap().starts_with("subdiv bench --size 32x32"), "{results}");
    assert_eq!(results["options"]["frames"], 6);
    // A torus in 5 schemes and 3 constructions and in ACC as published, a tetrahedron in 3 schemes; each in 2 floors, 2 spacings
    // and 2 factors.
    // Left out: 2 schemes without triangles in 3 constructions, ACC as published among them, and 5 ways to evaluate lattices of 5 schemes, which have no
    // such spacing.
    let rows = results["rows"].as_array().unwrap();
    // Subdivision has no factor 3.
    let patches = ((5 * 3 + 1 + 2 + 3 * 3 + 2) * 4, (2 * 3 + 1) * 2 + 5 * 2 * 5 * 2);
    assert_eq!((rows.len(), length(&results["left_out"])), (patches.0 + 2 * 2, patches.1 + 2 * 2));
    for row in rows {
        assert_eq!(
            keys(row),
            [
                "bytes",
                "construction",
                "construction_ms",
                "cull",
                "factor",
                "fence_ms",
                "first_frame_ms",
                "frames_ms",
                "geometry_ms",
                "geometry_ratio",
                "gpu_ms",
                "gpu_ratio",
                "mesh",
                "normals",
                "passes",
                "patches",
                "path",
                "pipelines_ms",
                "scheme",
                "setup_ms",
                "spacing",
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
    assert!(
        text.contains("\ngregory  two-stage ") && text.contains("\nnone     none          vertex-buffer"),
        "{text}"
    );
    assert!(output.stderr.is_empty());
    let csv = String::from_utf8(run(&format!("bench {SMALL} {few} --replicate 1,4 --csv")).stdout).unwrap();
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{csv}");
    assert_eq!((lines.len(), lines[0][..3].join(" ")), (9, "mesh scheme construction".into()));
    assert_eq!((lines[5][0], lines[5][10]), ("cube x4", "24"));
    let text = run(&format!("bench {SMALL} {few} --replicate 1,4"));
    let text = String::from_utf8(text.stdout).unwrap();
    assert_eq!(
        text.split("\ntime grows as patches^").nth(1).map(|grown| grown.trim_end().lines().count()),
        Some(5),
        "{text}"
    );
}

#[test]
fn bench_measures_normals_culling_and_views_beside_each_other() {
    let results = json(&format!(
        "bench {SMALL} --shape creature --factors 2 --schemes gregory --constructions two-stage --paths \
         tessellation,bilinear --normals own,shared --cull frustum,back --view fit,clipped"
    ));
    let rows = results["rows"].as_array().unwrap();
    let named = |row: &Value| ["view", "path", "normals", "cull"].map(|key| row[key].as_str().unwrap().to_owned());
    let of_view = |view: &str| {
        [
            ["tessellation", "own", "none"],
            ["tessellation", "own", "back+frustum"],
            ["tessellation", "shared", "none"],
            ["tessellation", "shared", "back+frustum"],
            ["bilinear", "own", "none"],
        ]
        .map(|[path, normals, cull]| [view, path, normals, cull].map(str::to_owned))
    };
    let expected: Vec<_> = ["fit", "clipped"].into_iter().flat_map(of_view).collect();
    assert_eq!(rows.iter().map(named).collect::<Vec<_>>(), expected);
    for rows in rows.chunks(5) {
        assert_eq!(rows[0]["gpu_ratio"]["value"], 1.0);
    }
    let views = results["views"].as_array().unwrap();
    assert_eq!(views.iter().map(named).collect::<Vec<_>>(), expected[5..]);
    let (view, of) = (&views[0], |row: &Value| row["visible_triangles"].as_f64().unwrap());
    let frames =
        |row: &Value| row["frames_ms"]["gpu"].as_array().unwrap().iter().map(|ms| ms.as_f64().unwrap()).collect();
    let (near, far): (Vec<f64>, Vec<f64>) = (frames(&rows[5]), frames(&rows[0]));
    let mut ratios: Vec<f64> = near.iter().zip(&far).map(|(near, far)| near / far).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    let expected = (ratios[2] + ratios[3]) / 2.0 * of(&rows[0]) / of(&rows[5]);
    assert!((view["gpu"]["value"].as_f64().unwrap() - expected).abs() < 1e-9, "{view}");
}

/// What `bench` finds in rows with these times.
fn found(name: &str, arguments: &str, times: impl Fn(&Value) -> f64) -> (Value, String) {
    let folder = folder(name);
    let (path, mut results) = measured(&folder, arguments);
    for row in results["rows"].as_array_mut().unwrap() {
        let ms = times(row);
        let frames: Vec<f64> = (0..9).map(|i| ms * (1.0 + f64::from(i) / 1000.0)).collect();
        row["frames_ms"] = json!({ "gpu": frames, "geometry": frames });
    }
    fs::write(&path, results.to_string()).unwrap();
    let report = folder.join("report");
    let output = run(&format!("bench --results {} --report {}", path.display(), report.display()));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let page = fs::read_to_string(report.join("index.html")).unwrap();
    for title in ["time grows as patches^", "compute wins from so many passes on"] {
        assert_eq!(text.contains(title), page.contains(title), "{title}");
    }
    (json(&format!("bench --results {}", path.display())), text)
}

#[test]
fn bench_finds_from_how_many_passes_on_compute_wins() {
    let few = "--shape cube --factors 2,3,4 --schemes gregory --constructions two-stage,cached --passes 1,2,4 --paths";
    // Compute costs 5 and 1 a pass; tessellation 3 a pass, so that they meet at 2.5, but at factor 3 much less and at
    // factor 4 much more.
    let times = |row: &Value| {
        let passes = row["passes"].as_f64().unwrap();
        let a_pass = [3.0, 0.5, 9.0][row["factor"].as_f64().unwrap() as usize - 2];
        if row["path"] == "compute" { 5.0 + passes } else { a_pass * passes }
    };
    let (results, text) = found("bench-passes", &format!("{few} tessellation,compute"), times);
    let found = results["break_even"].as_array().unwrap();
    let line = |factor: f64, construction: &str| {
        found.iter().find(|f| f["factor"] == factor && f["construction"] == construction).unwrap()
    };
    assert_eq!(found.len(), 6);
    for construction in ["two-stage", "cached"] {
        let [even, never, always] = [2.0, 3.0, 4.0].map(|factor| &line(factor, construction)["geometry"]);
        assert!((even["value"].as_f64().unwrap() - 2.5).abs() < 0.02, "{even}");
        assert!(even["low"].as_f64() < even["value"].as_f64() && even["value"].as_f64() < even["high"].as_f64());
        assert_eq!(*never, json!({ "value": null, "low": null, "high": null }));
        assert_eq!(*always, json!({ "value": 1.0, "low": 1.0, "high": 1.0 }));
    }
    assert!(text.contains("\ncompute wins from so many passes on ") && text.contains("more (more to more)"), "{text}");
    assert_eq!(results["options"]["passes"], json!([1, 2, 4]));
    // One count says nothing of others.
    let one = json(&format!("bench {SMALL} --shape cube --factors 1 --schemes gregory --paths tessellation,compute"));
    assert_eq!(one.get("break_even"), None);
}

#[test]
fn bench_finds_how_time_and_bytes_grow() {
    let few =
        "--shape cube --factors 1 --schemes gregory --constructions two-stage --paths tessellation --replicate 1,2,4";
    let (results, text) = found("bench-growth", few, |row| row["patches"].as_f64().unwrap().powf(1.25));
    let found = results["growth"].as_array().unwrap();
    assert_eq!((found.len(), &found[0]["mesh"]), (1, &json!("cube x4")));
    assert!((found[0]["gpu"]["value"].as_f64().unwrap() - 1.25).abs() < 1e-9, "{}", found[0]);
    let bytes = found[0]["bytes"].as_f64().unwrap();
    assert!(bytes > 0.5 && bytes < 1.05, "{bytes}");
    assert!(text.contains("  1.25 (1.25 to 1.25)  "), "{text}");
}

#[test]
fn bench_records_crowds() {
    let few = "--shape tetrahedron --recording 4 --schemes gregory,acc --constructions two-stage,cached";
    let results = json(&format!("bench {SMALL} {few}"));
    // Gregory in three ways, three crowds each; ACC has no triangles, and floors are not recorded.
    let recording = results["recording"].as_array().unwrap();
    assert_eq!((recording.len(), length(&results["left_out"]), length(&results["rows"])), (9, 3, 0));
    assert_eq!(
        keys(&recording[0]),
        [
            "construction",
            "crowd",
            "cull",
            "draw_ms",
            "frame_ms",
            "mesh",
            "models",
            "normals",
            "path",
            "prepare_ms",
            "scheme"
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
    fails("bench --recording 0", 2, "invalid value '0' for '--recording <MODELS>': 0 is not in 1..=100000");
    fails("bench --recording 1 --csv", 2, "the argument '--recording <MODELS>' cannot be used with '--csv'");
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
    assert!(text.lines().nth(1).unwrap().starts_with("\"a cube, of mine.obj\",acc,stencil"), "{text}");
    fails("bench --shape torus --patches irregular", 1, "torus: it has no irregular patches: choose others");
}

#[test]
fn bench_tells_what_changed() {
    let folder = folder("bench-compare");
    let few = "--shape cube --factors 2 --paths tessellation,bilinear --schemes gregory --constructions stencil";
    let (old, results) = measured(&folder, few);
    let of = |results: &Value, name: &str, scale: f64| {
        let mut results = results.clone();
        for row in results["rows"].as_array_mut().unwrap() {
            // Every frame its own, so that ranks are clear.
            let frames: Vec<f64> = (0..15).map(|i| scale * (1.0 + f64::from(i) / 50.0)).collect();
            row["frames_ms"] = json!({ "gpu": frames, "geometry": frames.iter().rev().collect::<Vec<_>>() });
        }
        let path = folder.join(name);
        fs::write(&path, results.to_string()).unwrap();
        path
    };
    let [one, same, slow] =
        [("one", 1.0), ("same", 1.001), ("slow", 1.5)].map(|(name, scale)| of(&results, name, scale));
    let verdicts = |new: &Path, old: &Path| {
        let text = run(&format!("bench --results {} --compare {}", new.display(), old.display()));
        let text = String::from_utf8(text.stdout).unwrap();
        ["faster", "slower", "the same"].map(|verdict| text.matches(&format!(" %  {verdict}\n")).count())
    };
    assert_eq!(verdicts(&slow, &one), [0, 4, 0]);
    assert_eq!(verdicts(&one, &slow), [4, 0, 0]);
    assert_eq!(verdicts(&same, &one), [0, 0, 4]);
    let changes = json(&format!("bench --results {} --compare {}", slow.display(), one.display()))["changes"].clone();
    assert!((changes[0]["ratio"]["value"].as_f64().unwrap() - 1.5).abs() < 0.1, "{changes}");
    assert!(changes[0]["confidence"].as_f64().unwrap() > 0.99);

    let (other, _) = measured(&crate::folder("bench-other"), "--shape torus --factors 2 --paths bilinear");
    fails(
        &format!("bench --results {} --compare {}", other.display(), old.display()),
        1,
        "the results to compare with have no row in common with these: measure the same meshes and factors",
    );
}

#[test]
fn presets_set_published_figures_beside() {
    let results = json(&format!("bench {SMALL} --shape cube --preset loop2009-table1"));
    let lines = results["published"].as_array().unwrap();
    assert_eq!(lines.len(), 6);
    assert_eq!((&lines[0]["published_ratio"], &lines[0]["ratio"]), (&json!(1.0), &json!(1.0)));
    let pm = lines.iter().find(|line| line["scheme"] == "pm").unwrap();
    assert!((pm["published_ratio"].as_f64().unwrap() - 0.1327 / 0.1047).abs() < 1e-12);
    let row = |line: &Value| {
        let keys = ["scheme", "construction", "factor"];
        let rows = results["rows"].as_array().unwrap().iter();
        rows.clone().find(|row| row["path"] == "tessellation" && keys.iter().all(|key| row[key] == line[key])).unwrap()
    };
    let ratio =
        row(pm)["geometry_ms"]["median"].as_f64().unwrap() / row(&lines[0])["geometry_ms"]["median"].as_f64().unwrap();
    assert!((pm["ratio"].as_f64().unwrap() - ratio).abs() < 1e-9);

    let text = run(&format!("bench {SMALL} --shape cube --preset antal2007 --paths subdivision"));
    let text = String::from_utf8(text.stdout).unwrap();
    assert!(text.contains("\nAntal et al. 2007") && text.contains("18.8 frames/s"), "{text}");
    let converted =
        json(&format!("bench {SMALL} --shape cube --preset ni2008-table4 --paths geometry-two-pass --factors 4"));
    let lines = converted["published"].as_array().unwrap();
    // This is none of the sword, the head and the frog, and so beside each.
    assert_eq!((lines.len(), &lines[0]["construction"], &lines[0]["figure"]), (3, &json!("cached"), &json!(965.0)));
    assert_eq!(lines[0]["ms"], converted["rows"][0]["gpu_ms"]["median"]);
    let none = json(&format!("bench {SMALL} --shape cube --preset ni2008-table5 --factors 1 --paths tessellation"));
    assert_eq!((&none["options"]["instances"], none.get("published")), (&json!(9), None));
}

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
        "invalid value 'x' for '--preset <NAME>' [possible values: loop2009-table1, loop2009-table2, ni2008-table4, ni2008-table5, antal2007]",
    );
    fails(
        "bench --paths magic",
        2,
        "invalid value 'magic' for '--paths <PATH>' [possible values: tessellation, acc-published, compute, instanced, geometry, geometry-two-pass, subdivision, bilinear, vertex-buffer]",
    );
    fails(
        "bench --results x.json --factors 1",
        2,
        "the argument '--results <FILE.json>' cannot be used with '--factors <FACTOR>'",
    );
    fails(
        "bench --paths compute,geometry --constructions two-stage",
        2,
        "none of --paths, --constructions, --schemes and --normals go together: compute goes with cached; geometry goes with stencil and cached; shared normals go with tessellation and watertight schemes (gregory, gregory-fitted)",
    );
    fails(
        "bench --paths acc-published,subdivision --schemes gregory --normals shared",
        2,
        "none of --paths, --constructions, --schemes and --normals go together: acc-published goes with acc and two-stage; shared normals go with tessellation and watertight schemes (gregory, gregory-fitted)",
    );
    fails("bench --view far", 2, "invalid value 'far' for '--view <WHERE>' [possible values: fit, clipped]");
    fails("bench --passes 1,0", 2, "invalid value '0' for '--passes <N>': 0 is not in 1..=64");
    fails("bench --compare no.json", 1, "no.json: No such file or directory (os error 2)");
    let results = folder("bench-bad").join("bad.json");
    fs::write(&results, "{}").unwrap();
    let name = results.display();
    let message = format!("{name}: not what `subdiv bench --json` writes: missing field `program` at line 1 column 2");
    fails(&format!("bench --results {name}"), 1, &message);
    let output = run("bench --shape tetrahedron --schemes acc --paths tessellation");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.ends_with("error: nothing could be measured: face 0: the scheme acc has no patches for triangles: choose the scheme gregory, which has, or name it as fallback\n"), "{stderr}");
}

/// A report of a run with everything in it.
fn report(name: &str) -> PathBuf {
    let folder = folder(name);
    let few = "--shape cube,tetrahedron --factors 6,10 --constructions two-stage --preset loop2009-table1";
    let (old, _) = measured(&folder, few);
    let folder = folder.join("made");
    let output = run(&format!("bench {SMALL} {few} --compare {} --report {}", old.display(), folder.display()));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    folder
}

#[test]
fn reports_need_nothing_but_themselves() {
    let folder = report("bench-report");
    let page = fs::read_to_string(folder.join("index.html")).unwrap();
    for outside in ["http:", "https:", "<script", "<link", "url("] {
        let found = page.replace("http://www.w3.org/2000/svg", "").contains(outside);
        assert!(!found, "{outside}");
    }
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 2);
    // Of each mesh, time with and without pixels and the error; and growth, since the meshes differ in size.
    assert_eq!(page.matches("<figure class=\"plot\">").count(), 2 * 3 + 2);
    assert!(page.contains("What changed") && page.contains("Published figures") && page.contains("Left out"));
    let results: Value = serde_json::from_slice(&fs::read(folder.join("results.json")).unwrap()).unwrap();
    let csv = fs::read_to_string(folder.join("results.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + length(&results["rows"]));
    // The same page from the numbers alone.
    let again = folder.join("again");
    run(&format!("bench --results {} --report {}", folder.join("results.json").display(), again.display()));
    let page_again = fs::read_to_string(again.join("index.html")).unwrap();
    assert_eq!(page_again.matches("<circle").count(), page.matches("<circle").count());
}

fn chromium() -> Option<PathBuf> {
    let named = std::env::var_os("CHROMIUM").map(PathBuf::from);
    let path = std::env::var_os("PATH").unwrap_or_default();
    let names = ["chromium", "chromium-browser", "chromium-headless-shell", "google-chrome"];
    let found =
        || std::env::split_paths(&path).flat_map(|folder| names.map(|name| folder.join(name))).find(|p| p.exists());
    named.or_else(found)
}

#[test]
fn reports_open_in_a_browser() {
    let Some(chromium) = chromium() else {
        eprintln!("not run: there is no Chromium in the path, and CHROMIUM does not name one");
        return;
    };
    let folder = report("bench-browser");
    let page = folder.join("index.html");
    let output = Command::new(chromium)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--dump-dom"])
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    let (dom, log) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{log}");
    // What a page complains of is logged as its console's.
    assert!(!log.contains(":CONSOLE"), "{log}");
    let rows =
        length(&serde_json::from_slice::<Value>(&fs::read(folder.join("results.json")).unwrap()).unwrap()["rows"]);
    // Parsed as pictures within the page, with a point for each row in two plots at least.
    let svg: usize = dom.split("<figure class=\"plot\">").skip(1).map(|plot| plot.matches("<circle").count()).sum();
    assert!(svg >= 2 * rows, "{svg} points, {rows} rows");
    assert!(dom.contains("</html>") && dom.matches("<figure class=\"plot\">").count() == 8);
}
