//! Levels of leaves in colours, and reflection lines.

use crate::common::{golden, shared};
use crate::{fails, folder, json};
use ash_subdiv::adaptive::{AdaptiveOptions, LeafKind};
use ash_subdiv::headless::{Headless, HeadlessOptions};
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::renderer::Evaluation;
use ash_subdiv::table::{CpuSurface, TableOptions};
use ash_subdiv::{ControlMesh, shape};
use glam::DVec3;
use image::RgbaImage;
use std::collections::BTreeMap;
use std::path::Path;

fn picture(path: &Path, arguments: &str) -> RgbaImage {
    json(&format!("render --validation {arguments} -o {}", path.display()));
    image::open(path).unwrap().to_rgba8()
}

fn words(vector: DVec3) -> String {
    format!("{},{},{}", vector.x, vector.y, vector.z)
}

/// A picture with a legend, with the point that is looked at in the middle of its middle pixel.
const SIZE: [u32; 2] = [241, 240];
const MIDDLE: [u32; 2] = [120, 95];

/// The kinds of leaves in the order of their colours.
fn kind(kind: LeafKind) -> usize {
    match kind {
        LeafKind::Regular => 0,
        LeafKind::SingleCrease { .. } => 1,
        LeafKind::Cap => 2,
    }
}

/// The colour of a kind of a level in the legend, given which kinds each level has.
fn legend_colour(pixels: &RgbaImage, kinds: &[Vec<usize>], level: usize, kind: usize) -> [u8; 4] {
    let part = |i: usize, count: usize, [from, to]: [f64; 2]| {
        let at = |i: usize| from + (to - from) * i as f64 / count as f64;
        [at(i), at(i + 1)]
    };
    let of_level = part(level, kinds.len(), [11.0, 232.0]);
    let place = kinds[level].iter().position(|&k| k == kind).unwrap();
    let [from, to] = part(place, kinds[level].len(), [of_level[0], of_level[1] - 2.0]);
    pixels.get_pixel(((from + to) / 2.0) as u32, 215).0
}

/// One leaf of each level and kind: the point in its middle, and the normal there.
fn leaves(mesh: &ControlMesh, depth: u32) -> BTreeMap<[usize; 2], [DVec3; 2]> {
    let adaptive = Some(AdaptiveOptions { depth, ..AdaptiveOptions::default() });
    let surface = CpuSurface::with_options(mesh, &TableOptions { adaptive, ..TableOptions::default() }).unwrap();
    let limit = LimitSurface::new(mesh).unwrap();
    let mut leaves = BTreeMap::new();
    let plan = surface.adaptive().unwrap();
    for leaf in &plan.leaves {
        let of_root = plan.roots[leaf.root as usize].level;
        let [u, v] = [leaf.u, leaf.v].map(|i| (f64::from(i) + 0.5) / f64::from(1 << (leaf.level - of_root)));
        let sub = if of_root == 0 { -1 } else { leaf.part as i32 };
        let sample = limit.evaluate(leaf.face, sub, u, v);
        leaves.entry([leaf.level as usize, kind(leaf.kind)]).or_insert([sample.position, sample.normal]);
    }
    leaves
}

#[test]
fn leaves_have_the_colours_of_their_level_and_kind() {
    let seen = colours_of_leaves("machine-part", &[&[0, 1], &[0, 1], &[0, 2]]);
    assert!(seen[&[0, 1]] > seen[&[0, 0]] && seen[&[1, 1]] > seen[&[1, 0]], "creases are light: {seen:?}");
    assert!(seen[&[2, 2]] < seen[&[2, 0]], "end caps are dark: {seen:?}");
    // Faces that are no quads are cut in wedges.
    colours_of_leaves("polygons", &[&[], &[0], &[0], &[0, 2]]);
}

