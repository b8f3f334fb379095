//! What the caller says once: where to draw, and how.

use super::style::Style;
#[cfg(doc)]
use crate::renderer::requirements;
use crate::renderer::shader::ShaderId;
use crate::table::Evaluation;
use ash::vk;

/// What the renderer is to be able to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Frames that may be on the device at once, the one that is being recorded among them.
    pub frames_in_flight: u32,
    /// Calls of [`Renderer::cmd_draw`](crate::renderer::Renderer::cmd_draw) and [`Renderer::cmd_cull`](crate::renderer::Renderer::cmd_cull) in a frame, at
    /// most.
    pub views_per_frame: u32,
    /// Draws name these by their index.
    pub styles: Vec<Style>,
    /// Give texture coordinates to the fragment stage.
    pub texcoords: bool,
    /// What models will be evaluated by, besides the tessellation stages: [`requirements`] lists what the device must have for
    /// it.
    pub evaluations: Vec<Evaluation>,
    /// Whether [`Renderer::cmd_cull`](crate::renderer::Renderer::cmd_cull) will be called: [`requirements`] lists what the device must have
    /// for it. The queue is then one that computes.
    pub visible_lists: bool,
    /// The caller's descriptor set layouts, from set 2 on.
    pub set_layouts: Vec<vk::DescriptorSetLayout>,
    /// SPIR-V in the place of the crate's own shaders, but for fragment shaders, which [`Style::fragment`] names: such as evaluation
    /// shaders with a `displace` function of your own, see `glsl/lib/displace/displace.glsl`.
    pub shaders: Vec<(ShaderId, Vec<u32>)>,
    /// Used for all pipelines; null for none.
    pub pipeline_cache: vk::PipelineCache,
}

impl Default for Options {
    /// Two frames in flight, 16 views a frame, one lit style, no texture coordinates.
    fn default() -> Self {
        Self {
            frames_in_flight: 2,
            views_per_frame: 16,
            styles: vec![Style::default()],
            texcoords: false,
            evaluations: Vec::new(),
            visible_lists: false,
            set_layouts: Vec::new(),
            shaders: Vec::new(),
            pipeline_cache: vk::PipelineCache::null(),
        }
    }
}
