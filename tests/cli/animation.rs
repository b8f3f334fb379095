//! Meshes at a time, and sequences of files.

use crate::{fails, folder, json, run};
use ash_subdiv::dice::{DiceOptions, Tessellation};
use ash_subdiv::mesh::animated_shape;
use ash_subdiv::topology::Topology;
use serde_json::json as value;
use std::fs;
use std::path::Path;

fn picture(path: &Path) -> image::RgbaImage {
    image::open(path).unwrap().to_rgba8()
}

/// The greatest difference of a channel.
fn difference(a: &image::RgbaImage, b: &image::RgbaImage) -> u8 {
    a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
}

/// Columns and rows of the outermost pixels that are not background.
fn extent(picture: &image::RgbaImage) -> [u32; 4] {
    let background = *picture.get_pixel(0, 0);
    let seen: Vec<_> = picture.enumerate_pixels().filter(|(.., p)| **p != background).map(|(x, y, _)| [x, y]).collect();
    let ends = |axis: usize| [seen.iter().map(|p| p[axis]).min().unwrap(), seen.iter().map(|p| p[axis]).max().unwrap()];
    [ends(0)[0], ends(0)[1], ends(1)[0], ends(1)[1]]
}

const VIEW: &str = "--size 96x96 --factor 6";

#[test]
fn frames_are_pictures_at_their_times() {
    let folder = folder("frames");
    let pattern = folder.join("made/frame_%03d.png");
    let told = json(&format!(
        "render --shape tentacle --animation curl --frames 2..5 --fps 4 {VIEW} --refit --validation -o {}",
        pattern.display()
    ));
    assert_eq!(told["frames"], value!({ "animation": "curl", "first": 2, "count": 3, "fps": 4.0 }));
    assert_eq!((&told["file"], &told["time"]), (&pattern.to_str().unwrap().into(), &value!(null)));
    let mut names: Vec<_> = fs::read_dir(folder.join("made")).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["frame_002.png", "frame_003.png", "frame_004.png"]);
    let mut seen: Vec<image::RgbaImage> = Vec::new();
    for (frame, seconds) in [(2, 0.5), (3, 0.75), (4, 1.0)] {
        let drawn = picture(&folder.join(format!("made/frame_{frame:03}.png")));
        let path = folder.join("one.png");
        let told =
            json(&format!("render --shape tentacle --animation curl --time {seconds} {VIEW} -o {}", path.display()));
        assert_eq!((&told["time"], &told["frames"]), (&seconds.into(), &value!(null)));
        assert!(difference(&drawn, &picture(&path)) <= 2, "frame {frame}");
        assert!(seen.iter().all(|before| difference(before, &drawn) > 50), "frame {frame} moves");
        seen.push(drawn);
    }
}

#[test]
fn one_camera_sees_all_frames() {
    let folder = folder("fitted");
    let pattern = folder.join("%d.png");
    // Culling by the view, where nothing may be missing: control points have moved far.
    for cull in ["", "--cull frustum", "--cull frustum --construction cached"] {
        let arguments = format!("render --shape tentacle --animation curl --frames 0..4 --fps 4 {VIEW} {cull}");
        json(&format!("{arguments} -o {}", pattern.display()));
        let pictures: Vec<_> = (0..4).map(|frame| picture(&folder.join(format!("{frame}.png")))).collect();
        let extents: Vec<_> = pictures.iter().map(extent).collect();
        let ends = |axis: usize| {
            [extents.iter().map(|e| e[2 * axis]).min().unwrap(), extents.iter().map(|e| e[2 * axis + 1]).max().unwrap()]
        };
        let ends = [ends(0), ends(1)];
        assert!(ends.iter().all(|[low, high]| *low >= 1 && *high <= 94), "{ends:?}");
        // In one direction they fill the picture, but for some room.
        assert!(ends.iter().any(|[low, high]| *low <= 8 && *high >= 87), "{ends:?}");
        // The foot stays where it is in all of them.
        assert!(extents.iter().all(|extent| extent[3].abs_diff(extents[0][3]) <= 1), "{extents:?}");
        let refitted = folder.join("refitted_%d.png");
        json(&format!("{arguments} --refit -o {}", refitted.display()));
        assert!(extent(&picture(&folder.join("refitted_0.png"))) != extents[0]);
    }
}

