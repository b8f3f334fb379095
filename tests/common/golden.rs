//! Pictures compared with those of `tests/goldens`, on the drivers that are known to draw them.
//!
//! Drivers agree on surfaces, and differ in a pixel of some lines. Such a picture has one golden more, in the folder of the driver
//! that draws it otherwise: everywhere every pixel is compared.

use ash::vk;
use ash_subdiv::headless::Headless;
use image::{Rgba, RgbaImage};
use std::path::{Path, PathBuf};

/// By how much a channel of a pixel may differ. No pixel may differ by more, and no mean is taken: a crack is a few pixels.
pub const TOLERANCE: u8 = 2;

/// The versions of Mesa's lavapipe whose pictures are compared: how each calls itself, and the folder of the goldens of its own.
/// The first has none: the goldens that all share are made with it.
pub const DRIVERS: [(&str, &str); 2] = [("Mesa 22.3.", ""), ("Mesa 25.0.", "mesa-25.0")];

/// The goldens of a driver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goldens {
    /// Of those that it does not share, in the folder of goldens.
    own: &'static str,
}

/// The goldens of this device's driver. None where the environment says to skip what cannot be compared (`GOLDENS=skip`).
///
/// # Panics
/// On every other driver: a picture that nobody looks at proves nothing.
pub fn of(headless: &Headless) -> Option<Goldens> {
    let (properties, wish) = (headless.properties(), std::env::var("GOLDENS").ok());
    let goldens = Goldens::of_driver(properties.driver, &properties.driver_info, wish.as_deref());
    let goldens = goldens.unwrap_or_else(|error| panic!("{}: {error}", properties.name));
    if goldens.is_none() {
        println!("goldens are not compared on {} ({})", properties.name, properties.driver_info);
    }
    goldens
}

impl Goldens {
    /// As [`of`], with what `GOLDENS` is set to.
    pub fn of_driver(driver: vk::DriverId, info: &str, wish: Option<&str>) -> Result<Option<Self>, String> {
        if !matches!(wish, None | Some("" | "skip")) {
            return Err(format!("GOLDENS={}: it is skip, or not set", wish.unwrap_or_default()));
        }
        let known = DRIVERS.iter().find(|(version, _)| info.starts_with(version));
        match known.filter(|_| driver == vk::DriverId::MESA_LLVMPIPE) {
            Some(&(_, own)) => Ok(Some(Self { own })),
            None if wish == Some("skip") => Ok(None),
            None => Err(format!(
                "goldens cannot be compared on this driver ({info}): take lavapipe of {}, or set GOLDENS=skip",
                DRIVERS.map(|(version, _)| format!("{version}x")).join(" or ")
            )),
        }
    }

    /// The golden `name`.
    pub fn load(self, name: &str) -> Result<RgbaImage, String> {
        let paths = [self.own, ""].map(|driver| path(driver, name));
        match paths.iter().find(|path| path.is_file()) {
            Some(path) => Ok(load(path)),
            None => Err(format!("{name}: there is no golden: make it with UPDATE_GOLDENS=1, and look at it")),
        }
    }

    /// Makes the picture the golden `name`: of all drivers if this is the first of them, else of this one if it draws
    /// something else.
    fn update(self, name: &str, actual: &RgbaImage) {
        let [shared, path] = ["", self.own].map(|driver| path(driver, name));
        let passes = |path: &Path| path.is_file() && pixels_that_differ(&load(path), actual) == 0;
        // What passes stays as it was looked at.
        if passes(&shared) {
            if path != shared {
                let _ = std::fs::remove_file(&path);
            }
            return;
        }
        if passes(&path) {
            return;
        }
        std::fs::create_dir_all(path.parent().unwrap()).expect("a folder for goldens");
        actual.save(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }

    /// Compares a picture with the golden `name`. With `UPDATE_GOLDENS=1` it becomes the golden if it `writes`.
    ///
    /// What differs is said, and is found as `<name>.<variant>.actual.png` and `.difference.png` in `target/goldens`.
    pub fn check(self, name: &str, variant: &str, size: [u32; 2], rgba: Vec<u8>, writes: bool) -> Result<(), String> {
        assert!(size.iter().all(|&side| side <= 256), "goldens are small");
        let actual = RgbaImage::from_raw(size[0], size[1], rgba).expect("four bytes a pixel");
        if writes && std::env::var_os("UPDATE_GOLDENS").is_some_and(|value| value == "1") {
            self.update(name, &actual);
        }
        let golden = self.load(name)?;
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
}

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens")
}

/// Where the golden `name` of a driver is, or if that is empty the one of all.
pub fn path(driver: &str, name: &str) -> PathBuf {
    folder().join(driver).join(name).with_extension("png")
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
