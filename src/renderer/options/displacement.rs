//! The caller's displacement maps.

use ash::vk;

/// An image that says how far, or whereto, a surface is moved. See `glsl/lib/displace/displace.glsl`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplacementMap {
    /// A view of a colour image with all its mip levels.
    pub view: vk::ImageView,
    /// Trilinear, as a rule; it has to let all mip levels through.
    pub sampler: vk::Sampler,
    /// The layout the image is in when models are drawn.
    pub layout: vk::ImageLayout,
    /// Whether red, green and blue are a vector in object space; else red is a height along the normal.
    pub vectors: bool,
    /// The least and the largest value in it: what culling has to reckon with.
    pub range: [f32; 2],
}

#[cfg(feature = "headless")]
impl From<&crate::headless::Texture> for DisplacementMap {
    /// Heights if a texel is one number, else vectors.
    fn from(texture: &crate::headless::Texture) -> Self {
        Self {
            view: texture.view(),
            sampler: texture.sampler(),
            layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
            vectors: texture.channels() > 1,
            range: texture.range(),
        }
    }
}

/// Index of a displacement map of a [`Renderer`](crate::renderer::Renderer), in the order in which they were added. It is not checked
/// against another renderer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DisplacementId(pub(crate) usize);

impl DisplacementId {
    /// Of the first map that a renderer is told of: for tables that are built before there is a renderer.
    pub const FIRST: Self = Self(0);
}
