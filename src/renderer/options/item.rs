//! One model drawn once.

use super::id::ModelId;
use super::instances::Instances;
#[cfg(doc)]
use crate::renderer::{Evaluation, Renderer};
use crate::tessellator::{Cull, Factor};

/// One model drawn once, or as many times as it has instances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawItem {
    /// Which.
    pub model: ModelId,
    /// Object to world, by columns. Affine.
    pub transform: [[f32; 4]; 4],
    /// Instances, if it is drawn many times: with these in place of the transform, the colours and the words.
    pub instances: Option<Instances>,
    /// How finely it is cut.
    pub factor: Factor,
    /// Patches that are culled, where [`Evaluation::culls`]: by [`Renderer::cmd_cull`], of the tessellation stages by
    /// [`Renderer::cmd_draw`], too.
    pub cull: Cull,
    /// Index into [`Options::styles`](crate::renderer::Options::styles).
    pub style: usize,
    /// Linear RGBA of regular patches, irregular quads, triangles (those, too, that larger faces are cut in) and pentagons: in the
    /// order of [`PatchKind::ALL`](crate::topology::PatchKind::ALL).
    pub colors: [[f32; 4]; 4],
    /// For a model with a displacement map: what its values are multiplied with, and what is added then. Object space.
    pub displacement: [f32; 2],
    /// Words for your own shaders, such as the number of a material: `draw_words()` in `glsl/lib/draw/draw.glsl`.
    pub words: [u32; 4],
}

impl DrawItem {
    /// The model where it is, in the first style, in light grey.
    pub fn new(model: ModelId, factor: impl Into<Factor>) -> Self {
        Self {
            model,
            transform: glam::Mat4::IDENTITY.to_cols_array_2d(),
            instances: None,
            factor: factor.into(),
            cull: Cull::NONE,
            style: 0,
            colors: [[0.7, 0.7, 0.7, 1.0]; 4],
            displacement: [0.0; 2],
            words: [0; 4],
        }
    }

    /// All patches in one colour.
    pub fn color(self, color: [f32; 4]) -> Self {
        Self { colors: [color; 4], ..self }
    }
}
