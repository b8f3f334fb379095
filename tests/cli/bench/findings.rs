//! What is made of rows: findings, changes, and what papers published.

use super::{SMALL, measured};
use crate::{fails, folder, json, run};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

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
    // They are of all counts of passes together.
    assert!(found.iter().all(|f| f["passes"] == 0) && text.contains("\ncube, equal spacing  "), "{text}");
    assert!(text.contains("\ncompute wins from so many passes on ") && text.contains("more (more to more)"), "{text}");
    assert_eq!(results["options"]["passes"], json!([1, 2, 4]));
    // The first count is not the first pass: it may be fewer.
    let later = few.replace("1,2,4", "2,4");
    let (results, text) = self::found("bench-later-passes", &format!("{later} tessellation,compute"), times);
    let always = &results["break_even"].as_array().unwrap().iter().find(|f| f["factor"] == 4.0).unwrap()["geometry"];
    assert_eq!(*always, json!({ "value": 2.0, "low": 2.0, "high": 2.0, "least": 2.0 }));
    assert!(text.contains("  2 or fewer (2 or fewer to 2 or fewer)"), "{text}");
    // One count says nothing of others.
    let one = json(&format!("bench {SMALL} --shape cube --factors 1 --schemes gregory --paths tessellation,compute"));
    assert_eq!(one.get("break_even"), None);
}

#[test]
fn bench_finds_how_time_and_bytes_grow() {
    let few =
        "--shape cube --factors 1 --schemes gregory --constructions two-stage --paths tessellation --replicate 1,2,4";
    let (results, text) = self::found("bench-growth", few, |row| row["patches"].as_f64().unwrap().powf(1.25));
    let found = results["growth"].as_array().unwrap();
    assert_eq!((found.len(), &found[0]["mesh"]), (1, &json!("cube")));
    assert!((found[0]["gpu"]["value"].as_f64().unwrap() - 1.25).abs() < 1e-9, "{}", found[0]);
    let bytes = found[0]["bytes"].as_f64().unwrap();
    assert!(bytes > 0.5 && bytes < 1.05, "{bytes}");
    assert!(text.contains("  1.25 (1.25 to 1.25)  "), "{text}");
    let meshes = |key: &str| results["meshes"].as_array().unwrap().iter().map(|m| m[key].clone()).collect::<Vec<_>>();
    assert_eq!((meshes("of"), meshes("copies")), (vec![json!("cube"); 3], vec![json!(1), json!(2), json!(4)]));
    // Of meshes that have nothing to do with each other, it says nothing.
    let others = few.replace("--shape cube", "--shape cube,torus").replace("1,2,4", "1");
    let (results, _) = self::found("bench-no-growth", &others, |row| row["patches"].as_f64().unwrap());
    assert_eq!(results.get("growth"), None);
}

