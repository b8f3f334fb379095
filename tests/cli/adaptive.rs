//! Adaptive surfaces on the command line.

use crate::{assert_close, fails, folder, json, keys, length, numbers, run};
use ash_subdiv::shape;
use serde_json::Value;

#[test]
fn info_counts_leaves() {
    assert!(json("info --shape cube").get("adaptive").is_none());
    // Of a cube every cell of levels 0 and 1 touches a vertex of three faces; from then on one of four does.
    let info = json("info --shape cube --adaptive 3");
    let leaves = &info["adaptive"];
    assert_eq!(
        keys(leaves),
        ["caps", "depth", "leaves", "levels", "refined", "regular", "sharp_depth", "single_crease"]
    );
    assert_eq!([&leaves["depth"], &leaves["sharp_depth"]], [3, 3]);
    let count = |value: &Value| ["regular", "single_crease", "caps"].map(|kind| value[kind].as_u64().unwrap());
    let levels = leaves["levels"].as_array().unwrap();
    assert_eq!(levels.iter().map(count).collect::<Vec<_>>(), [[0; 3], [0; 3], [72, 0, 0], [72, 0, 24]]);
    let refined = |value: &Value| value["refined"]["extraordinary vertex"].as_u64();
    assert_eq!(levels.iter().map(refined).collect::<Vec<_>>(), [Some(6), Some(24), Some(24), None]);
    assert_eq!((count(leaves), refined(leaves), &leaves["leaves"]), ([144, 0, 24], Some(54), &168.into()));
    // The leaves have a table of 20 words each.
    assert_eq!(info["bytes"]["leaves"], 168 * 80);
    assert_eq!(info["patches"]["irregular_quad"], 6);

    let info = json("info --shape machine-part --adaptive 0 --sharp-depth 2");
    assert_eq!([&info["adaptive"]["depth"], &info["adaptive"]["sharp_depth"]], [0, 2]);
    assert!(count(&info["adaptive"])[1] > 100, "{info}");
    let text = String::from_utf8(run("info --shape machine-part --adaptive 2").stdout).unwrap();
    assert!(text.contains("\nleaves ") && text.contains("\nlevel 2 ") && text.contains(" varying crease\n"), "{text}");
    let help = String::from_utf8(run("info --help").stdout).unwrap();
    assert!(
        help.split_whitespace().collect::<Vec<_>>().join(" ").contains("refined{name} (cells by reason)"),
        "{help}"
    );
}

#[test]
fn patches_by_leaves_draw_the_same_surface() {
    let folder = folder("by-leaves");
    let picture = |by: &str, more: &str| {
        let path = folder.join(format!("{by}.png"));
        let render = "render --shape machine-part --adaptive 2 --size 200x200 --samples 1 --factor 16";
        run(&format!("{render} --by {by} {more} -o {}", path.display()));
        image::open(&path).unwrap().to_rgb8()
    };
    let (faces, leaves) = (picture("faces", ""), picture("leaves", "--construction cached"));
    let differ = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).any(|i| a[i].abs_diff(b[i]) > 12);
    let different = faces.pixels().zip(leaves.pixels()).filter(differ).count();
    // Triangles lie elsewhere: along outlines.
    assert!(different < 200, "{different} pixels");
    let one = picture("leaves", "--pixels 4 --cull back,frustum,small");
    let few = faces.pixels().zip(one.pixels()).filter(differ).count();
    assert!(few < 200, "{few} pixels");
    let info = json("info --shape machine-part --adaptive 2 --by leaves");
    assert!(info["patches"]["triangle"].as_u64().unwrap() > 1000, "{info}");
    assert_eq!(info["patches"]["regular"], 0);
    let shape = "--shape cube --adaptive 1 --by leaves";
    let message = "--by leaves: the surface is the same by faces, which this command goes by: leave it out";
    fails(&format!("sample {shape}"), 2, message);
    fails(&format!("screen {shape}"), 2, message);
    let path = folder.join("none.png");
    let only = "evaluation by instanced has no patches by leaves: only by tessellation there are such; draw by faces";
    fails(&format!("render {shape} --evaluation instanced -o {}", path.display()), 1, only);
    assert!(!path.exists());
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn info_counts_the_leaves_that_were_published() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/meshes/monsterfrog.obj");
    for (depth, leaves) in [(0, 1292), (1, 3584), (2, 6896)] {
        assert_eq!(json(&format!("info {path} --adaptive {depth}"))["adaptive"]["leaves"], leaves);
    }
}