/// The brightness of each level and kind of the leaves of a shape, which are as deep as this is long, and of these kinds.
fn colours_of_leaves(name: &str, expected: &[&[usize]]) -> BTreeMap<[usize; 2], u32> {
    let folder = folder(&format!("levels-{name}"));
    let mesh = shape(name).unwrap();
    let [low, high] = mesh.bounds();
    let depth = expected.len() - 1;
    let leaves = leaves(&mesh, depth as u32);
    let mut kinds = vec![Vec::new(); expected.len()];
    leaves.keys().for_each(|&[level, kind]| kinds[level].push(kind));
    assert_eq!(kinds, expected);
    let mut seen = BTreeMap::new();
    let evaluations: Vec<_> = Evaluation::ALL.into_iter().filter(|&e| e != Evaluation::Subdivision).collect();
    for (i, (&[level, kind], &[position, normal])) in leaves.iter().enumerate() {
        // Nothing lies between the eye and the point.
        let eye = position + 0.002 * low.distance(high) * normal;
        let (eye, target, up) = (words(eye), words(position), words(normal.any_orthonormal_vector()));
        let evaluation = evaluations[i % evaluations.len()].name();
        let arguments = format!(
            "--shape {name} --adaptive {depth} --shading levels --evaluation {evaluation} --size {}x{} --samples 1 \
             --factor 32 --eye {eye} --target {target} --up {up} --fov 5",
            SIZE[0], SIZE[1]
        );
        let pixels = picture(&folder.join("x.png"), &arguments);
        let expected = legend_colour(&pixels, &kinds, level, kind);
        let colour = pixels.get_pixel(MIDDLE[0], MIDDLE[1]).0;
        let worst = (0..4).map(|i| colour[i].abs_diff(expected[i])).max().unwrap();
        assert!(worst <= 5, "level {level}, kind {kind}, {evaluation}: {colour:?}, in the legend {expected:?}");
        seen.insert([level, kind], colour.iter().map(|&c| u32::from(c)).sum::<u32>());
    }
    seen
}

/// A flat mirror: each pixel's ray is reflected here, too.
#[test]
fn stripes_are_where_the_mirror_sees_them() {
    let folder = folder("stripes");
    let (eye, side) = (DVec3::new(0.3, 2.0, 1.1), 64);
    let normal = LimitSurface::new(&shape("single-quad").unwrap()).unwrap().evaluate(0, -1, 0.5, 0.5).normal;
    let stripes = 40.0;
    for samples in [1, 4] {
        let pixels = picture(
            &folder.join("x.png"),
            &format!(
                "--shape single-quad --shading reflection-lines --stripes {stripes} --size {side}x{side} \
                 --samples {samples} --background 255,0,0 --eye {} --target 0,0,0 --up 0,0,-1 --fov 20",
                words(eye)
            ),
        );
        let back = eye.normalize();
        let right = DVec3::NEG_Z.cross(back).normalize();
        let up = back.cross(right);
        let tan = 10_f64.to_radians().tan();
        let (mut dark, mut light) = (0, 0);
        for (x, y, pixel) in pixels.enumerate_pixels().filter(|(_, _, pixel)| pixel.0[0] != 255) {
            let at = |i: u32| (2.0 * (f64::from(i) + 0.5) / f64::from(side) - 1.0) * tan;
            let ray = (at(x) * right - at(y) * up - back).normalize();
            let reflected = ray - 2.0 * ray.dot(normal) * normal;
            let phase = (stripes * reflected.y.acos() / std::f64::consts::PI + 0.25).fract();
            // Not on the border of two stripes, where a pixel sees both.
            if (0.1..0.4).contains(&phase) {
                dark += 1;
                assert!(pixel.0[0] < 60, "{x} {y}: {pixel:?}");
            } else if (0.6..0.9).contains(&phase) {
                light += 1;
                assert!(pixel.0[0] > 150, "{x} {y}: {pixel:?}");
            }
        }
        assert!(dark > 300 && light > 300, "{dark} {light}");
    }
}

#[test]
fn reflections_follow_displacement() {
    let folder = folder("reflections");
    let [low, high] = shape("creature").unwrap().bounds();
    let (middle, diagonal) = ((low + high) / 2.0, low.distance(high));
    let (eye, target) = (words(middle + diagonal * DVec3::new(0.0, 0.0, 0.4)), words(middle));
    let draw = |scale: f64| {
        let arguments = "--shape creature --displacement scales --shading reflection-lines --stripes 4 --factor 1";
        let view = format!("--eye {eye} --target {target} --size 192x128 --displacement-scale {scale}");
        picture(&folder.join("x.png"), &format!("{arguments} {view}"))
    };
    // Hardly moved, but each scale is seen in the mirror.
    let (flat, scaly) = (draw(0.0), draw(0.001));
    let differ = flat.pixels().zip(scaly.pixels()).filter(|(a, b)| a.0[0].abs_diff(b.0[0]) > 60).count();
    // 922 by what moved alone, without the normals of the displaced surface.
    assert!(differ > 1400, "{differ}");
}