// Longer than a screen: one run of the program, and what follows from its results.
#[test]
fn bench_tells_what_changed_by_more_than_the_machine_did() {
    let folder = folder("bench-compare");
    let few = "--shape cube --factors 2 --schemes gregory --constructions stencil --paths tessellation";
    let (_, results) = measured(&folder, &format!("{few},bilinear,vertex-buffer"));
    // Every frame its own, so that ranks are clear; and each as many times as long as a path is slower.
    let of = |name: &str, slower: [(&str, f64); 3]| {
        let mut results = results.clone();
        let rows = results["rows"].as_array_mut().unwrap();
        rows.retain(|row| slower.iter().any(|(path, _)| row["path"] == *path));
        for row in rows {
            let scale = slower.iter().find(|(path, _)| row["path"] == *path).unwrap().1;
            let frames: Vec<f64> = (0..15).map(|i| scale * (1.0 + f64::from(i) / 5000.0)).collect();
            row["frames_ms"] = json!({ "gpu": frames, "geometry": frames.iter().rev().collect::<Vec<_>>() });
        }
        let path = folder.join(name);
        fs::write(&path, results.to_string()).unwrap();
        path
    };
    let all = |tessellation, bilinear, vertex_buffer| {
        [("tessellation", tessellation), ("bilinear", bilinear), ("vertex-buffer", vertex_buffer)]
    };
    let one = of("one", all(1.0, 1.0, 1.0));
    // Of tessellation, bilinear and vertex-buffer, each with pixels and without; and what is told.
    let compared = |new: &Path, old: &Path| {
        let output = run(&format!("bench --results {} --compare {}", new.display(), old.display()));
        let text = String::from_utf8(output.stdout).unwrap();
        let lines = text.lines().filter(|line| line.contains(" %  "));
        let verdicts: Vec<_> = lines.map(|line| line.rsplit("  ").next().unwrap().to_owned()).collect();
        (verdicts.join(", "), String::from_utf8(output.stderr).unwrap(), text)
    };
    let verdict = |slower| {
        let (verdicts, told, text) = compared(&of("new", slower), &one);
        assert!(
            told.is_empty() && text.contains("\nthe machine itself, by its floors, new / old: gpu "),
            "{told}{text}"
        );
        verdicts
    };
    let twice = |verdicts: [&str; 3]| verdicts.map(|verdict| format!("{verdict}, {verdict}")).join(", ");
    // The machine became slower, and so is all; but only what is above or below all floors has changed.
    assert_eq!(verdict(all(1.5, 1.6, 1.4)), twice(["as the machine", "slower", "slower"]));
    assert_eq!(verdict(all(1.5, 1.3, 1.2)), twice(["slower"; 3]));
    assert_eq!(verdict(all(0.8, 0.7, 1.3)), twice(["as the machine", "faster", "slower"]));
    assert_eq!(verdict(all(0.5, 0.7, 1.3)), twice(["faster", "faster", "slower"]));
    // One is always among what the machine may have done.
    assert_eq!(verdict(all(1.02, 1.1, 1.1)), twice(["as the machine", "slower", "slower"]));
    assert_eq!(verdict(all(0.9, 1.1, 1.1)), twice(["faster", "slower", "slower"]));
    assert_eq!(verdict(all(1.0, 1.0, 1.0)), twice(["the same"; 3]));

    let new = of("new", all(1.5, 1.3, 1.2));
    let changes = json(&format!("bench --results {} --compare {}", new.display(), one.display()))["changes"].clone();
    assert!((changes[0]["ratio"]["value"].as_f64().unwrap() - 1.5).abs() < 0.01, "{changes}");
    assert!(changes[0]["confidence"].as_f64().unwrap() > 0.99);
    assert!(
        changes[0]["machine"]["low"] == 1.0 && (changes[0]["machine"]["high"].as_f64().unwrap() - 1.3).abs() < 0.01
    );
    assert_eq!(changes[2]["machine"], json!({ "low": 1.0, "high": 1.0 }));

    // Without floors in both, a user is told that there is nothing to hold it against.
    let (verdicts, told, _) = compared(&of("alone", [("tessellation", 1.5); 3]), &one);
    assert_eq!(verdicts, "slower, slower");
    assert!(told.starts_with("note: no floor is in both results, so a machine that became slower"), "{told}");
}