#[test]
fn samples_are_the_same_on_both_sides() {
    let grid = 6;
    let is_inside = |i: &usize| [i % grid, i / grid].iter().all(|place| (1..grid - 1).contains(place));
    for (name, depth) in [("creature", 2), ("machine-part", 3), ("polygons", 1)] {
        let of = |more: &str| json(&format!("sample --shape {name} --adaptive {depth} --grid {grid} {more}"));
        let (cpu, gpu) = (of("--cpu"), of("--construction cached"));
        let diagonal = shape(name).unwrap().diagonal();
        assert_eq!(length(&cpu["faces"]), length(&gpu["faces"]));
        for (a, b) in cpu["faces"].as_array().unwrap().iter().zip(gpu["faces"].as_array().unwrap()) {
            assert_eq!((&a["face"], &a["sub"]), (&b["face"], &b["sub"]));
            assert_close(&a["positions"], &b["positions"], 1e-6 * diagonal);
            let is_quad = length(&a["normals"]) == grid * grid;
            for i in (0..grid * grid).filter(|i| is_quad && is_inside(i)) {
                assert_close(&a["normals"][i], &b["normals"][i], 1e-4);
            }
        }
    }
}

#[test]
fn samples_come_to_the_limit_surface() {
    let limit = json("sample --shape cube --scheme limit --cpu --grid 9");
    let away = |depth: u32| {
        let cpu = json(&format!("sample --shape cube --adaptive {depth} --cpu --grid 9"));
        let faces = cpu["faces"].as_array().unwrap().iter().zip(limit["faces"].as_array().unwrap());
        let differences = faces.flat_map(|(a, b)| {
            let (a, b) = (numbers(&a["positions"]), numbers(&b["positions"]));
            a.into_iter().zip(b).map(|(a, b)| (a - b).abs()).collect::<Vec<_>>()
        });
        differences.fold(0.0, f64::max)
    };
    // Of cells of an eighth only the corners lie in caps of level 3.
    let distances = [0, 1, 3].map(away);
    assert!(distances.is_sorted_by(|a, b| a > b) && distances[2] < 1e-12, "{distances:?}");
}

#[test]
fn errors_fall_with_depth() {
    let report = json("error --shape cube --depths 0,1,3,1 --samples 9 --nearest 500");
    let schemes = &report["schemes"];
    let of = |depth: u32| &schemes[format!("gregory depth {depth}")];
    assert_eq!(length_of(schemes), 5 + 3);
    for key in ["position_rms", "position_max", "normal_rms", "normal_max"] {
        let plain = schemes["gregory"][key].as_f64().unwrap();
        let [zero, one, three] = [0, 1, 3].map(|depth| of(depth)[key].as_f64().unwrap());
        // At depth 0 all faces are end caps, which are the scheme's own patches.
        assert!((zero / plain - 1.0).abs() < 1e-9, "{key}: {report}");
        assert!(zero.min(one) > 10.0 * three, "{key}: {report}");
    }
    for depth in [0, 1, 3] {
        let info = json(&format!("info --shape cube --adaptive {depth}"));
        assert_eq!(of(depth)["table_bytes"], info["bytes"]["total"]);
        assert_eq!(of(depth)["leaves"], info["adaptive"]["leaves"]);
        assert_eq!((&of(depth)["patches"], &of(depth)["depth"]), (&6.into(), &depth.into()));
    }
    assert_eq!(schemes["gregory"]["table_bytes"], json("info --shape cube")["bytes"]["total"]);
    assert!(schemes["gregory"].get("depth").is_none() && schemes["gregory"].get("leaves").is_none());
}

fn length_of(object: &Value) -> usize {
    object.as_object().unwrap().len()
}

#[test]
fn depths_stand_in_tables_and_plots() {
    let of = |more: &str| run(&format!("error --shape fan --scheme gregory --samples 3 --nearest 0 {more}"));
    let text = String::from_utf8(of("--depths 1 --adaptive 2 --sharp-depth 3").stdout).unwrap();
    // A mesh of triangles is refined once for the depths.
    assert!(text.contains("\ngregory depth 1 ") && text.contains("\ngregory depth 2 sharp 3 "), "{text}");
    let csv = String::from_utf8(of("--depths 2 --csv").stdout).unwrap();
    assert!(csv.contains(",leaves,table_bytes\n") && csv.contains("\ngregory depth 2,all,"), "{csv}");
    let prefix = folder("depths").join("fan");
    assert!(of(&format!("--depths 0,1,2 --plot-steps 1 --plot {}", prefix.display())).status.success());
    let svg = std::fs::read_to_string(prefix.with_extension("svg")).unwrap();
    assert!(svg.contains("gregory by depth") && svg.contains("one patch a face"));
    // A dot for each depth in each panel that has errors, and in the legend.
    let dots = svg.lines().filter(|l| l.starts_with("<circle") && l.contains("#D55E00")).count();
    assert_eq!(dots, 3 * 4 + 1);
}

