//! How a model is drawn: what of it, and with which pipeline state.

use super::target::Target;
use super::view::View;
use crate::gpu::{Blend, DepthBias, DepthState};
#[cfg(doc)]
use crate::{gpu::Features, renderer::Options};
use ash::vk;

/// What of a model a [`Style`] draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Geometry {
    /// The smooth surface, through the tessellation stages.
    #[default]
    Surface,
    /// The faces of the control mesh as they are.
    ControlFaces,
    /// The edges of the control mesh, as lines.
    ControlEdges,
}

/// The fragment shader of a [`Style`].
///
/// Your own SPIR-V sees, for [`Geometry::Surface`], at location 0 the position in world space (`vec3`), at 1 the
/// normal in world space (`vec3`, not of length one; where the surface is displaced, of the surface before: see
/// `displaced_normal` in `glsl/lib/displace/displace.glsl`), and at 2 the texture coordinate (`vec2`) if [`Options::texcoords`] is
/// on or the model is displaced; for the control mesh only location 0. `glsl/lib/draw/draw.glsl` declares the view, the item
/// (`draw_colour()`, and
/// [`DrawItem::words`](crate::renderer::DrawItem::words) as `draw_words()`; define `FRAGMENT_STAGE` before you include it, to have those of
/// [instances](crate::renderer::DrawItem::instances)) and the push constants; your own
/// descriptor sets start at set 2 ([`Options::set_layouts`]).
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Fragment {
    /// One light and the sky; for [`Geometry::ControlFaces`] with the normal of each face.
    #[default]
    Lit,
    /// The normal as a colour.
    Normals,
    /// The colour of the draw as it is.
    Flat,
    /// Your own, of Vulkan 1.3 or older, with the entry point `main`. What features it needs is yours to enable, such as
    /// [`Features::terminate_invocation`] for `discard` that was compiled for Vulkan 1.3.
    Spirv(Vec<u32>),
}

/// How a model is drawn: a pipeline state. A draw names one of [`Options::styles`].
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// What of the model is drawn.
    pub geometry: Geometry,
    /// How it is shaded. Where there are no colour attachments, shaders of the crate are left out; yours may discard.
    pub fragment: Fragment,
    /// What is drawn into, if it is not what [`Renderer::new`](crate::renderer::Renderer::new) was told: other passes over the same models,
    /// such as shadows ([`Target::depth_only`]). Draws of the style are then recorded inside a rendering that fits this.
    pub target: Option<Target>,
    /// Draw triangles as lines ([`Features::fill_mode_non_solid`]).
    pub wireframe: bool,
    /// The triangles that the rasterizer culls.
    pub cull: vk::CullModeFlags,
    /// The winding of front faces in the framebuffer.
    pub front_face: vk::FrontFace,
    /// No depth test if none. Not looked at if the target has no depth.
    pub depth: Option<DepthState>,
    /// Added to the depth, such as for lines on a surface.
    pub depth_bias: Option<DepthBias>,
    /// How colours are mixed with what is there.
    pub blend: Blend,
    /// Pixels; other widths than 1 need [`Features::wide_lines`].
    pub line_width: f32,
    /// Stop before rasterization: to time the geometry alone.
    pub rasterizer_discard: bool,
}

impl Default for Style {
    /// The lit surface, seen from both sides.
    ///
    /// Front faces are `COUNTER_CLOCKWISE` in Vulkan's framebuffer (y down) when the projection flips y, as
    /// [`View`](crate::renderer::View)'s constructors do.
    fn default() -> Self {
        Self {
            geometry: Geometry::Surface,
            fragment: Fragment::Lit,
            target: None,
            wireframe: false,
            cull: vk::CullModeFlags::NONE,
            front_face: vk::FrontFace::COUNTER_CLOCKWISE,
            depth: Some(DepthState::LESS),
            depth_bias: None,
            blend: Blend::Opaque,
            line_width: 1.0,
            rasterizer_discard: false,
        }
    }
}

impl Style {
    /// Whether it culls what winds counter-clockwise as the eye sees it in space, or else what winds clockwise; none if it culls
    /// neither.
    pub(crate) fn culls_counter_clockwise(&self, view: &View) -> Option<bool> {
        match self.cull {
            vk::CullModeFlags::BACK => Some((self.front_face == vk::FrontFace::CLOCKWISE) != view.mirrored),
            vk::CullModeFlags::FRONT => Some((self.front_face == vk::FrontFace::COUNTER_CLOCKWISE) != view.mirrored),
            _ => None,
        }
    }

    /// Lines of the tessellated triangles, to be drawn over a surface.
    pub fn wireframe() -> Self {
        Self {
            fragment: Fragment::Flat,
            wireframe: true,
            depth: Some(DepthState::LESS_OR_EQUAL),
            depth_bias: Some(DepthBias { constant: -2.0, slope: -1.0 }),
            ..Self::default()
        }
    }

    /// The edges of the control mesh, over everything.
    pub fn cage() -> Self {
        Self { geometry: Geometry::ControlEdges, fragment: Fragment::Flat, depth: None, ..Self::default() }
    }

    /// What it draws into, by a renderer for `target`.
    pub(crate) fn target_or<'t>(&'t self, target: &'t Target) -> &'t Target {
        self.target.as_ref().unwrap_or(target)
    }

    /// Whether there are colour attachments that its fragment shader, one of ours, knows nothing of.
    pub(crate) fn writes_first_only(&self, target: &Target) -> bool {
        !matches!(self.fragment, Fragment::Spirv(_)) && target.render_target().color_attachments() > 1
    }
}
