//! What is drawn into.

use crate::gpu::RenderTarget;
use ash::vk;

/// What is drawn into: by all styles of a renderer, but those that have their own ([`Style::target`](crate::renderer::Style::target)).
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// The rendering that is open when draws are recorded.
    pub pass: Pass,
    /// Samples a pixel.
    pub samples: vk::SampleCountFlags,
    /// What the values in the colour attachment mean.
    pub encoding: ColorEncoding,
    /// Whether there is a depth attachment; without one nothing is hidden by what lies in front.
    pub depth: bool,
}

/// What the values that our fragment shaders write mean. Your own shaders write what they like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum ColorEncoding {
    /// Linear light: for sRGB formats, which encode by themselves, and for high dynamic range.
    #[default]
    Linear,
    /// sRGB, encoded by the shader: for formats such as `R8G8B8A8_UNORM` that are shown as sRGB. Blending is then not
    /// linear.
    Srgb,
}

/// The rendering that [`Renderer::cmd_draw`](crate::renderer::Renderer::cmd_draw) is recorded in: without multiview, as the shaders know one
/// view. Draw several, each into its own layer.
///
/// Of several colour attachments the crate's own fragment shaders write to the first, and the others stay as they are
/// ([`Features::independent_blend`](crate::gpu::Features::independent_blend)); yours ([`Fragment::Spirv`](crate::renderer::Fragment::Spirv))
/// write to all.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Pass {
    /// `vkCmdBeginRendering` with these formats; `UNDEFINED` where there is no such attachment.
    Dynamic {
        /// Of each colour attachment.
        color: Vec<vk::Format>,
        /// Of the depth attachment.
        depth: vk::Format,
        /// Of the stencil attachment. The crate does not test or write stencils.
        stencil: vk::Format,
    },
    /// A subpass that has this many colour attachments. The render pass must live as long as the renderer.
    RenderPass {
        /// The render pass, or one compatible with it.
        render_pass: vk::RenderPass,
        /// Its subpass that is drawn in.
        subpass: u32,
        /// How many colour attachments the subpass has.
        color_attachments: u32,
    },
}

impl Target {
    /// Dynamic rendering into one colour attachment and one for depth.
    pub fn dynamic(color: vk::Format, depth: vk::Format, samples: vk::SampleCountFlags) -> Self {
        let pass = Pass::Dynamic { color: vec![color], depth, stencil: vk::Format::UNDEFINED };
        Self { pass, samples, encoding: ColorEncoding::Linear, depth: depth != vk::Format::UNDEFINED }
    }

    /// Dynamic rendering into an attachment for depth alone, such as of shadows.
    pub fn depth_only(depth: vk::Format, samples: vk::SampleCountFlags) -> Self {
        let pass = Pass::Dynamic { color: Vec::new(), depth, stencil: vk::Format::UNDEFINED };
        Self { pass, samples, encoding: ColorEncoding::Linear, depth: true }
    }

    /// A subpass with one colour attachment and one for depth.
    pub fn render_pass(render_pass: vk::RenderPass, subpass: u32, samples: vk::SampleCountFlags) -> Self {
        let pass = Pass::RenderPass { render_pass, subpass, color_attachments: 1 };
        Self { pass, samples, encoding: ColorEncoding::Linear, depth: true }
    }

    /// What pipelines are made for.
    pub(crate) fn render_target(&self) -> RenderTarget<'_> {
        match &self.pass {
            Pass::Dynamic { color, depth, stencil } => {
                RenderTarget::Dynamic { color, depth: *depth, stencil: *stencil }
            }
            &Pass::RenderPass { render_pass, subpass, color_attachments } => {
                RenderTarget::RenderPass { render_pass, subpass, color_attachments }
            }
        }
    }
}
