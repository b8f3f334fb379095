//! Tests that need no Vulkan device, but for one of `edge_normals`.

mod adaptive;
mod adaptive_limit;
mod adaptive_neighbours;
mod adaptive_pieces;
mod adaptive_twin;
#[path = "../common/mod.rs"]
mod common;
mod dice;
mod dice_closed;
mod dice_edits;
mod dice_tolerance;
mod edge_normals;
mod edits;
mod error;
mod exactness;
mod face_varying;
mod fallback;
mod fitted;
#[cfg(all(feature = "gltf", feature = "exr", feature = "headless"))]
mod fuzzed;
mod large;
mod limit;
mod limit_reference;
mod limit_surface;
mod limits;
mod pentagons;
mod properties;
mod reader_properties;
mod readers;
mod records;
mod repair;

mod schemes;
mod topology;
mod twin_comments;
mod vectors;
mod wedges;
