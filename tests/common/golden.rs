//! Pictures compared with those of `tests/goldens`.

use ash::vk;
use ash_subdiv::headless::Headless;
use image::{Rgba, RgbaImage};
use std::path::{Path, PathBuf};

/// By how much a channel of a pixel may differ. No pixel may differ by more, and no mean is taken: a crack is a few pixels.
pub const TOLERANCE: u8 = 2;

/// The driver the goldens were made with: others round and rasterize in their own way.
pub const DRIVER: (vk::DriverId, &str) = (vk::DriverId::MESA_LLVMPIPE, "Mesa 22.3.");

/// Whether goldens can be compared on this device; says so if not.
pub fn is_pinned(headless: &Headless) -> bool {
    let properties = headless.properties();
    let pinned = properties.driver == DRIVER.0 && properties.driver_info.starts_with(DRIVER.1);
    if !pinned {
        let (name, info) = (&properties.name, &properties.driver_info);
        println!("goldens are not compared on {name} ({info}): they were made with {DRIVER:?}");
    }
    pinned
}

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens")
}

pub fn load(path: &Path) -> RgbaImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgba8()
}

/// Pixels that are not the same within the tolerance; all of them if the sizes differ.
pub fn pixels_that_differ(a: &RgbaImage, b: &RgbaImage) -> usize {
    if a.dimensions() != b.dimensions() {
        return a.pixels().len();
    }
    a.pixels().zip(b.pixels()).filter(|(a, b)| distance(a, b) > TOLERANCE).count()
}

fn distance(a: &Rgba<u8>, b: &Rgba<u8>) -> u8 {
    a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}

/// Compares a picture with the golden `name`. With `UPDATE_GOLDENS=1` it becomes the golden if it `writes`.
///
/// What differs is said, and is found as `<name>.<variant>.actual.png` and `.difference.png` in `target/goldens`.
pub fn check(name: &str, variant: &str, size: [u32; 2], rgba: Vec<u8>, writes: bool) -> Result<(), String> {
    assert!(size.iter().all(|&side| side <= 256), "goldens are small");
    let actual = RgbaImage::from_raw(size[0], size[1], rgba).expect("four bytes a pixel");
    let path = folder().join(name).with_extension("png");
    if writes && std::env::var_os("UPDATE_GOLDENS").is_some_and(|value| value == "1") {
        std::fs::create_dir_all(path.parent().unwrap()).expect("a folder for goldens");
        actual.save(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
    if !path.is_file() {
        return Err(format!("{name}: there is no golden: make it with UPDATE_GOLDENS=1, and look at it"));
    }
    let golden = load(&path);
    let differ = pixels_that_differ(&golden, &actual);
    if differ == 0 {
        return Ok(());
    }
    let out = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/goldens");
    let file = |what: &str| out.join(format!("{name}.{variant}.{what}.png"));
    std::fs::create_dir_all(file("actual").parent().unwrap()).expect("a folder for differences");
    actual.save(file("actual")).expect("a picture");
    let mut places = Vec::new();
    if golden.dimensions() == actual.dimensions() {
        let mut difference = RgbaImage::new(size[0], size[1]);
        for (x, y, pixel) in difference.enumerate_pixels_mut() {
            let distance = distance(golden.get_pixel(x, y), actual.get_pixel(x, y));
            // Red where it is too large; what is within the tolerance is dark.
            *pixel = match distance > TOLERANCE {
                true => Rgba([255, 255 - distance, 0, 255]),
                false => Rgba([0, 0, 40 * distance, 255]),
            };
            if distance > TOLERANCE {
                places.push((x, y, distance));
            }
        }
        difference.save(file("difference")).expect("a picture");
    }
    places.truncate(8);
    let out = file("difference");
    Err(format!(
        "{name} ({variant}): {differ} pixels differ by more than {TOLERANCE}: {places:?}.. See {}",
        out.display()
    ))
}
