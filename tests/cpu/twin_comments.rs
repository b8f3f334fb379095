//! Every comment that points to a twin in the other language points at what is there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const ENDINGS: [&str; 8] = ["rs", "glsl", "vert", "tesc", "tese", "geom", "frag", "comp"];

fn collect(folder: &Path, files: &mut BTreeMap<String, String>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|ending| ENDINGS.iter().any(|e| ending == *e)) {
            let text = std::fs::read_to_string(&path).expect("text");
            let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
            files.insert(path.strip_prefix(root).expect("below it").to_string_lossy().into_owned(), text);
        }
    }
}

/// The comments of a file, each as one line.
fn comments(text: &str) -> Vec<String> {
    let mut all = vec![String::new()];
    for line in text.lines().map(str::trim) {
        match line.find("//") {
            Some(at) => {
                let words = line[at..].trim_start_matches(['/', '!']).trim();
                if at > 0 || words.is_empty() {
                    all.push(String::new());
                }
                let comment = all.last_mut().expect("one");
                comment.push_str(words);
                comment.push(' ');
            }
            None => all.push(String::new()),
        }
    }
    all
}

/// What follows "Rust twin: " or the like in a comment, up to the end of the sentence.
fn pointers<'c>(comment: &'c str, language: &str) -> Vec<&'c str> {
    let mut found = Vec::new();
    for (at, _) in comment.match_indices(&format!("{language} twin")) {
        let Some((_, rest)) = comment[at..].split_once(':') else { continue };
        let end = rest.match_indices(". ").map(|(end, _)| end).next().unwrap_or(rest.len());
        found.push(&rest[..end]);
    }
    found
}

/// The words of a sentence that are paths, and those that are names: in backticks, without a path's slash.
fn paths_and_names(sentence: &str) -> (Vec<&str>, Vec<&str>) {
    let words = sentence.split([' ', ',', ';', '(', ')']).map(|word| word.trim_matches(['`', '.', '"']));
    let has_ending = |word: &&str| word.rsplit_once('.').is_some_and(|(_, ending)| ENDINGS.contains(&ending));
    let paths: Vec<&str> = words.filter(has_ending).collect();
    let quoted = sentence.split('`').skip(1).step_by(2).filter(|word| !has_ending(word));
    (paths, quoted.collect())
}

/// Whether a file defines a name, or for `A::b` each part of it.
fn defines(text: &str, name: &str) -> bool {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let code: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    name.split("::").all(|part| {
        let part = part.trim_end_matches("()");
        code.iter().any(|line| {
            line.match_indices(part).any(|(at, _)| {
                let (before, after) = (&line[..at], &line[at + part.len()..]);
                !before.ends_with(is_word) && !after.starts_with(is_word)
            })
        })
    })
}

fn unresolved(files: &BTreeMap<String, String>) -> (usize, Vec<String>) {
    let (mut count, mut wrong) = (0, Vec::new());
    for (file, text) in files {
        let language = if file.ends_with(".rs") { "GLSL" } else { "Rust" };
        let all = comments(text);
        let sentences: Vec<&str> = all.iter().flat_map(|comment| pointers(comment, language)).collect();
        // A name without a file is in one of those that other comments of the file name.
        let of_file: Vec<&str> = sentences.iter().flat_map(|sentence| paths_and_names(sentence).0).collect();
        for sentence in sentences {
            count += 1;
            let (paths, names) = paths_and_names(sentence);
            let texts = |paths: &[&str]| -> Vec<&String> { paths.iter().filter_map(|path| files.get(*path)).collect() };
            let missing = paths.iter().filter(|path| !files.contains_key(**path)).map(|path| format!("no file {path}"));
            let searched = if paths.is_empty() { texts(&of_file) } else { texts(&paths) };
            let undefined = names.iter().filter(|name| !searched.iter().any(|text| defines(text, name)));
            let undefined = undefined.map(|name| format!("no {name} there"));
            let nothing = (paths.is_empty() && names.is_empty()).then(|| "names nothing".to_owned());
            wrong.extend(missing.chain(undefined).chain(nothing).map(|what| format!("{file}:{sentence}: {what}")));
        }
    }
    (count, wrong)
}

fn all_files() -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    for folder in ["src", "glsl", "tests/glsl"] {
        collect(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(folder), &mut files);
    }
    files
}

#[test]
fn twins_are_where_comments_say() {
    let (count, wrong) = unresolved(&all_files());
    assert!(count > 100, "{count}");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn twins_that_are_not_there_are_found() {
    let files = |comment: &str| {
        let glsl = format!("{comment}\nfloat f() {{\n}}\n");
        BTreeMap::from([("a.glsl".to_owned(), glsl), ("src/a.rs".to_owned(), "fn f() {}\n// fn g".to_owned())])
    };
    for (comment, wrong) in [
        ("// Rust twin: `f` in src/a.rs.", 0),
        ("// As said. Rust twin:\n// `f` in `src/a.rs`. And more: `g`.", 0),
        ("// Rust twin: `g` in src/a.rs.", 1),
        ("// Rust twin: `f` in src/b.rs.", 2),
        ("// Rust twins: src/a.rs.\n\n// Rust twin: `f`.", 0),
        ("// Rust twin: `f`.", 1),
        ("// Rust twin: somewhere.", 1),
    ] {
        assert_eq!(unresolved(&files(comment)).1.len(), wrong, "{comment}");
    }
}
