//! All that needs a Vulkan device: one program, so that little is linked twice and both cores have work.
#![cfg(feature = "headless")]

mod batches;
mod bench;
#[path = "../common/mod.rs"]
mod common;
mod compute;
mod device_limits;
mod example;
mod goldens;
mod headless;
mod module;
mod screen;
mod seams;
mod subdivision;
mod twins;
mod watertight;
