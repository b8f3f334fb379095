//! What a device must have for what the caller asks.

use crate::gpu::{ContextOptions, DeviceProperties, Features, aspects};
use crate::renderer::options::{Error, Fragment, Options, Pass, Target};
use crate::renderer::shader::{Fault, ShaderId, ViewData, check_spirv, has_binding, stage_storage_buffers};
use ash::vk;

/// What draws of lists need, in [`Features`].
pub(crate) const LIST_FEATURES: Features =
    Features { indirect_first_instance: true, multi_draw_indirect: true, ..Features::NONE };

/// What a device must be made with for [`Options`].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
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
    pub(crate) fn view_bytes(&self) -> u64 {
        u64::from(self.frames_in_flight).saturating_mul(self.views_per_frame.into()).saturating_mul(ViewData::STRIDE)
    }
}

/// Tells whether a physical device can do what `options` ask.
///
/// # Errors
/// [`Error::Unsupported`] names everything that is missing at once; [`Error::BadOption`], [`Error::ViewsTooLarge`],
/// [`Error::BadSamples`], [`Error::BadFormat`], [`Error::OtherDepth`], [`Error::ShaderOfStyle`], [`Error::NotSpirv`],
/// [`Error::OtherStage`], [`Error::OtherBinding`]. A render pass is not looked at: it may be null, as there is no device yet.
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
    let formats = |format| unsafe { instance.get_physical_device_format_properties(physical_device, format) };
    check_properties(&properties, properties.features, &formats, target, options)
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
    for (id, code) in &options.shaders {
        let name = id.name();
        if id.is_of_style() {
            return Err(Error::ShaderOfStyle { name });
        }
        check_shader(code, *id, options, || format!("Options::shaders: {name}"))?;
    }
    for (number, style) in options.styles.iter().enumerate() {
        if let Fragment::Spirv(code) = &style.fragment {
            let what = || format!("Options::styles: Fragment::Spirv of style {number}");
            check_shader(code, ShaderId::ShadeFlatFrag, options, what)?;
        }
    }
    targets(target, options).try_for_each(check_formats)
}

/// Checks a shader of the caller's that has the stage of one of ours.
fn check_shader(code: &[u32], like: ShaderId, options: &Options, what: impl Fn() -> String) -> Result<(), Error> {
    let own = 2..2 + options.set_layouts.len() as u32;
    let has = |set, binding, types: &[_]| if set < 2 { has_binding(set, binding, types) } else { own.contains(&set) };
    check_spirv(code, like.code(), has).map_err(|fault| match fault {
        Fault::NotSpirv => Error::NotSpirv { what: what() },
        Fault::OtherStage => Error::OtherStage { what: what() },
        Fault::OtherBinding([set, binding]) => Error::OtherBinding { what: what(), set, binding },
    })
}

/// Formats, with the names of their attachments, what they must have, and for what.
fn attachments(target: &Target) -> Vec<(vk::Format, &'static str, vk::ImageAspectFlags, vk::FormatFeatureFlags)> {
    use {vk::FormatFeatureFlags as Use, vk::ImageAspectFlags as Aspect};
    let Pass::Dynamic { color, depth, stencil } = &target.pass else { return Vec::new() };
    let colors = color.iter().map(|&format| (format, "colour", Aspect::COLOR, Use::COLOR_ATTACHMENT));
    let depths = [(*depth, "depth", Aspect::DEPTH), (*stencil, "stencil", Aspect::STENCIL)];
    let depths = depths.map(|(format, name, aspect)| (format, name, aspect, Use::DEPTH_STENCIL_ATTACHMENT));
    colors.chain(depths).filter(|(format, ..)| *format != vk::Format::UNDEFINED).collect()
}

fn check_formats(target: &Target) -> Result<(), Error> {
    let is_bad = |&(format, _, aspect, _): &(_, _, _, _)| !aspects(format).contains(aspect);
    if let Some((format, attachment, ..)) = attachments(target).into_iter().find(is_bad) {
        return Err(Error::BadFormat { format, attachment });
    }
    match target.pass {
        Pass::Dynamic { depth, .. } if target.depth != (depth != vk::Format::UNDEFINED) => {
            Err(Error::OtherDepth { depth: target.depth })
        }
        _ => Ok(()),
    }
}

/// Checks that render passes are there, which the device that they are of has made.
pub(crate) fn check_passes(target: &Target, options: &Options) -> Result<(), Error> {
    let is_null =
        |pass: &Pass| matches!(pass, Pass::RenderPass { render_pass, .. } if *render_pass == vk::RenderPass::null());
    if targets(target, options).any(|target| is_null(&target.pass)) { Err(Error::NoRenderPass) } else { Ok(()) }
}

pub(crate) fn check_properties(
    properties: &DeviceProperties,
    features: Features,
    formats: &dyn Fn(vk::Format) -> vk::FormatProperties,
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
    for (format, attachment, _, needed) in targets(target, options).flat_map(attachments) {
        if !formats(format).optimal_tiling_features.contains(needed) {
            missing.push(format!("{format:?} as the format of a {attachment} attachment"));
        }
    }
    let (least, has) = (stage_storage_buffers(), properties.max_stage_storage_buffers);
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
        let all = |_| vk::FormatProperties {
            optimal_tiling_features: vk::FormatFeatureFlags::from_raw(!0),
            ..vk::FormatProperties::default()
        };
        let error = check_properties(&properties, properties.features, &all, &target, &Options::default()).unwrap_err();
        let told = error.to_string();
        assert!(told.contains("8 storage buffers a shader stage (it has 4)"), "{told}");
    }
}
