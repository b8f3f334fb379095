//! The caller's own shaders, and ours.

use super::axes::ShaderKey;
use super::ids::ShaderId;
use crate::gpu::GpuError;
use crate::renderer::options::Options;
use rustc_hash::FxHashMap;

/// The caller's own shaders in the place of ours.
pub(crate) struct ShaderCode(FxHashMap<ShaderId, Vec<u32>>);

impl ShaderCode {
    pub(crate) fn new(options: &Options) -> Self {
        Self(options.shaders.iter().cloned().collect())
    }

    /// Whether a shader is the caller's own.
    pub(crate) fn is_own(&self, key: ShaderKey) -> bool {
        key.id().is_some_and(|id| self.0.contains_key(&id))
    }

    /// The SPIR-V of a shader: the caller's own, or ours.
    ///
    /// # Errors
    /// [`GpuError::BadPipeline`] names the key of a shader that is not there.
    pub(crate) fn find(&self, key: ShaderKey) -> Result<&[u32], GpuError> {
        let missing =
            || GpuError::BadPipeline { object: format!("{key:?}"), message: "there is no such shader".to_owned() };
        let id = key.canonical().id().ok_or_else(missing)?;
        Ok(self.0.get(&id).map_or(id.code(), Vec::as_slice))
    }
}
