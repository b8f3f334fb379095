//! The goldens themselves: which there are, and that each of them sees what it is there for.
#![cfg(feature = "png")]

use crate::common::golden::{self, Goldens};
use crate::goldens::{Picture, pictures};
use ash::vk;
use std::collections::BTreeSet;
use std::path::Path;

/// The names of the pictures in a folder, not of those in folders within.
fn stems(folder: &Path) -> BTreeSet<String> {
    let files = std::fs::read_dir(folder).into_iter().flatten().map(|file| file.unwrap().path());
    files.filter(|path| path.is_file()).map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect()
}

/// A picture that passes for another one proves nothing. Also: there is a golden for each picture, and no other.
#[test]
fn every_golden_fails_against_every_other() {
    let names: BTreeSet<String> = pictures().into_iter().map(|picture| picture.name).collect();
    // The pictures of the program are in a folder there, and those of drivers.
    assert_eq!(stems(&golden::folder()), names);
    let of_driver = |(_, driver)| stems(&golden::folder().join(driver)).into_iter().map(move |name| (driver, name));
    let goldens = golden::DRIVERS.into_iter().flat_map(of_driver);
    let goldens: Vec<_> =
        goldens.map(|(driver, name)| (golden::load(&golden::path(driver, &name)), driver, name)).collect();
    for (i, (golden, driver, name)) in goldens.iter().enumerate() {
        for (other, other_driver, other_name) in goldens[..i].iter().filter(|(_, _, other)| other != name) {
            let differ = golden::pixels_that_differ(golden, other);
            // Not by the grace of a few pixels, either.
            assert!(differ > 200, "{driver}/{name} and {other_driver}/{other_name} differ in {differ} pixels only");
        }
    }
}

/// Drivers may place lines in ways of their own, and surfaces not; a line by a pixel or two, not more.
#[test]
fn goldens_of_one_driver_differ_in_lines_only() {
    let with_lines = pictures().into_iter().filter(Picture::has_lines).map(|picture| picture.name);
    let with_lines: BTreeSet<_> = with_lines.collect();
    for (_, driver) in golden::DRIVERS.into_iter().skip(1) {
        let folder = golden::folder().join(driver);
        let own = stems(&folder);
        assert_eq!(own.len(), std::fs::read_dir(folder).unwrap().count(), "pictures of the program have no lines");
        assert!(own.is_subset(&with_lines), "{driver}: {own:?}");
        for name in own {
            let [own, shared] = [driver, ""].map(|driver| golden::load(&golden::path(driver, &name)));
            let differ = golden::pixels_that_differ(&own, &shared);
            assert!((1..=2).contains(&differ), "{driver}/{name}: {differ} pixels");
        }
    }
}

/// A crack may be no more than a pixel wide and long: one fails, on every driver, in every picture, wherever it is.
#[test]
fn one_pixel_is_seen() {
    for info in golden::DRIVERS.map(|(version, _)| format!("{version}1 (LLVM 15.0.6)")) {
        let goldens = Goldens::of_driver(vk::DriverId::MESA_LLVMPIPE, &info, None).unwrap().unwrap();
        for (i, picture) in pictures().iter().enumerate() {
            let mut cracked = goldens.load(&picture.name).unwrap();
            let golden = cracked.clone();
            assert_eq!(golden::pixels_that_differ(&golden, &cracked), 0);
            let level = &mut cracked.get_pixel_mut(91 + i as u32, 90).0[i % 3];
            *level = level.checked_add(golden::TOLERANCE + 1).unwrap_or(0);
            assert_eq!(golden::pixels_that_differ(&golden, &cracked), 1, "{}", picture.name);
        }
    }
}

#[test]
fn unknown_drivers_fail_unless_told_to_skip() {
    let of = |driver, info, wish| Goldens::of_driver(driver, info, wish).map(|goldens| goldens.is_some());
    let (lavapipe, other) = (vk::DriverId::MESA_LLVMPIPE, vk::DriverId::MESA_RADV);
    assert_eq!(of(lavapipe, "Mesa 22.3.6 (LLVM 15.0.6)", None), Ok(true));
    assert_eq!(of(lavapipe, "Mesa 25.0.7-2+deb13u1 (LLVM 19.1.7)", Some("")), Ok(true));
    // What can be compared is compared.
    assert_eq!(of(lavapipe, "Mesa 25.0.7-2 (LLVM 19.1.7)", Some("skip")), Ok(true));
    for (driver, info) in [(lavapipe, "Mesa 24.1.0 (LLVM 17.0.6)"), (other, "Mesa 25.0.7")] {
        assert_eq!(of(driver, info, Some("skip")), Ok(false));
        let error = format!(
            "goldens cannot be compared on this driver ({info}): take lavapipe of Mesa 22.3.x or Mesa 25.0.x, or set \
             GOLDENS=skip"
        );
        assert_eq!(of(driver, info, None), Err(error));
    }
    let error = Err("GOLDENS=no: it is skip, or not set".to_owned());
    assert_eq!(of(lavapipe, "Mesa 22.3.6 (LLVM 15.0.6)", Some("no")), error);
}
