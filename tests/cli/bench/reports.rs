//! `--report`: one page.

use super::{SMALL, measured};
use crate::{fails, folder, json, length, run};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

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
    // Of each mesh, time with and without pixels and the error.
    assert_eq!(page.matches("<figure class=\"plot\">").count(), 2 * 3);
    assert_eq!(page.matches("the thin line joins what none beats in both").count(), 2);
    assert!(page.contains("What changed") && page.contains("Published figures") && page.contains("Left out"));
    let results: Value = serde_json::from_slice(&fs::read(folder.join("results.json")).unwrap()).unwrap();
    let csv = fs::read_to_string(folder.join("results.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + length(&results["rows"]));
    // The numbers to their last digit, and the same page, from the numbers alone.
    let again = folder.join("again");
    run(&format!("bench --results {} --report {}", folder.join("results.json").display(), again.display()));
    assert_eq!(fs::read_to_string(again.join("results.csv")).unwrap(), csv);
    let page_again = fs::read_to_string(again.join("index.html")).unwrap();
    assert_eq!(page_again.matches("<polygon").count(), page.matches("<polygon").count());
}

#[test]
fn plots_say_which_setting_they_are_of() {
    let folder = folder("bench-settings");
    let few = "--shape cube --factors 2 --schemes gregory,pm --constructions two-stage --paths tessellation";
    let more = "--replicate 1,4 --passes 1,3 --view fit,clipped --motion moving,still";
    let output = run(&format!("bench {SMALL} {few} {more} --report {}", folder.display()));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let page = fs::read_to_string(folder.join("index.html")).unwrap();
    let mut captions: Vec<&str> =
        page.split("<figcaption>").skip(1).filter_map(|rest| rest.split("</figcaption>").next()).collect();
    let plots = captions.iter().filter(|caption| caption.contains(" spacing, ")).count();
    // Errors in 16 settings, growth in 8, passes in 8.
    assert_eq!(plots, 16 + 8 + 8, "{captions:?}");
    captions.sort_unstable();
    captions.dedup();
    assert_eq!(captions.iter().filter(|caption| caption.contains(" spacing, ")).count(), plots);
    for caption in [
        "cube x4, equal spacing, moving vertices, clipped view, 1 pass: error against time at factor 2;",
        "cube, equal spacing, still vertices, fit view, 3 passes: growth at factor 2: gregory two-stage tessellation as",
        "cube x4, equal spacing, still vertices, fit view: time against passes at factor 2",
    ] {
        assert!(captions.iter().any(|all| all.starts_with(caption)), "{caption} in {captions:?}");
    }
}

/// A report begins with the rows that none beats in both time and error, of adaptive surfaces too; the others are folded away.
#[test]
fn reports_open_with_the_fastest_for_each_accuracy() {
    let folder = folder("bench-front");
    let few = "--shape cube --factors 4 --schemes gregory,acc --constructions two-stage,cached --adaptive 0,3";
    let output = run(&format!("bench {SMALL} {few} --paths tessellation,instanced --report {}", folder.display()));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let results: Value = serde_json::from_slice(&fs::read(folder.join("results.json")).unwrap()).unwrap();
    let errors = &results["meshes"][0]["normal_error"];
    let keys = ["acc", "gregory", "gregory adaptive 0", "gregory adaptive 3"];
    assert_eq!(crate::keys(errors), keys);
    let error = |key: &str| errors[key].as_f64().unwrap();
    // At depth 0 the cube is its end caps; level 3 is much closer. What `error` says is the same.
    assert!((error(keys[2]) / error(keys[1]) - 1.0).abs() < 1e-9 && error(keys[3]) < 0.1 * error(keys[1]));
    let report = json("error --shape cube --scheme gregory --depths 3 --nearest 0");
    let of_error = |what: &str| report["schemes"]["gregory depth 3"][what].as_f64().unwrap();
    assert!((error(keys[3]) / of_error("normal_rms") - 1.0).abs() < 1e-9, "{report}");
    let position = results["meshes"][0]["position_error"][keys[3]].as_f64().unwrap();
    assert!((position / of_error("position_rms") - 1.0).abs() < 1e-9, "{report}");

    let rows: Vec<(f64, f64, String)> = results["rows"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| {
            let [scheme, construction, path] = ["scheme", "construction", "path"].map(|key| row[key].as_str().unwrap());
            let (depth, surface) = match row["adaptive"].as_u64() {
                Some(depth) => (format!(" adaptive {depth}"), format!("{scheme} adaptive {depth}")),
                None => (String::new(), scheme.to_owned()),
            };
            let label = format!("{scheme} {construction} {path}{depth}");
            (row["geometry_ms"]["median"].as_f64().unwrap(), error(&surface), label)
        })
        .collect();
    let is_best = |(ms, error, _): &&(f64, f64, String)| {
        !rows.iter().any(|other| (other.0 <= *ms && other.1 < *error) || (other.0 < *ms && other.1 <= *error))
    };
    let mut best: Vec<_> = rows.iter().filter(is_best).collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    let page = fs::read_to_string(folder.join("index.html")).unwrap();
    let body = page.split("<h1>").nth(1).unwrap();
    let answer = body.split("<h2>").nth(1).unwrap();
    assert!(answer.starts_with("The fastest for each accuracy"), "{answer}");
    let told = answer.split("<tbody>").nth(1).unwrap().split("</tbody>").next().unwrap();
    let places: Vec<_> = best.iter().map(|(_, _, label)| told.find(&format!(" {label}</th>"))).collect();
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{best:?} in {told}");
    assert_eq!(told.matches("<tr>").count(), best.len(), "{best:?} in {told}");
    assert!(answer.contains(&format!("<b>{}</b> is the fastest", best[0].2)), "{answer}");
    assert!(body.contains(&format!("<details><summary>All {} rows", rows.len())));
}

#[test]
fn reports_are_written_whole_or_not_at_all() {
    let folder = folder("bench-whole");
    let file = folder.join("file");
    fs::write(&file, "").unwrap();
    let page = file.join("index.html");
    let few = format!("bench {SMALL} --shape cube --factors 1 --paths bilinear --report");
    // Before anything is measured, of which tables would tell.
    let output = run(&format!("{few} {}", file.display()));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.stdout.is_empty() && !output.status.success());
    assert_eq!(told, format!("error: {}: this is no folder: name one for the report\n", file.display()));
    assert!(!page.exists());
    let taken = folder.join("taken");
    fs::create_dir_all(taken.join("index.html")).unwrap();
    fails(
        &format!("{few} {}", taken.display()),
        1,
        &format!("{}: this is a folder: name a file", taken.join("index.html").display()),
    );
    assert_eq!(fs::read_dir(&taken).unwrap().count(), 1);
    // Nothing is left of what could not be measured, and no other page is lost, nor what is compared with.
    let (new, made) = (folder.join("new"), folder.join("new").join("made"));
    let refused = "bench --shape tetrahedron --schemes acc --paths tessellation --report";
    assert!(!run(&format!("{refused} {}", made.display())).status.success() && !new.exists());
    let other = folder.join("other");
    fs::create_dir(&other).unwrap();
    fs::write(other.join("index.html"), "mine").unwrap();
    let why = "this is there already, and is not of a report: name another folder";
    fails(&format!("{few} {}", other.display()), 1, &format!("{}: {why}", other.join("index.html").display()));
    assert_eq!(fs::read(other.join("index.html")).unwrap(), b"mine");
    let (lone, results) = measured(&folder.join("other"), "--shape cube --factors 1 --paths bilinear");
    fails(&format!("{few} {}", other.display()), 1, &format!("{}: {why}", lone.display()));
    fs::remove_file(other.join("index.html")).unwrap();
    fails(&format!("{few} {}", other.display()), 1, &format!("{}: {why}", lone.display()));
    assert_eq!(fs::read_to_string(&lone).unwrap(), results.to_string());
    assert!(run(&format!("{few} {}", made.display())).status.success());
    let mut names: Vec<_> = fs::read_dir(&made).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort_unstable();
    assert_eq!(names, ["index.html", "results.csv", "results.json"]);
    assert!(run(&format!("{few} {}", made.display())).status.success(), "a report takes the place of a report");
    let old = made.join("results.json");
    let why = "the report would take the place of what it is compared with: name another folder";
    fails(&format!("{few} {} --compare {}", made.display(), old.display()), 1, &format!("{}: {why}", old.display()));
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
    let svg: usize = dom.split("<figure class=\"plot\">").skip(1).map(|plot| plot.matches("<polygon").count()).sum();
    assert!(svg >= 2 * rows, "{svg} points, {rows} rows");
    assert!(dom.contains("</html>") && dom.matches("<figure class=\"plot\">").count() == 6);
}
