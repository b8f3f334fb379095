//! The example is built and run as it stands, under the validation layer.
#![cfg(feature = "png")]

#[allow(dead_code, reason = "its `main` reads the command line, which is the test runner's here")]
#[path = "../../examples/minimal.rs"]
mod minimal;

use std::process::Command;

/// Set in the process that runs the example: where the picture goes.
const PATH: &str = "SUBDIV_TEST_EXAMPLE";

#[test]
fn minimal_draws_the_creature_and_validation_is_silent() {
    if let Ok(path) = std::env::var(PATH) {
        // SAFETY: as in the example's own `main`.
        return unsafe { minimal::draw(&path) }.expect("the example draws");
    }
    let path = concat!(env!("CARGO_TARGET_TMPDIR"), "/minimal.png");
    // The example knows nothing of validation, so the layer is put in from outside; it writes to standard output.
    let this = "example::minimal_draws_the_creature_and_validation_is_silent";
    let run = Command::new(std::env::current_exe().expect("a path"))
        .args([this, "--exact", "--nocapture"])
        .envs([(PATH, path), ("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation"), ("VK_LOADER_DEBUG", "layer")])
        // The name is `VK_KHRONOS_VALIDATION_VALIDATE_SYNC` to older layers.
        .envs([("VK_LAYER_VALIDATE_SYNC", "1"), ("VK_KHRONOS_VALIDATION_VALIDATE_SYNC", "true")])
        .output()
        .expect("this program runs");
    let [stdout, stderr] = [run.stdout, run.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(run.status.success(), "{stdout}{stderr}");
    assert!(stderr.contains("Inserted device layer \"VK_LAYER_KHRONOS_validation\""), "no validation layer: {stderr}");
    for word in ["Validation", "VUID", "SYNC-HAZARD"] {
        assert!(!stdout.contains(word), "{stdout}");
    }

    let picture = image::open(path).expect("a picture").into_rgb8();
    assert_eq!(picture.dimensions(), (1024, 768));
    let background = *picture.get_pixel(0, 0);
    let drawn = picture.pixels().filter(|&&pixel| pixel != background).count() as f64 / (1024.0 * 768.0);
    assert!((0.1..0.5).contains(&drawn), "the creature covers {drawn} of the picture");
    // Lit, so of many shades.
    let shades: std::collections::HashSet<_> = picture.pixels().map(|pixel| pixel[0]).collect();
    assert!(shades.len() > 100, "{} shades of red", shades.len());
    assert_eq!(background.0, [0.02f32, 0.02, 0.03].map(encode), "the background is as it was cleared");
}

/// sRGB, from 0 to 255, of a linear value.
fn encode(linear: f32) -> u8 {
    (255.0 * (1.055 * linear.powf(1.0 / 2.4) - 0.055)).round() as u8
}
