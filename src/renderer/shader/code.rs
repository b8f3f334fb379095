//! The caller's own shaders, and ours.

use crate::gpu::{GpuError, shaders};
use crate::renderer::options::Options;
use std::collections::HashMap;

/// The caller's own shaders in the place of ours, by name.
pub(crate) struct ShaderCode(HashMap<String, Vec<u32>>);

impl ShaderCode {
    pub(crate) fn new(options: &Options) -> Self {
        Self(options.shaders.iter().cloned().collect())
    }

    /// Whether it is the caller's own.
    pub(crate) fn is_own(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// A shader by its name: the caller's own, or ours.
    pub(crate) fn find(&self, name: &str) -> Result<&[u32], GpuError> {
        self.0.get(name).map_or_else(|| shaders::named(name), |code| Ok(code))
    }
}