#[test]
fn bench_compares_what_can_be_compared_and_says_so_before_it_measures() {
    let few = "--factors 2 --paths bilinear";
    let (old, _) = measured(&folder("bench-other"), &format!("--shape torus {few}"));
    let compare = |arguments: &str, message: &str| {
        fails(&format!("bench {SMALL} {arguments} {few} --compare {}", old.display()), 1, message);
    };
    let cannot = "the results to compare with are of";
    compare("--shape cube,strip", &format!("{cannot} torus, these of cube, strip: measure the same meshes"));
    let alike = |old, new| format!("{cannot} {old}, these of {new}: measure alike");
    compare("--shape torus --refine 1", &alike("--refine 0", "--refine 1"));
    compare("--shape torus --single-sided", &alike("both sides", "--single-sided"));
    compare("--shape torus --instances 2", &alike("--instances 1", "--instances 2"));
    // The results again, but for what is changed in them.
    let changed = |name: &str, change: fn(&mut Value)| {
        let mut results: Value = serde_json::from_slice(&fs::read(&old).unwrap()).unwrap();
        change(&mut results);
        let path = folder(name).join("results.json");
        fs::write(&path, results.to_string()).unwrap();
        path
    };
    let edited = changed("bench-edited", |results| results["meshes"][0]["vertices"] = json!(5));
    fails(
        &format!("bench --results {} --compare {}", edited.display(), old.display()),
        1,
        "torus: the results to compare with are of another mesh of that name: measure the same",
    );
    let elsewhere = changed("bench-elsewhere", |results| results["device"]["name"] = json!("another"));
    let output = run(&format!("bench --results {} --compare {}", elsewhere.display(), old.display()));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.starts_with("note: the results to compare with are of another device: "), "{told}");
    assert!(told.contains(", not another, ") && output.status.success(), "{told}");
    let nothing =
        "the results to compare with have no row in common with these: measure the same meshes, paths and factors";
    let (other, _) = measured(&folder("bench-factors"), "--shape torus --factors 3 --paths bilinear");
    fails(&format!("bench --results {} --compare {}", other.display(), old.display()), 1, nothing);
    for other in [
        "--factors 3 --paths bilinear",
        "--factors 2 --paths tessellation",
        "--factors 2 --paths bilinear --view clipped",
    ] {
        fails(&format!("bench {SMALL} --shape torus {other} --compare {}", old.display()), 1, nothing);
    }
}

// Longer than a screen: one part a preset.
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
    let one_pass = json(&format!("bench {SMALL} --shape cube --preset ni2008-table5 --paths geometry --factors 1,7"));
    let lines = one_pass["published"].as_array().unwrap();
    let figures: Vec<_> = lines.iter().map(|line| line["figure"].as_f64().unwrap()).collect();
    assert_eq!((figures, &lines[0]["construction"]), (vec![389.0, 43.0, 108.0, 15.0, 44.0, 4.0], &json!("stencil")));
    assert!((lines[1]["published_ratio"].as_f64().unwrap() - 389.0 / 43.0).abs() < 1e-12);
    let nine = json(&format!("bench {SMALL} --shape cube --preset ni2008-nine --paths geometry-two-pass"));
    assert_eq!((&nine["options"]["instances"], &nine["published"][0]["figure"]), (&json!(9), &json!(50.0)));
    let none = json(&format!("bench {SMALL} --shape cube --preset ni2008-nine --paths tessellation"));
    assert_eq!((none.get("published"), none["preset"]["note"].as_str().unwrap().contains("of 9 models")), (None, true));

    // Ratios are to the first figure that there is a row for; without any, a user is told.
    let few = format!("bench {SMALL} --shape cube --preset loop2009-table1 --paths tessellation");
    let at_six = json(&format!("{few} --factors 6"));
    let factors: Vec<_> = at_six["published"].as_array().unwrap().iter().map(|line| &line["factor"]).collect();
    assert_eq!((factors, &at_six["published"][0]["published_ratio"]), (vec![&json!(6.0); 2], &json!(1.0)));
    let report = folder("bench-preset");
    let text = run(&format!("{few} --factors 2 --report {}", report.display()));
    let text = String::from_utf8(text.stdout).unwrap();
    let page = fs::read_to_string(report.join("index.html")).unwrap();
    let told = "Measured: geometry alone. None of the figures is of what was measured: they are of factors 10, 6, tessellation, irregular patches of one model, moving vertices, all in the picture, one pass.";
    for written in [text, page] {
        assert!(written.contains("Loop, Schaefer, Ni, Castaño 2009, table 1") && written.contains(told), "{written}");
    }
    // Nor do they stand beside what was drawn otherwise.
    for otherwise in [
        "--patches all",
        "--instances 2",
        "--passes 2",
        "--view clipped",
        "--motion still",
        "--spacing odd",
        "--refine 1",
        "--replicate 2",
    ] {
        let results = json(&format!("{few} --factors 6 --schemes gregory {otherwise}"));
        assert_eq!(results.get("published"), None, "{otherwise}");
    }
    // Of grids that were instanced.
    let instanced = json(&format!(
        "bench {SMALL} --shape cube --preset loop2009-table2 --paths instanced --factors 16 --schemes acc"
    ));
    let lines = instanced["published"].as_array().unwrap();
    assert_eq!((lines.len(), &lines[0]["figure"], &lines[1]["figure"]), (2, &json!(365.0), &json!(348.0)));
}

