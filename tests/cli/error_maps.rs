//! Pictures of errors, with a legend.

use crate::common::golden;
use crate::{fails, folder, json};
use ash_subdiv::headless::{Headless, HeadlessOptions};
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::table::CpuSurface;
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{Scheme, shape};
use image::RgbaImage;
use serde_json::Value;
use std::path::Path;

fn picture(path: &Path, arguments: &str) -> (Value, RgbaImage) {
    let told = json(&format!("render --validation {arguments} -o {}", path.display()));
    (told, image::open(path).unwrap().to_rgba8())
}

/// A picture of the surface from nearby, with this point in the middle of its middle pixel.
const SIZE: [u32; 2] = [241, 240];
const MIDDLE: [u32; 2] = [120, 95];
/// A row through the colours of the legend, and where they start and end.
const BAR: (u32, u32, u32) = (215, 11, 229);

#[test]
fn a_point_has_the_colour_of_its_error() {
    let folder = folder("error-maps");
    // On triangles near the first corner, at (u, v) of the part around it, and where that is in the triangle.
    let (s, t) = (0.8, 0.3);
    let (to_next, to_previous) = (0.5 * s * (1.0 - t) + s * t / 3.0, 0.5 * (1.0 - s) * t + s * t / 3.0);
    for (name, kind, sub, at) in [
        ("valences", PatchKind::IrregularQuad, -1, [s, t]),
        ("fan", PatchKind::Triangle, 0, [1.0 - to_next - to_previous, to_next]),
    ] {
        let mesh = shape(name).unwrap();
        let [low, high] = mesh.bounds();
        let diagonal = low.distance(high);
        let surface = CpuSurface::new(&mesh, Scheme::Gregory, 0).unwrap();
        let (limit, points) = (LimitSurface::new(&mesh).unwrap(), surface.control_points(|p| p));
        let errors = surface.plan().range(kind).map(|patch| {
            let sample = Scheme::Gregory.evaluate(kind, &points[patch], at[0], at[1]);
            let truth = limit.evaluate(surface.plan().patches()[patch].face, sub, s, t);
            (sample, [sample.position.distance(truth.position) / diagonal, sample.normal.angle_between(truth.normal)])
        });
        let errors: Vec<_> = errors.collect();
        for (which, shading) in ["error-position", "error-normal"].into_iter().enumerate() {
            let (sample, error) = errors.iter().max_by(|a, b| a.1[which].total_cmp(&b.1[which])).unwrap();
            let eye = sample.position + 0.003 * diagonal * sample.normal;
            let ([x, y, z], [a, b, c]) = (eye.to_array(), sample.position.to_array());
            let up = sample.normal.any_orthonormal_vector();
            let top = 2.2 * error[which];
            let (told, pixels) = picture(
                &folder.join(format!("{kind:?}-{shading}.png")),
                &format!(
                    "--shape {name} --shading {shading} --error-max {top} --size {}x{} --samples 1 --factor 64 \
                     --eye {x},{y},{z} --target {a},{b},{c} --up {},{},{} --fov 5",
                    SIZE[0], SIZE[1], up.x, up.y, up.z
                ),
            );
            assert!((told["error"]["top"].as_f64().unwrap() / top - 1.0).abs() < 1e-6, "{told}");
            let (row, start, end) = BAR;
            let column = f64::from(start) + error[which] / top * f64::from(end - start);
            let expected = pixels.get_pixel(column.round() as u32, row).0;
            let seen = pixels.get_pixel(MIDDLE[0], MIDDLE[1]).0;
            let worst = (0..4).map(|i| seen[i].abs_diff(expected[i])).max().unwrap();
            assert!(worst <= 5, "{kind:?}, {shading}: {seen:?}, in the legend {expected:?}");
        }
    }
}

#[test]
fn scales_are_told_and_exact_surfaces_have_no_error() {
    let folder = folder("error-scales");
    let path = folder.join("x.png");
    let (told, _) = picture(&path, "--shape cube --shading error-normal --size 240x120");
    let (top, largest) = (told["error"]["top"].as_f64().unwrap(), told["error"]["largest"].as_f64().unwrap());
    assert!(top > 0.0 && largest > 0.5 * top, "{told}");
    let (told, pixels) = picture(&path, "--shape torus --shading error-position --size 240x120 --samples 1");
    let largest = told["error"]["largest"].as_f64().unwrap();
    assert!(largest < 1e-12 && told["error"]["top"] == 1e-6, "{told}");
    // In light and shade only: the dark colours of errors have less red than blue.
    assert!(pixels.rows().take(70).flatten().all(|pixel| pixel.0[0] >= pixel.0[2]));
    let (told, _) = picture(&path, "--shape cube --size 96x64");
    assert!(told["error"].is_null(), "{told}");
}

#[test]
fn errors_say_what_is_wrong() {
    let path = folder("error-usage").join("x.png");
    let to = format!("-o {}", path.display());
    fails(
        &format!("render --shape cube --shading error-normal --size 96x64 {to}"),
        2,
        "--size 96x64: pictures with a legend are at least 240x120",
    );
    fails(
        &format!("render --shape cube --error-max 1 {to}"),
        2,
        "--error-max: --shading lit shows no error: choose error-position or error-normal",
    );
    fails(
        &format!("render --shape cube --shading error-normal --error-max 0 {to}"),
        2,
        "invalid value '0' for '--error-max <ERROR>': it must be a number above 0",
    );
    fails(
        &format!("render --shape tetrahedron --scheme acc --shading error-normal {to}"),
        1,
        "face 0: the scheme acc has no patches for triangles: choose the scheme gregory, which has, or name it as fallback",
    );
}

/// Name and arguments.
const GOLDENS: [(&str, &str); 3] = [
    ("error-position", "--shape creature-mixed --shading error-position --error-max 0.003"),
    ("error-normal", "--shape polygons --shading error-normal --background 20,24,40"),
    ("error-acc", "--shape cube --scheme acc --shading error-normal --background transparent"),
];

#[test]
fn pictures_of_errors_are_as_they_were() {
    let headless = Headless::new(&HeadlessOptions::default()).expect("a Vulkan device");
    let Some(goldens) = golden::of(&headless) else { return };
    let folder = folder("error-goldens");
    let mut wrong = Vec::new();
    for (name, arguments) in GOLDENS {
        for construction in ["two-stage", "stencil"] {
            let path = folder.join("x.png");
            let (_, pixels) =
                picture(&path, &format!("{arguments} --size 256x256 --samples 1 --construction {construction}"));
            let (golden, writes) = (format!("cli/{name}"), construction == "two-stage");
            wrong.extend(goldens.check(&golden, construction, [256; 2], pixels.into_raw(), writes).err());
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_golden_of_errors_fails_against_every_other() {
    let goldens = GOLDENS.map(|(name, _)| golden::load(&golden::folder().join(format!("cli/{name}.png"))));
    for (i, golden) in goldens.iter().enumerate() {
        for other in &goldens[..i] {
            assert!(golden::pixels_that_differ(golden, other) > 200, "{:?}", GOLDENS[i]);
        }
    }
}