#[test]
fn what_cannot_be_refined_is_said() {
    let deep = "depth 11: adaptive subdivision goes 10 levels deep at most";
    for command in ["info", "sample --cpu", "sample", "error --nearest 0 --samples 1"] {
        fails(&format!("{command} --shape cube --adaptive 11"), 1, deep);
    }
    let caps = "scheme acc: end caps are patches of gregory or gregory-fitted";
    for command in ["info --adaptive 2", "sample --cpu --adaptive 2", "error --nearest 0 --samples 1 --depths 1"] {
        fails(&format!("{command} --shape cube --scheme acc"), 1, caps);
    }
    fails("error --shape cube --depths 11", 2, "invalid value '11' for '--depths <DEPTH>': 11 is not in 0..=10");
    let message =
        "--scheme limit: adaptive surfaces come to the limit surface, which has no depth: leave out --adaptive";
    fails("sample --shape cube --scheme limit --cpu --adaptive 2", 2, message);
    let message = "evaluation by subdivision has no patches: it cannot be adaptive";
    fails("render --shape cube -o x.png --level 1 --adaptive 2", 1, message);
    let message = "the following required arguments were not provided: --adaptive <DEPTH>";
    fails("info --shape cube --sharp-depth 2", 2, message);
}

#[test]
fn patches_are_leaves() {
    let out = json("patches --shape cube --adaptive 2 --construction cpu");
    assert_eq!((keys(&out), &out["construction"]), (vec!["construction", "leaves"], &"cpu".into()));
    let leaves = out["leaves"].as_array().unwrap();
    assert_eq!(leaves.len() as u64, json("info --shape cube --adaptive 2")["adaptive"]["leaves"].as_u64().unwrap());
    let limit = json("sample --shape cube --scheme limit --cpu --grid 5");
    for leaf in leaves {
        assert_eq!(keys(leaf), ["edge", "face", "kind", "level", "points", "sharpness", "sub", "u", "v"]);
        let place = ["face", "level", "u", "v"].map(|key| leaf[key].as_u64().unwrap() as usize);
        let [face, 2, u, v] = place else { panic!("{place:?}") };
        // The corner of the leaf is a sample of the limit surface.
        let expected = &limit["faces"][face]["positions"][5 * v + u];
        let points: Vec<Vec<f64>> = leaf["points"].as_array().unwrap().iter().map(numbers).collect();
        let corner = match (leaf["kind"].as_str().unwrap(), points.len()) {
            ("cap", 20) => points[0].clone(),
            ("regular", 16) => {
                let weights = [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0];
                let sum =
                    |x: usize| (0..9).map(|i| weights[i / 3] * weights[i % 3] * points[i / 3 * 4 + i % 3][x]).sum();
                [0, 1, 2].map(sum).into()
            }
            other => panic!("{other:?}"),
        };
        assert_close(&serde_json::json!(corner), expected, 1e-12);
    }
    let out = json("patches --shape machine-part --adaptive 0 --construction cpu");
    let creased = out["leaves"].as_array().unwrap().iter().filter(|leaf| leaf["kind"] == "single_crease");
    let creased: Vec<_> = creased.map(|leaf| (&leaf["sharpness"], leaf["edge"].as_u64().unwrap() < 4)).collect();
    assert!(
        creased.len() > 100
            && creased.iter().all(|&(sharpness, edge)| [1.5, 2.0].iter().any(|known| sharpness == known) && edge),
        "{creased:?}"
    );
    let text = String::from_utf8(run("patches --shape cube --adaptive 1 --construction cpu").stdout).unwrap();
    assert!(text.starts_with("face 0: level 1, cell 0 0: end cap\n  p0 ") && text.lines().count() == 24 * 21, "{text}");
    let message = "--adaptive: leaves are written as the CPU makes them: add --construction cpu";
    fails("patches --shape cube --adaptive 1", 2, message);
}

#[test]
fn triangles_come_to_the_surface_of_their_depth() {
    let row = |more: &str| {
        let out = json(&format!("screen --shape cube --size 128x128 --bend 0.5 {more}"));
        let uniform = out["rows"].as_array().unwrap().iter().find(|row| row["value"] == 32.0).unwrap();
        ["shift", "facets"].map(|of| uniform[of]["max"].as_f64().unwrap())
    };
    let ([plain, _], [depth_0, _], [depth_3, facets]) = (row(""), row("--adaptive 0"), row("--adaptive 3"));
    assert!((depth_0 / plain - 1.0).abs() < 0.01 && depth_3 < 0.1 * plain, "{plain} {depth_0} {depth_3}");
    // Facets are measured from the surface that is drawn.
    assert!(0.0 < facets && facets < 2.0 * depth_3 + 0.05, "{facets} {depth_3}");
}

#[test]
fn pictures_show_the_errors_of_their_depth() {
    let path = folder("adaptive-errors").join("x.png");
    let largest = |more: &str| {
        let picture = "render --shape polygons --shading error-position --size 240x120 --samples 1";
        json(&format!("{picture} -o {} {more}", path.display()))["error"]["largest"].as_f64().unwrap()
    };
    // All of its faces touch polygons, and are refined once in any case.
    let [plain, depth_1, depth_3] = ["", "--adaptive 1", "--adaptive 3"].map(largest);
    assert!((depth_1 / plain - 1.0).abs() < 1e-6 && depth_3 < 0.5 * plain, "{plain} {depth_1} {depth_3}");
}
