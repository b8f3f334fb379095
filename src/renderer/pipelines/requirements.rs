//! What a device must have for what the caller asks.

use crate::gpu::{ContextOptions, DeviceProperties, Features};
use crate::renderer::options::{Error, Fragment, Options, Pass, Target};
use crate::renderer::shader::{ViewData, is_spirv, stage_storage_buffers};
use ash::vk;

/// What draws of lists need, in [`Features`].
pub(crate) const LIST_FEATURES: Features =
    Features { indirect_first_instance: true, multi_draw_indirect: true, ..Features::NONE };

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
    pub(crate) fn view_bytes(&self) -> u64 {
        u64::from(self.frames_in_flight).saturating_mul(self.views_per_frame.into()).saturating_mul(ViewData::STRIDE)
    }
}

/// Tells whether a physical device can do what `options` ask.
///
/// # Errors
/// [`Error::Unsupported`] names everything that is missing at once; [`Error::BadOption`], [`Error::ViewsTooLarge`],
/// [`Error::BadSamples`], [`Error::ShaderOfStyle`], [`Error::NotSpirv`].
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
    for (id, code) in &options.shaders {
        let name = id.name();
        if id.is_of_style() {
            return Err(Error::ShaderOfStyle { name });
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

pub(crate) fn check_properties(
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
        let error = check_properties(&properties, properties.features, &target, &Options::default()).unwrap_err();
        let told = error.to_string();
        assert!(told.contains("7 storage buffers a shader stage (it has 4)"), "{told}");
    }
}
