//! What the caller says once: where to draw, and how.

use super::bindings::MODEL_BUFFERS;
use super::gpu_data::ViewData;
use super::stages::is_spirv;
use super::visible::LIST_FEATURES;
use super::{Error, Evaluation, Pass, Target, View};
use crate::gpu::{Blend, ContextOptions, DepthBias, DepthState, DeviceProperties, Features, shaders};
use ash::vk;
use glam::Mat4;

/// How the names of shaders start that [`Style::fragment`] chooses from.
pub(super) const STYLE_SHADERS: &str = "SHADE_";

/// What of a model a [`Style`] draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
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
/// `displaced_normal` in `glsl/lib/displace.glsl`), and at 2 the texture coordinate (`vec2`) if [`Options::texcoords`] is
/// on or the model is displaced; for the control mesh only location 0. Set 0, binding 0 and the push constants are
/// those of `glsl/lib/draw.glsl`; your own descriptor sets start at set 2
/// ([`Options::set_layouts`]).
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
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
    /// What is drawn into, if it is not what [`Renderer::new`](super::Renderer::new) was told: other passes over the same models,
    /// such as shadows ([`Target::depth_only`]). Draws of the style are then recorded inside a rendering that fits this.
    pub target: Option<Target>,
    /// Draw triangles as lines ([`Features::fill_mode_non_solid`]).
    pub wireframe: bool,
    /// The faces that are left out.
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
    /// [`View`](super::View)'s constructors do.
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
    /// Whether it leaves out what winds counter-clockwise as the eye sees it in space, of a surface with this transform; else what
    /// winds clockwise. If it leaves out neither: the inside.
    pub(super) fn leaves_out_counter_clockwise(&self, transform: &[[f32; 4]; 4], view: &View) -> bool {
        match self.cull {
            vk::CullModeFlags::BACK => (self.front_face == vk::FrontFace::CLOCKWISE) != view.mirrored,
            vk::CullModeFlags::FRONT => (self.front_face == vk::FrontFace::COUNTER_CLOCKWISE) != view.mirrored,
            _ => Mat4::from_cols_array_2d(transform).determinant() < 0.0,
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
    pub(super) fn target_or<'t>(&'t self, target: &'t Target) -> &'t Target {
        self.target.as_ref().unwrap_or(target)
    }

    /// Whether there are colour attachments that its fragment shader, one of ours, knows nothing of.
    pub(super) fn writes_first_only(&self, target: &Target) -> bool {
        !matches!(self.fragment, Fragment::Spirv(_)) && target.render_target().color_attachments() > 1
    }
}

/// What the renderer is to be able to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Frames that may be on the device at once: frame indices run from 0 to one less.
    pub frames_in_flight: u32,
    /// Calls of [`Renderer::cmd_draw`](super::Renderer::cmd_draw) and [`Renderer::cmd_cull`](super::Renderer::cmd_cull) in a frame, at
    /// most.
    pub views_per_frame: u32,
    /// Draws name these by their index.
    pub styles: Vec<Style>,
    /// Give texture coordinates to the fragment stage.
    pub texcoords: bool,
    /// What models will be evaluated by, besides the tessellation stages: [`requirements`] lists what the device must have for
    /// it.
    pub evaluations: Vec<Evaluation>,
    /// Whether [`Renderer::cmd_cull`](super::Renderer::cmd_cull) will be called: [`requirements`] lists what the device must have
    /// for it. The queue is then one that computes.
    pub visible_lists: bool,
    /// The caller's descriptor set layouts, from set 2 on.
    pub set_layouts: Vec<vk::DescriptorSetLayout>,
    /// SPIR-V to use in the place of the crate's own, by the name of what it replaces (as in [`crate::gpu::shaders`]), but for
    /// fragment shaders, which [`Style::fragment`] names: such as evaluation shaders with a `displace` function of your own, see
    /// `glsl/lib/displace.glsl`.
    pub shaders: Vec<(String, Vec<u32>)>,
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

/// What a device must be made with for [`Options`].
#[derive(Debug, Clone, PartialEq)]
pub struct Requirements {
    /// The lowest version of Vulkan, for the instance and the device.
    pub api_version: u32,
    /// The features to enable; [`Features::chain`] makes the structures for `vkCreateDevice`.
    pub features: Features,
    /// Device extensions to enable: none so far.
    pub device_extensions: Vec<&'static std::ffi::CStr>,
}

impl Requirements {
    /// What [`DeviceContext::new`](crate::DeviceContext::new) is told of a device made with these requirements.
    pub fn context_options(&self) -> ContextOptions {
        ContextOptions { features: self.features, ..ContextOptions::default() }
    }
}

/// The renderer's, and those that styles have of their own.
fn targets<'t>(target: &'t Target, options: &'t Options) -> impl Iterator<Item = &'t Target> {
    std::iter::once(target).chain(options.styles.iter().filter_map(|style| style.target.as_ref()))
}

/// What a device must be made with; ask before creating it.
///
/// `maintenance4` is not among it, but enable that as well, which every device with Vulkan 1.3 has: or validation layers warn of
/// outputs that the next stage does not read, such as what invocations of a control shader tell each other.
pub fn requirements(target: &Target, options: &Options) -> Requirements {
    let features = Features {
        tessellation: true,
        dynamic_rendering: targets(target, options).any(|t| matches!(t.pass, Pass::Dynamic { .. })),
        fill_mode_non_solid: options.styles.iter().any(|s| s.wireframe),
        wide_lines: options.styles.iter().any(|s| s.line_width != 1.0),
        independent_blend: options.styles.iter().any(|s| s.writes_first_only(s.target_or(target))),
        ..if options.visible_lists { LIST_FEATURES } else { Features::NONE }
    };
    let features = options.evaluations.iter().fold(features, |all, evaluation| all.union(evaluation.features()));
    Requirements { api_version: vk::API_VERSION_1_3, features, device_extensions: features.extensions() }
}

impl Options {
    /// Bytes of what shaders know of the views of all frames.
    pub(super) fn view_bytes(&self) -> u64 {
        u64::from(self.frames_in_flight).saturating_mul(self.views_per_frame.into()).saturating_mul(ViewData::STRIDE)
    }
}

/// Tells whether a physical device can do what `options` ask.
///
/// # Errors
/// [`Error::Unsupported`] names everything that is missing at once; [`Error::BadOption`], [`Error::ViewsTooLarge`],
/// [`Error::BadSamples`], [`Error::NoSuchShader`], [`Error::NotSpirv`].
///
/// # Safety
/// `physical_device` comes from `instance`, whose version is at least 1.1.
pub unsafe fn check(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    target: &Target,
    options: &Options,
) -> Result<(), Error> {
    // SAFETY: as the caller promises.
    let properties = unsafe { DeviceProperties::query(instance, physical_device) };
    check_properties(&properties, properties.features, target, options)
}

/// What no device could do.
fn check_options(target: &Target, options: &Options) -> Result<(), Error> {
    for (what, given) in [("frames_in_flight", options.frames_in_flight), ("views_per_frame", options.views_per_frame)]
    {
        if given == 0 {
            return Err(Error::BadOption { what, given });
        }
    }
    // Offsets are of 32 bits.
    let (bytes, max) = (options.view_bytes(), u32::MAX.into());
    if bytes > max {
        return Err(Error::ViewsTooLarge { bytes, max });
    }
    let mut samples = targets(target, options).map(|target| target.samples);
    if let Some(given) = samples.find(|samples| samples.as_raw().count_ones() != 1) {
        return Err(Error::BadSamples { given });
    }
    for (name, code) in &options.shaders {
        if shaders::find(name).is_none() || name.starts_with(STYLE_SHADERS) {
            return Err(Error::NoSuchShader { name: name.clone() });
        }
        if !is_spirv(code) {
            return Err(Error::NotSpirv { what: format!("Options::shaders: {name}") });
        }
    }
    for (number, style) in options.styles.iter().enumerate() {
        if matches!(&style.fragment, Fragment::Spirv(code) if !is_spirv(code)) {
            return Err(Error::NotSpirv { what: format!("Options::styles: Fragment::Spirv of style {number}") });
        }
    }
    Ok(())
}

pub(super) fn check_properties(
    properties: &DeviceProperties,
    features: Features,
    target: &Target,
    options: &Options,
) -> Result<(), Error> {
    check_options(target, options)?;
    let needed = requirements(target, options);
    let off = "(the device has it: enable it, and name it in ContextOptions::features)";
    let lacking = properties.features.missing(needed.features);
    let name = |name| if lacking.contains(&name) { String::from(name) } else { format!("{name} {off}") };
    let mut missing: Vec<String> = features.missing(needed.features).into_iter().map(name).collect();
    if properties.api_version < needed.api_version {
        let version = properties.api_version;
        let (major, minor) = (vk::api_version_major(version), vk::api_version_minor(version));
        missing.push(format!("Vulkan 1.3 (it has {major}.{minor})"));
    }
    let mut counts: Vec<u32> = targets(target, options).map(|target| target.samples.as_raw()).collect();
    counts.sort_unstable();
    counts.dedup();
    counts.retain(|&count| !properties.sample_counts.contains(vk::SampleCountFlags::from_raw(count)));
    for count in counts {
        let has: Vec<String> = properties.sample_counts().iter().map(u32::to_string).collect();
        missing.push(format!("{count} samples a pixel (it has {})", has.join(", ")));
    }
    // A list of patches besides; evaluation by compute has its vertices, too.
    let (least, has) = (MODEL_BUFFERS as u32 + 2, properties.max_stage_storage_buffers);
    if has < least {
        missing.push(format!("{least} storage buffers a shader stage (it has {has})"));
    }
    let [thinnest, widest] = properties.line_widths;
    let widths = options.styles.iter().map(|style| style.line_width);
    for width in widths.filter(|width| *width != 1.0 && !(thinnest..=widest).contains(width)) {
        missing.push(format!("lines {width} pixels wide (it has {thinnest} to {widest})"));
    }
    if missing.is_empty() { Ok(()) } else { Err(Error::Unsupported { device: properties.name.clone(), missing }) }
}

#[cfg(all(test, feature = "headless"))]
mod tests {
    use super::*;
    use crate::headless::{Headless, HeadlessOptions};

    #[test]
    fn limits_that_are_too_low_are_named() {
        let headless = Headless::new(&HeadlessOptions::default()).unwrap();
        let properties =
            DeviceProperties { name: "small".into(), max_stage_storage_buffers: 4, ..headless.properties().clone() };
        let target = Target::dynamic(vk::Format::R8G8B8A8_UNORM, vk::Format::D32_SFLOAT, vk::SampleCountFlags::TYPE_1);
        let error = check_properties(&properties, properties.features, &target, &Options::default()).unwrap_err();
        let told = error.to_string();
        assert!(told.contains("15 storage buffers a shader stage (it has 4)"), "{told}");
    }
}
