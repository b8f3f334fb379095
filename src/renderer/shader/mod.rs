//! The border to the shaders: which one draws a patch, what it reads, and the bytes of that.

use crate::patch::PatchForm;
use crate::table::Sharing;

#[allow(dead_code, reason = "what is left is for build.rs")]
mod axes;
mod code;
#[cfg(test)]
mod contraction;
mod cut;
mod gpu_data;
mod ids;
mod key;
mod layout;
pub(crate) mod names;
mod spirv;

pub(crate) use axes::{Output, ShaderKey, Source};
pub(crate) use code::ShaderCode;
pub(crate) use cut::Cut;
pub(crate) use gpu_data::{DrawConstants, ItemRecord, ViewData, displacement_flags};
pub use ids::ShaderId;
pub(crate) use key::{Capture, GeometryKey, PatchStages, PipelineKey, reads_texels};
pub(crate) use layout::{
    MODEL_BUFFERS, MODEL_TEXELS, STAGES, SetLayouts, TABLE_TEXELS, VECTOR_TEXEL, has_binding, stage_storage_buffers,
};
pub(crate) use spirv::{Fault, check_spirv, spaced, without_instances};
