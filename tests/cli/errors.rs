//! What the program says and leaves behind when something is wrong.

use crate::{fails, folder, json, run, subdiv};
use ash_subdiv::Scheme;
use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};

// Longer than a screen: a list of cases.
#[test]
fn wrong_usage_is_said_in_one_line() {
    fails("", 2, "no command is given: try 'subdiv --help'");
    fails("info", 2, "no mesh is given: name a file, or a built-in shape with --shape (`subdiv shapes` lists them)");
    fails("info a.obj --shape cube", 2, "both a mesh (a.obj) and --shape cube are given: leave one out");
    fails("rendr", 2, "unrecognized subcommand 'rendr' tip: a similar subcommand exists: 'render'");
    fails("render --shape cube", 2, "the following required arguments were not provided: --output <FILE>");
    for bad in ["0", "1025", "nan", "x"] {
        let message = format!(
            "invalid value '{bad}' for '--factor <FACTOR>': it must be a number from 1 to 64, or to 1024 without the tessellation stages (--evaluation)"
        );
        fails(&format!("render --shape cube -o x.png --factor {bad}"), 2, &message);
    }
    let too_large = "--factor 65: the tessellation stages take at most 64: choose another --evaluation for more";
    fails("render --shape cube -o x.png --factor 65", 2, too_large);
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
    fails("render --shape cube -o x.png --level 4", 2, "invalid value '4' for '--level <STEPS>': 4 is not in 0..=3");
    fails(
        "render --shape cube -o x.png --level 1 --scheme acc",
        2,
        "the argument '--level <STEPS>' cannot be used with '--scheme <SCHEME>'",
    );
    fails(
        "render --shape cube -o x.png --level 2 --shading error-normal",
        2,
        "--level: the error is that of patches: leave one of both out",
    );
    fails(
        "render --shape cube -o x.png --eye 0,5,0 --target 0,0,0",
        2,
        "--up points along the view: choose another direction",
    );
    fails(
        "render --shape cube -o x.png --evaluation compute --construction stencil",
        2,
        "--evaluation compute: it does not go with --construction stencil: choose cached, or leave it out",
    );
    fails(
        "render --shape cube -o x.png --evaluation geometry --construction stencil --displacement scales",
        2,
        "--evaluation geometry: it does not go with --construction stencil with --displacement: choose cached, or leave it out",
    );
    fails(
        "render --shape cube -o x.png --evaluation geometry-two-pass --displacement scales",
        2,
        "--evaluation geometry-two-pass: it does not go with --displacement: leave one of both out",
    );
    for (evaluation, what) in [
        ("instanced", "--pixels 3"),
        ("instanced", "--bend 1"),
        ("instanced", "--spacing odd"),
        ("compute", "--cull back"),
    ] {
        let (name, _) = what.split_once(' ').unwrap();
        let message = format!("--evaluation {evaluation}: it does not go with {name}: leave one of both out");
        fails(&format!("render --shape cube -o x.png --evaluation {evaluation} {what}"), 2, &message);
    }
    fails("render --shape cube -o x.jpg", 2, "--output x.jpg: pictures are PNG files: let the name end in .png");
    fails(
        "info --shape cube --scheme loop",
        2,
        &format!(
            "invalid value 'loop' for '--scheme <SCHEME>' [possible values: {}]",
            Scheme::ALL.map(Scheme::name).join(", ")
        ),
    );
}

#[test]
fn work_that_fails_is_said_in_one_line() {
    fails("info no-such.obj", 1, "no-such.obj: there is no such file");
    fails("info model.stl", 1, "model.stl: files ending in .stl can't be read: use .obj, .ply, .gltf or .glb");
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
            let output = run(&format!("{command} --strict {}", path.display()));
            let stderr = String::from_utf8_lossy(&output.stderr);
            assert!(stderr.starts_with(&format!("error: {}: {message}", path.display())), "{command}: {stderr}");
            assert_eq!((stderr.lines().count(), output.status.code()), (1, Some(1)));
        }
    }
    fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\n").unwrap();
    let stderr = String::from_utf8(run(&format!("info --strict {}", path.display())).stderr).unwrap();
    assert!(stderr.contains("vertex 3 belongs to no face"), "{stderr}");
    assert_eq!(json(&format!("info --strict {} --drop-isolated", path.display()))["vertices"], 3);
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
