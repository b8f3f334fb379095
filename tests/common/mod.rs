//! What several integration tests need.
#![allow(dead_code, reason = "each test binary uses its own part")]

pub mod edges;
#[cfg(all(feature = "headless", feature = "png"))]
pub mod golden;
pub mod limit;
#[cfg(feature = "headless")]
pub mod passes;
pub mod random;
#[cfg(feature = "headless")]
pub mod stage;

use ash_subdiv::{ControlMesh, Scheme};
use std::path::{Path, PathBuf};

/// The folder beside the checkout with reference data.
pub fn shared() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared")
}

/// A folder below `tests/`.
pub fn tests(folder: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests").join(folder)
}

/// The files in a folder that end so, in order.
pub fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let files = entries.map(|entry| entry.expect("a readable folder").path());
    let mut files: Vec<_> = files.filter(|file| file.extension().is_some_and(|e| e == ending)).collect();
    files.sort();
    files
}

/// The reference vectors by name: those of `tests/vectors` but [`pentagon_vector`], and all of `../shared` where that is.
pub fn vectors() -> Vec<(String, serde_json::Value)> {
    let mut paths = files(&tests("vectors"), "json");
    paths.retain(|path| path.file_stem() != Some("pentagons".as_ref()));
    if cfg!(shared) {
        paths.extend(files(&shared().join("reference/vectors"), "json"));
    }
    paths
        .into_iter()
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("a readable file");
            (path.file_stem().unwrap().to_string_lossy().into_owned(), serde_json::from_str(&text).expect("JSON"))
        })
        .collect()
}

/// Points and samples of Pm-patches, beside the tests: see its note.
pub fn pentagon_vector() -> serde_json::Value {
    serde_json::from_str(include_str!("../vectors/pentagons.json")).expect("JSON")
}

/// A closed mesh of two pentagons with quads and triangles between them.
pub fn pentagons() -> ControlMesh {
    let vector = pentagon_vector();
    let faces: Vec<Vec<u32>> = serde_json::from_value(vector["faces"].clone()).expect("faces");
    ControlMesh::new(ash_subdiv::MeshData {
        positions: serde_json::from_value(vector["positions"].clone()).expect("positions"),
        face_sizes: faces.iter().map(|face| face.len() as u32).collect(),
        face_vertices: faces.concat(),
        ..Default::default()
    })
    .expect("manifold")
}

/// Steps of refinement after which a scheme has patches for all faces: with leaves in their place, none are needed.
pub fn steps_to_patches(mesh: &ControlMesh, scheme: Scheme) -> u32 {
    u32::from(scheme.has_caps() && mesh.data().face_sizes.iter().any(|&size| size > 4))
}

/// A device that says everything that is wrong; end with `finish_silent`.
#[cfg(feature = "headless")]
pub fn headless() -> ash_subdiv::headless::Headless {
    use ash_subdiv::headless::{Headless, HeadlessOptions};
    Headless::new(&HeadlessOptions { validation: true, ..HeadlessOptions::default() }).expect("a Vulkan device")
}

/// The largest coordinate of the control points, whatever its sign: rounding is in units of it.
pub fn largest_coordinate(mesh: &ControlMesh) -> f64 {
    let [low, high] = mesh.bounds();
    low.abs().max(high.abs()).max_element()
}
