//! Pipelines of draws and of compute, and what a device must have for them.

mod compute;
mod draw;
mod recipe;
mod requirements;
mod vertex_input;

pub(crate) use compute::{ComputePipelines, workgroups};
pub(crate) use draw::DrawPipelines;
pub(crate) use recipe::{MadeFor, Recipe, RecipeStage};
pub use requirements::{Requirements, check, requirements};
pub(crate) use requirements::{check_passes, check_properties};
pub(crate) use vertex_input::{VertexInput, vertex_bytes};
