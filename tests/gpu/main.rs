//! Tests that need a Vulkan device: one program, so that less is linked and every core has work.
#![cfg(feature = "headless")]

mod adaptive;
mod batches;
mod bench;
mod checks;
#[path = "../common/mod.rs"]
mod common;
mod compute;
mod culled_pictures;
mod device_limits;
mod device_positions;
mod example;
mod frames;
mod golden_files;
mod goldens;
mod headless;
mod instances;
mod leaves;
mod module;
mod passes;
mod refusals;
mod screen;
mod seams;
mod sharpness;
mod subdivision;
mod tessellator;
mod twins;
mod uniform_grid_pictures;
mod uniform_grids;
mod visible;
mod watertight;
