//! `--report`: one page.

use super::{SMALL, measured};
use crate::{folder, length, run};
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
    assert_eq!(page_again.matches("<polygon").count(), page.matches("<polygon").count());
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
    assert!(dom.contains("</html>") && dom.matches("<figure class=\"plot\">").count() == 8);
}