/// A cube that a node carries from (10, 0, 0) to (10, 0, 8) in two seconds, as glTF with a file beside it.
fn carried(folder: &Path) -> String {
    let corner = |v: u8| [0, 1, 2].map(|k| f32::from(v >> k & 1));
    let faces = [[0u16, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.map(|[a, b, c, d]| [a, b, c, a, c, d]);
    let mut bytes: Vec<u8> = (0..8).flat_map(corner).flat_map(f32::to_le_bytes).collect();
    bytes.extend(triangles.as_flattened().iter().flat_map(|i| i.to_le_bytes()));
    bytes.extend([0.0f32, 2.0, 10.0, 0.0, 0.0, 10.0, 0.0, 8.0].iter().flat_map(|x| x.to_le_bytes()));
    fs::write(folder.join("carried.bin"), &bytes).unwrap();
    let accessor = |view: usize, component: u32, count: usize, kind: &str| value!({ "bufferView": view, "componentType": component, "count": count, "type": kind });
    let view = |offset: usize, length: usize| value!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
    let primitive = value!({ "attributes": { "POSITION": 0 }, "indices": 1, "extensions": { "FB_ngon_encoding": {} } });
    let file = value!({
        "asset": { "version": "2.0" },
        "buffers": [{ "uri": "carried.bin", "byteLength": bytes.len() }],
        "bufferViews": [view(0, 96), view(96, 72), view(168, 8), view(176, 24)],
        "accessors": [
            accessor(0, 5126, 8, "VEC3"), accessor(1, 5123, 36, "SCALAR"),
            accessor(2, 5126, 2, "SCALAR"), accessor(3, 5126, 2, "VEC3"),
        ],
        "meshes": [{ "primitives": [primitive] }],
        "nodes": [{ "mesh": 0 }],
        "scenes": [{ "nodes": [0] }],
        "animations": [{
            "name": "Carry",
            "samplers": [{ "input": 2, "output": 3 }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }],
        }],
    });
    let path = folder.join("carried.gltf");
    fs::write(&path, file.to_string()).unwrap();
    path.display().to_string()
}

/// The positions of an OBJ file.
fn vertices(path: &Path) -> Vec<[f64; 3]> {
    let text = fs::read_to_string(path).unwrap();
    let numbers = |line: &str| {
        let numbers: Vec<f64> = line.split(' ').skip(1).map(|x| x.parse().unwrap()).collect();
        [numbers[0], numbers[1], numbers[2]]
    };
    text.lines().filter(|line| line.starts_with("v ")).map(numbers).collect()
}

fn farthest(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn files_of_a_mesh_that_is_carried() {
    let folder = folder("carried");
    let mesh = carried(&folder);
    let info = json(&format!("info {mesh}"));
    assert_eq!(info["animations"], value!([{ "name": "Carry", "seconds": 2.0 }]));
    assert_eq!(json(&format!("info {mesh} --time 1"))["bounds"], value!([[10.0, 0.0, 4.0], [11.0, 1.0, 5.0]]));
    let still = folder.join("still.obj");
    json(&format!("tessellate {mesh} -o {}", still.display()));
    let still = vertices(&still);
    for depth in ["--depth 3", "--tolerance 0.01", "--edge-length 0.3", "--pixels 20"] {
        let pattern = folder.join("at_%%_%02d.obj");
        let told = json(&format!("tessellate {mesh} {depth} --frames 0..3 --fps 1 -o {}", pattern.display()));
        assert_eq!(told["frames"], value!({ "animation": "Carry", "first": 0, "count": 3, "fps": 1.0 }));
        let frames: Vec<_> = (0..3).map(|frame| folder.join(format!("at_%_{frame:02}.obj"))).collect();
        let bytes: u64 = frames.iter().map(|frame| fs::metadata(frame).unwrap().len()).sum();
        assert_eq!(told["bytes"], bytes);
        let frames: Vec<_> = frames.iter().map(|frame| vertices(frame)).collect();
        for (frame, vertices) in frames.iter().enumerate() {
            let moved = |[x, y, z]: [f64; 3]| [x, y, z + 4.0 * frame as f64];
            let expected: Vec<_> = frames[0].iter().copied().map(moved).collect();
            assert!(farthest(vertices, &expected) < 2e-6, "{depth}, frame {frame}");
        }
        if depth == "--depth 3" {
            let moved: Vec<_> = still.iter().map(|&[x, y, z]| [x + 10.0, y, z]).collect();
            assert!(farthest(&frames[0], &moved) < 2e-6);
        }
    }
}

#[test]
fn tessellated_frames_are_limit_surfaces_of_moved_vertices() {
    let folder = folder("updated");
    let pattern = folder.join("%d.obj");
    json(&format!("tessellate --shape tentacle --frames 0..3 --fps 3 --depth 2 -o {}", pattern.display()));
    let shape = animated_shape("tentacle").unwrap();
    let mut data = shape.mesh.data().clone();
    for frame in 0..3 {
        shape.animations.positions_f64(0, f64::from(frame) / 3.0, &mut data.positions).unwrap();
        let topology = Topology::new(&ash_subdiv::ControlMesh::new(data.clone()).unwrap());
        let exact = Tessellation::<f64>::new(&topology, &DiceOptions::fixed(2)).unwrap();
        let owned = exact.plan().sizes().positions;
        let found = vertices(&folder.join(format!("{frame}.obj")));
        assert!(farthest(&found, &exact.positions()[..owned]) < 2e-6, "frame {frame}");
    }
}

#[test]
fn depths_of_frames_serve_all_of_them() {
    let folder = folder("depths");
    let pattern = folder.join("%d.obj");
    let told = |arguments: &str| json(&format!("tessellate --shape tentacle --tolerance 0.002 {arguments}"));
    let all = told(&format!("--animation curl --frames 0..5 --fps 4 -o {}", pattern.display()));
    let error = all["largest_error"].as_f64().unwrap();
    assert!(error > 0.0 && error <= 0.002, "{error}");
    let faces = |seconds: f64| {
        let one = told(&format!("--animation curl --time {seconds} -o {}", folder.join("one.obj").display()));
        one["faces"].as_u64().unwrap()
    };
    let most = (0..5).map(|frame| faces(f64::from(frame) / 4.0)).max().unwrap();
    assert!(all["faces"].as_u64().unwrap() >= most && faces(0.0) < most);
}

#[test]
fn times_that_make_no_sense() {
    let folder = folder("times");
    let out = folder.join("x.png").display().to_string();
    let frames = folder.join("%d.png").display().to_string();
    let render = |arguments: &str, message: &str| fails(&format!("render {arguments}"), 2, message);
    render(
        &format!("--shape cube --time 1 -o {out}"),
        "cube has no animations: leave --time, --frames and --animation out",
    );
    render(
        &format!("--shape tentacle --animation wave -o {out}"),
        "--animation wave: say when, with --time or --frames",
    );
    render(
        &format!("--shape tentacle --animation 3 --time 0 -o {out}"),
        "--animation: tentacle: there is no animation \"3\": choose one of \"wave\", \"curl\", \"swallow\"",
    );
    render(
        &format!("--shape tentacle --frames 5..5 -o {frames}"),
        "invalid value '5..5' for '--frames <FIRST..END>': it must be FIRST..END, such as 0..60 for frames 0 to 59",
    );
    let place = "name one place for the number of the frame, such as frame_%04d.png";
    render(&format!("--shape tentacle --frames 0..5 -o {out}"), &format!("--output {out}: {place}"));
    render(
        &format!("--shape tentacle --frames 0..5 --shading error-normal -o {frames}"),
        "--frames: --shading error-normal is measured for one mesh: draw frame by frame with --time",
    );
    render(
        &format!("--shape tentacle --time now -o {out}"),
        "invalid value 'now' for '--time <SECONDS>': it must be a number of seconds",
    );
    render(
        &format!("--shape tentacle --frames 0..5 --fps 0 -o {frames}"),
        "invalid value '0' for '--fps <FPS>': it must be a number above 0",
    );
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn broken_animations_do_not_stand_in_the_way_of_the_mesh() {
    let folder = folder("broken-animation");
    let mesh = carried(&folder);
    let text = fs::read_to_string(&mesh).unwrap().replace("\"output\":3", "\"output\":7");
    fs::write(&mesh, text).unwrap();
    let output = run(&format!("info {mesh}"));
    let stderr = String::from_utf8_lossy(&output.stderr);
    let why = format!("{mesh}: accessor 7 does not exist, but something names it");
    assert!(output.status.success() && stderr == format!("note: the animations can't be read: {why}\n"), "{stderr}");
    fails(&format!("info {mesh} --time 1"), 1, &why);
}

#[test]
fn vertices_of_the_cpu_make_the_same_picture() {
    let folder = folder("cpu");
    let draw = |name: &str, arguments: &str| {
        let path = folder.join(name);
        let told = json(&format!("render --size 160x160 --validation {arguments} -o {}", path.display()));
        (told, picture(&path))
    };
    // The limit surface, and its adaptive patches: triangles are cut along other diagonals, normals of end caps differ a little.
    for shape in ["creature", "torus", "machine-part", "cloth", "polygons"] {
        for shading in ["lit", "normals"] {
            let view = format!("--shape {shape} --shading {shading} --factor 8");
            let (told, cpu) = draw("cpu.png", &format!("{view} --evaluation cpu"));
            assert_eq!(told["evaluation"], "cpu");
            let (_, device) = draw("device.png", &format!("{view} --adaptive 5"));
            let differences: Vec<u8> = cpu
                .pixels()
                .zip(device.pixels())
                .map(|(a, b)| a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b)).max().unwrap())
                .collect();
            let most = differences.iter().max().unwrap();
            let above = differences.iter().filter(|&&difference| difference > 4).count();
            assert!(*most <= 64 && above <= cpu.pixels().len() / 100, "{shape} {shading}: {most}, {above}");
        }
    }
    let (_, lit) = draw("lit.png", "--shape cube --evaluation cpu");
    for shading in ["wireframe", "reflection-lines"] {
        let (_, other) = draw("other.png", &format!("--shape cube --evaluation cpu --shading {shading}"));
        assert!(difference(&lit, &other) > 50, "{shading}");
    }
    // Frames move, and are those of the device.
    let frames = |evaluation: &str| {
        let pattern = folder.join("frame_%d.png");
        let arguments = "render --shape tentacle --frames 0..3 --fps 2 --size 96x96";
        json(&format!("{arguments} {evaluation} -o {}", pattern.display()));
        (0..3).map(|frame| picture(&folder.join(format!("frame_{frame}.png")))).collect::<Vec<_>>()
    };
    for (cpu, device) in frames("--evaluation cpu").iter().zip(frames("--adaptive 4")) {
        assert!(difference(cpu, &device) <= 40);
    }
}

#[test]
fn what_vertices_of_the_cpu_do_not_go_with() {
    let folder = folder("cpu-errors");
    let out = folder.join("x.png").display().to_string();
    for (given, named) in [
        ("--pixels 4", "--pixels"),
        ("--cull back", "--cull"),
        ("--adaptive 3", "--adaptive"),
        ("--refine 1", "--refine"),
        ("--spacing odd", "--spacing"),
        ("--construction stencil", "--construction"),
        ("--displacement scales", "--displacement"),
    ] {
        let message = format!("--evaluation cpu: it does not go with {named}: leave one of both out");
        fails(&format!("render --shape torus --evaluation cpu {given} -o {out}"), 2, &message);
    }
    fails(
        &format!("render --shape torus --evaluation cpu --shading cage -o {out}"),
        2,
        "--evaluation cpu: --shading cage is drawn out of patches: choose lit, normals, wireframe or reflection-lines",
    );
    let output = run(&format!("render --shape torus --evaluation cpu --factor 5 --size 32x32 -o {out}"));
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(stderr, "note: --evaluation cpu: edges have 8 segments, the next power of two from 2 up\n");
}

#[test]
fn frames_that_are_cut_off_are_whole() {
    let folder = folder("cut-off");
    let names = |folder: &Path| -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    for (command, ending) in [("render --size 300x300", "png"), ("tessellate --depth 5", "obj")] {
        let out = folder.join(ending);
        fs::create_dir_all(&out).unwrap();
        let mut child = crate::subdiv()
            .args(command.split(' '))
            .args(["--shape", "tentacle", "--frames", "0..1000", "-o"])
            .arg(out.join(format!("%05d.{ending}")))
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        while !names(&out).contains(&format!("00002.{ending}")) {
            assert!(child.try_wait().unwrap().is_none(), "{command}: it ended");
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        let ended = child.wait_with_output().unwrap();
        assert!(kill.success() && !ended.status.success(), "{command}");
        let written = names(&out);
        let told = String::from_utf8(ended.stderr).unwrap();
        let expected = format!("error: interrupted: {} of 1000 frames are written\n", written.len());
        assert!(told.ends_with(&expected), "{told}");
        let expected: Vec<String> = (0..written.len()).map(|frame| format!("{frame:05}.{ending}")).collect();
        assert_eq!(written, expected, "{command}");
        let last = out.join(written.last().unwrap());
        match ending {
            "png" => assert_eq!(picture(&last).dimensions(), (300, 300)),
            _ => assert_eq!(vertices(&last).len(), vertices(&out.join(&written[0])).len()),
        }
    }
}
