//! What is found out before anything is made: what a device lacks, and options that no device goes with.

use crate::common::stage::Stage;
use ash::vk;
use ash_subdiv::gpu::{Allocation, AllocationRequest, Allocator, AllocatorError, Features};
use ash_subdiv::renderer::{Fragment, Pass, ShaderId};
use ash_subdiv::{ContextOptions, DeviceContext, Error, Options, Renderer, Style, Target, check, requirements};
use std::sync::Arc;

#[allow(dead_code, reason = "other tests use the other shaders")]
mod shaders {
    include!(concat!(env!("OUT_DIR"), "/test_shaders.rs"));
}

fn target(stage: &Stage) -> Target {
    let desc = stage.target.desc();
    Target::dynamic(desc.color, desc.depth, desc.samples)
}

// Longer than a screen: a list of cases.
#[test]
fn what_a_device_lacks_is_named_at_once() {
    let stage = Stage::new();
    let (instance, device) = (stage.headless.instance(), stage.headless.physical_device());
    let mut many = target(&stage);
    many.samples = vk::SampleCountFlags::TYPE_64;
    let styles = vec![Style { line_width: 1e9, ..Style::default() }];
    let options = Options { styles, ..Options::default() };
    // SAFETY: the device is of the instance.
    let error = unsafe { check(instance, device, &many, &options) }.unwrap_err().to_string();
    let name = &stage.headless.properties().name;
    assert!(error.starts_with(&format!("{name}: missing 64 samples a pixel (it has 1, 4), lines 1000000000 pixels")));
    assert!(error.ends_with(": choose another device, or options that need less"), "{error}");
    // SAFETY: as above.
    unsafe { check(instance, device, &target(&stage), &Options::default()) }.unwrap();

    let needs = requirements(&target(&stage), &Options { styles: vec![Style::wireframe()], ..Options::default() });
    let expected =
        Features { tessellation: true, dynamic_rendering: true, fill_mode_non_solid: true, ..Features::NONE };
    assert_eq!(needs.features, expected);
    for (options, what) in [
        (Options { frames_in_flight: 0, ..Options::default() }, "frames_in_flight"),
        (Options { views_per_frame: 0, ..Options::default() }, "views_per_frame"),
    ] {
        // SAFETY: as above.
        let error = unsafe { check(instance, device, &target(&stage), &options) }.unwrap_err().to_string();
        assert_eq!(error, format!("{what} of Options is 0: it must be at least 1"));
    }
    let too_many = Options { frames_in_flight: u32::MAX, views_per_frame: u32::MAX, ..Options::default() };
    // SAFETY: as above.
    let error = unsafe { check(instance, device, &target(&stage), &too_many) }.unwrap_err();
    let told =
        "Options: frames_in_flight times views_per_frame take 18446744073709551615 bytes for views, 4294967295 are";
    assert!(error.to_string().starts_with(told), "{error}");
    // SAFETY: as above.
    let told = |target: &Target, options| unsafe { check(instance, device, target, &options) }.unwrap_err().to_string();
    let code = shaders::TEXCOORD_FRAG;
    let no_spirv = "give whole modules, as words in this machine's order of bytes (the first is 0x07230203)";
    let of_style = "fragment shaders are those of styles: set Style::fragment to Fragment::Spirv";
    for (id, code, expected) in [
        (ShaderId::ShadeLitFrag, code, format!(": {of_style}")),
        (ShaderId::EvaluateTessellationTeseAccQuad, &[], format!(" is no SPIR-V: {no_spirv}")),
    ] {
        let options = Options { shaders: vec![(id, code.to_vec())], ..Options::default() };
        assert_eq!(told(&target(&stage), options), format!("Options::shaders: {}{expected}", id.name()));
    }
    let swapped: Vec<u32> = code.iter().map(|word| word.swap_bytes()).collect();
    let [cut, cut_off] = [code.len() - 1, code.len() / 2].map(|end| code[..end].to_vec());
    for bad in [Vec::new(), code[..5].to_vec(), swapped, cut, cut_off] {
        let styles = vec![Style::default(), Style { fragment: Fragment::Spirv(bad), ..Style::default() }];
        let error = told(&target(&stage), Options { styles, ..Options::default() });
        assert_eq!(error, format!("Options::styles: Fragment::Spirv of style 1 is no SPIR-V: {no_spirv}"));
    }
    let of_styles = |code: &[u32]| {
        let styles = vec![Style { fragment: Fragment::Spirv(code.to_vec()), ..Style::default() }];
        Options { styles, ..Options::default() }
    };
    let vertex = ShaderId::ConstructControlMeshVert.code();
    assert_eq!(
        told(&target(&stage), of_styles(vertex)),
        "Options::styles: Fragment::Spirv of style 0 has no entry point `main` of its stage: compile it for that, and call its \
         function main"
    );
    let shaders = vec![(ShaderId::ConstructControlMeshVert, code.to_vec())];
    let error = told(&target(&stage), Options { shaders, ..Options::default() });
    assert!(error.starts_with("Options::shaders: construct_control_mesh_vert has no entry point"), "{error}");
    for (code, place) in [(shaders::OWN_SET_FRAG, "set 0, binding 1:"), (shaders::FAR_SET_FRAG, "set 2, binding 0:")] {
        let error = told(&target(&stage), of_styles(code));
        assert!(error.contains(&format!("no such descriptor at {place}")), "{error}");
    }
    for (samples, given) in [
        (vk::SampleCountFlags::empty(), "empty"),
        (vk::SampleCountFlags::TYPE_1 | vk::SampleCountFlags::TYPE_4, "TYPE_1 | TYPE_4"),
    ] {
        let error = told(&Target { samples, ..target(&stage) }, Options::default());
        assert_eq!(error, format!("Target::samples is {given}: give one number of samples, such as TYPE_1"));
    }
    stage.finish();
}