#[test]
fn time_and_bytes_stand_beside_those_of_the_least_sharpness() {
    let few = "--factors 1 --paths tessellation,bilinear --sharpness 3,0";
    let results = json(&format!("bench {SMALL} --preset niessner2012 {few}"));
    let meshes: Vec<_> = results["meshes"].as_array().unwrap().iter().map(|mesh| &mesh["name"]).collect();
    assert_eq!(meshes, ["machine-part, sharpness 0", "machine-part, sharpness 3"]);
    assert_eq!(results["meshes"][1]["sharpness"], 3.0);
    let rows = results["rows"].as_array().unwrap();
    // One patch a face, three ways to follow creases, the floor.
    let ways: Vec<_> = rows[5..].iter().map(|row| (&row["adaptive"], row["creases"].as_str().unwrap())).collect();
    let (none, two) = (&Value::Null, &json!(2));
    assert_eq!(ways, [(none, "direct"), (two, "direct"), (two, "deep"), (two, "refined"), (none, "direct")]);
    let bytes = |row: usize| rows[row]["bytes"]["total"].as_f64().unwrap();
    let findings = results["sharpness"].as_array().unwrap();
    assert_eq!(findings.len(), 4);
    for (i, finding) in findings.iter().enumerate() {
        assert_eq!(finding["mesh"], "machine-part, sharpness 3");
        assert!((finding["bytes"].as_f64().unwrap() - bytes(5 + i) / bytes(i)).abs() < 1e-12, "{finding}");
        assert!(finding["geometry"]["value"].as_f64().unwrap() > 0.0);
    }
    // Followed at hardly any bytes; caps go one level deeper; refined, faces along creases do at least twice as often.
    assert!(bytes(6) < 1.1 * bytes(1) && bytes(7) > bytes(6) && bytes(8) > 2.0 * bytes(6), "{rows:?}");
    let folder = folder("bench-sharpness");
    let report = format!("--report {}", folder.display());
    let text = String::from_utf8(run(&format!("bench {SMALL} --preset niessner2012 {few} {report}")).stdout).unwrap();
    let page = fs::read_to_string(folder.join("index.html")).unwrap();
    for what in ["time", "bytes"] {
        let caption = format!("machine-part, equal spacing: {what} against sharpness at factor 1</figcaption>");
        let plot = page.split(&caption).nth(1).unwrap().split("</figure>").next().unwrap();
        // Five rows at each sharpness.
        assert_eq!(plot.matches("<polygon").count(), 10);
        assert!(plot.contains("2^sharpness 8,"), "{plot}");
    }
    assert!(text.contains("\ntime and bytes, to the least sharpness ") && text.contains("Nießner, Loop, Greiner 2012"));
    fails(
        &format!("bench {SMALL} --shape torus --sharpness 2"),
        1,
        "torus: it has no creases of finite sharpness: name a mesh that has",
    );
    fails(
        "bench --sharpness 10",
        2,
        "invalid value '10' for '--sharpness <SHARPNESS>': it must be a number from 0 to less than 10",
    );
}