#[test]
fn errors_say_what_is_wrong() {
    let path = folder("shading-usage").join("x.png");
    for (arguments, message) in [
        ("--shading levels", "--shading levels: no face is refined: name a depth with --adaptive"),
        ("--shading levels --adaptive 2 --level 1", "--level: levels are those of patches: leave one of both out"),
        (
            "--shading levels --adaptive 2 --displacement scales",
            "--displacement: levels are not painted on a displaced surface: leave one of both out",
        ),
        ("--shading levels --adaptive 2 --size 96x64", "--size 96x64: pictures with a legend are at least 240x120"),
        ("--stripes 3", "--stripes: --shading lit has none: choose reflection-lines"),
    ] {
        fails(&format!("render --shape creature {arguments} -o {}", path.display()), 2, message);
    }
}

/// Name and arguments.
const GOLDENS: [(&str, &str); 4] = [
    ("levels", "--shape machine-part --adaptive 4 --shading levels --factor 16"),
    ("levels-creature", "--shape creature --adaptive 3 --shading levels --zoom 2.2"),
    // A vertex with twelve faces, from nearby: one patch a face, and the limit surface.
    ("reflection-lines", ""),
    ("reflection-lines-adaptive", "--adaptive 6"),
];

/// Arguments of a golden.
fn arguments(name: &str, more: &str) -> String {
    if !name.starts_with("reflection") {
        return more.to_owned();
    }
    let mesh = shape("valences").unwrap();
    let mut valences = vec![0; mesh.vertex_count()];
    mesh.data().face_vertices.iter().for_each(|&v| valences[v as usize] += 1);
    let vertex = (0..valences.len()).max_by_key(|&v| valences[v]).unwrap();
    let limit = LimitSurface::new(&mesh).unwrap();
    let around = mesh.data().face_vertices.iter().position(|&v| v == vertex as u32).unwrap();
    let [s, t] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][around % 4];
    let sample = limit.evaluate(around as u32 / 4, -1, s, t);
    let tilt = DVec3::new(-0.2, 0.0, 0.5);
    let (target, eye) = (sample.position, sample.position + 0.8 * (sample.normal + tilt).normalize());
    format!(
        "--shape valences --shading reflection-lines --stripes 16 --factor 64 --eye {} --target {} --fov 24 {more}",
        words(eye),
        words(target)
    )
}

#[test]
fn pictures_of_shadings_are_as_they_were() {
    let headless = Headless::new(&HeadlessOptions::default()).expect("a Vulkan device");
    let Some(goldens) = golden::of(&headless) else { return };
    let folder = folder("shading-goldens");
    let mut wrong = Vec::new();
    for (name, more) in GOLDENS {
        for construction in ["two-stage", "stencil"] {
            let arguments = arguments(name, more);
            let pixels = picture(
                &folder.join("x.png"),
                &format!("{arguments} --size 256x256 --samples 1 --construction {construction}"),
            );
            let (golden, writes) = (format!("cli/{name}"), construction == "two-stage");
            wrong.extend(goldens.check(&golden, construction, [256; 2], pixels.into_raw(), writes).err());
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Creases of sharpness 6 on a model that was made by hand.
#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn pictures_of_the_car_are_as_they_were() {
    let headless = Headless::new(&HeadlessOptions::default()).expect("a Vulkan device");
    let Some(goldens) = golden::of(&headless) else { return };
    let folder = folder("car-goldens");
    let car = shared().join("meshes/car.obj");
    let mut wrong = Vec::new();
    for (name, more) in [("car", "--shading lit --yaw 35 --zoom 1.6"), ("car-levels", "--shading levels --yaw -40")] {
        let arguments = format!("{} --adaptive 6 --factor 16 --size 256x256 --samples 1 {more}", car.display());
        let pixels = picture(&folder.join("x.png"), &arguments);
        wrong.extend(goldens.check(&format!("cli/{name}"), "", [256; 2], pixels.into_raw(), true).err());
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_golden_of_shadings_fails_against_every_other() {
    let goldens = GOLDENS.map(|(name, _)| golden::load(&golden::folder().join(format!("cli/{name}.png"))));
    for (i, golden) in goldens.iter().enumerate() {
        for other in &goldens[..i] {
            assert!(golden::pixels_that_differ(golden, other) > 200, "{:?}", GOLDENS[i]);
        }
    }
}