/// Has nothing to give.
struct NoMemory;

// SAFETY: no allocation is ever made.
unsafe impl Allocator for NoMemory {
    fn allocate(&self, _: &AllocationRequest<'_>) -> Result<Allocation, AllocatorError> {
        Err("no memory".into())
    }

    unsafe fn free(&self, _: Allocation) {}
}

#[test]
fn features_that_the_context_was_not_told_of_are_named() {
    let stage = Stage::new();
    let (instance, device) = (stage.headless.instance(), stage.headless.device());
    // SAFETY: the device is of the instance and outlives the context; nothing is made from the context.
    let told = |target: &Target| unsafe {
        let made = ContextOptions::default();
        let context = DeviceContext::new(instance, stage.headless.physical_device(), device, Arc::new(NoMemory), made);
        Renderer::new(&context, target, &Options::default()).expect_err("an error").to_string()
    };
    let error = told(&target(&stage));
    let off = "(the device has it: enable it, and name it in ContextOptions::features)";
    assert!(error.contains(&format!("missing tessellationShader {off}, dynamicRendering {off}:")), "{error}");
    let mut two = target(&stage);
    if let Pass::Dynamic { color, .. } = &mut two.pass {
        color.push(color[0]);
    }
    assert!(told(&two).contains(&format!(", independentBlend {off}:")), "{}", told(&two));
    stage.finish();
}

#[test]
fn formats_that_cannot_be_drawn_into_are_named() {
    let stage = Stage::new();
    let (instance, device) = (stage.headless.instance(), stage.headless.physical_device());
    let one = vk::SampleCountFlags::TYPE_1;
    let [color, depth] = [vk::Format::R8G8B8A8_UNORM, vk::Format::D32_SFLOAT];
    let told = |target: &Target| {
        // SAFETY: the device is of the instance.
        let checked = unsafe { check(instance, device, target, &Options::default()) };
        // SAFETY: nothing is drawn.
        let made = unsafe { Renderer::new(stage.headless.context(), target, &Options::default()) };
        let [checked, made] = [checked.unwrap_err(), made.expect_err("an error")].map(|error| error.to_string());
        assert_eq!(checked, made);
        made
    };
    let error = told(&Target::dynamic(depth, color, one));
    assert!(error.contains("D32_SFLOAT is given as the format of the colour attachment"), "{error}");
    let error = told(&Target::depth_only(color, one));
    assert!(error.contains("R8G8B8A8_UNORM is given as the format of the depth attachment"), "{error}");
    let error = told(&Target::dynamic(vk::Format::BC1_RGBA_UNORM_BLOCK, depth, one));
    assert!(error.contains("missing BC1_RGBA_UNORM_BLOCK as the format of a colour attachment"), "{error}");
    let error = told(&Target { depth: false, ..Target::dynamic(color, depth, one) });
    assert!(
        error.starts_with("Target::depth is false, but Pass::Dynamic has the format of a depth attachment"),
        "{error}"
    );
    let of_pass = Target::render_pass(vk::RenderPass::null(), 0, one);
    // SAFETY: nothing is drawn.
    let made = unsafe { Renderer::new(stage.headless.context(), &of_pass, &Options::default()) };
    let error = made.expect_err("an error").to_string();
    assert_eq!(error, "Pass::RenderPass has a null render pass: give the one that is drawn in");
    stage.finish();
}

#[test]
fn every_target_is_checked() {
    let stage = Stage::new();
    let (instance, device) = (stage.headless.instance(), stage.headless.physical_device());
    let depth_only = |samples| Target::depth_only(vk::Format::D32_SFLOAT, samples);
    let of_pass = Target::render_pass(vk::RenderPass::null(), 0, vk::SampleCountFlags::TYPE_1);
    let options = |own| Options { styles: vec![Style { target: Some(own), ..Style::default() }], ..Options::default() };
    assert!(!requirements(&of_pass, &options(of_pass.clone())).features.dynamic_rendering);
    let one = options(depth_only(vk::SampleCountFlags::TYPE_1));
    assert!(requirements(&of_pass, &one).features.dynamic_rendering);
    // SAFETY: the device is of the instance.
    let told = |own| unsafe { check(instance, device, &of_pass, &own) }.map_err(|error: Error| error.to_string());
    assert_eq!(told(one), Ok(()));
    let error = told(options(depth_only(vk::SampleCountFlags::TYPE_64))).unwrap_err();
    assert!(error.contains("missing 64 samples a pixel (it has 1, 4)"), "{error}");
    stage.finish();
}
