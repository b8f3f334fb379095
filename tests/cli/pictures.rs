//! Pictures that `subdiv render` draws.

use crate::{folder, json};
use ash_subdiv::renderer::Evaluation;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The pixels of a picture that was drawn with these further arguments.
fn picture(path: &Path, arguments: &str) -> (Value, image::RgbaImage) {
    let told = json(&format!("render --validation --size 96x64 {arguments} -o {}", path.display()));
    (told, image::open(path).unwrap().to_rgba8())
}

#[test]
fn pictures_in_every_shading() {
    let folder = folder("shadings");
    let mut seen = Vec::new();
    for shading in ["lit", "normals", "patches", "wireframe", "cage", "control-mesh", "reflection-lines"] {
        let path = folder.join(format!("{shading}.png"));
        let (told, pixels) =
            picture(&path, &format!("--shape creature-mixed --shading {shading} --background 9,20,200"));
        assert_eq!(told["file"], path.to_str().unwrap());
        assert_eq!((&told["size"], &told["shading"]), (&serde_json::json!([96, 64]), &shading.into()));
        assert_eq!((&told["factor"], &told["samples"]), (&8.0.into(), &4.into()));
        assert!(told["patches"]["triangle"].as_u64().unwrap() > 0 && told["device"].is_string());
        assert_eq!(pixels.dimensions(), (96, 64));
        assert_eq!(pixels.get_pixel(0, 0).0, [9, 20, 200, 255]);
        assert!(!seen.contains(&pixels), "{shading}");
        seen.push(pixels);
    }
    // Nothing but the pictures: no half-written files.
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 7);
}

#[test]
fn constructions_draw_the_same_and_options_are_obeyed() {
    let folder = folder("options");
    let draw = |arguments: &str| picture(&folder.join("x.png"), &format!("--shape creature {arguments}")).1;
    let base = draw("");
    let differing = |other: &image::RgbaImage| base.pixels().zip(other.pixels()).filter(|(a, b)| a != b).count();
    assert!(differing(&draw("--construction stencil")) < 20);
    // Subdivision has --level.
    for evaluation in Evaluation::ALL.iter().filter(|&&e| e != Evaluation::Subdivision).map(|e| e.name()) {
        let (told, pixels) =
            picture(&folder.join("x.png"), &format!("--shape creature --evaluation {evaluation} --factor 7.5"));
        assert!(differing(&pixels) < 20 && told["evaluation"] == evaluation, "{evaluation}");
    }
    for other in ["--factor 1", "--samples 1", "--yaw 40", "--pitch -5", "--zoom 2", "--fov 60", "--up 0,0,1"] {
        assert!(differing(&draw(other)) > 20, "{other}");
    }
    // Seen from far away through a narrow angle, the target is in the middle.
    let far = draw("--eye -60,1,50 --target 0,1,0 --fov 3");
    assert_ne!(far.get_pixel(48, 32), far.get_pixel(0, 0));
    let beside = draw("--eye -60,1,50 --target 30,1,0 --fov 3");
    assert!(beside.pixels().all(|pixel| pixel == beside.get_pixel(0, 0)));
    for (name, kind) in [("equal", "equal"), ("odd", "odd"), ("even", "even")] {
        let path = folder.join("s.png");
        let (told, _) = picture(&path, &format!("--shape cube --factor 3.5 --spacing {name}"));
        assert_eq!((&told["spacing"], &told["factor"]), (&kind.into(), &3.5.into()));
    }
}

#[test]
fn faces_are_subdivided() {
    let path = folder("levels").join("x.png");
    let mut seen = Vec::new();
    for level in 0..=3 {
        let (told, pixels) = picture(&path, &format!("--shape cube --level {level}"));
        assert_eq!((&told["level"], &told["factor"]), (&level.into(), &f64::from(1 << level).into()));
        let covered = pixels.pixels().filter(|&pixel| pixel != pixels.get_pixel(0, 0)).count();
        seen.push(covered);
    }
    // The cube shrinks towards its surface.
    assert!(seen[0] > seen[1] && seen[1] > seen[2] && seen[2] >= seen[3], "{seen:?}");
}

#[test]
fn kinds_of_patches_have_their_colours() {
    let folder = folder("kinds");
    // Gold is more red than blue, purple more blue than green, green more green than red.
    type Is = fn([u8; 4]) -> bool;
    let kinds: [(&str, Is); 3] = [
        ("torus", |[r, _, b, _]| r > b && b < 110),
        ("cube", |[_, g, b, _]| b > g),
        ("tetrahedron", |[r, g, _, _]| g > r),
    ];
    for (shape, is) in kinds {
        let (_, pixels) = picture(&folder.join("x.png"), &format!("--shape {shape} --shading patches --samples 1"));
        let background = *pixels.get_pixel(0, 0);
        let mut drawn = pixels.pixels().filter(|pixel| **pixel != background).peekable();
        assert!(drawn.peek().is_some() && drawn.all(|pixel| is(pixel.0)), "{shape}");
    }
}

#[test]
fn transparent_pictures_keep_their_colours_at_the_rim() {
    // A square seen from the front: one normal, one colour, wherever it covers a part of a pixel.
    let folder = folder("transparent");
    let (_, pixels) = picture(
        &folder.join("x.png"),
        "--shape single-quad --shading normals --background transparent --yaw 7 --pitch 40",
    );
    let full = *pixels.pixels().find(|pixel| pixel.0[3] == 255).unwrap();
    let partial: Vec<_> = pixels.pixels().filter(|pixel| ![0, 255].contains(&pixel.0[3])).collect();
    assert!(!partial.is_empty() && pixels.get_pixel(0, 0).0 == [0; 4]);
    for pixel in partial {
        let worst = (0..3).map(|c| pixel.0[c].abs_diff(full.0[c])).max().unwrap();
        assert!(worst <= 3, "{pixel:?} {full:?}");
    }
}
