//! What a renderer keeps of its models.

use crate::gpu::{DeviceProperties, demand};
use crate::headless::{Headless, HeadlessOptions};
use crate::mesh::{ControlMesh, shape};
use crate::renderer::pipelines::check_properties;
use crate::renderer::{Construction, Evaluation, Frame, ModelOptions, Options, Renderer, Target};
use ash::vk;

fn target() -> Target {
    Target::dynamic(vk::Format::R8G8B8A8_UNORM, vk::Format::D32_SFLOAT, vk::SampleCountFlags::TYPE_1)
}

fn renderer(headless: &Headless, options: &Options) -> Renderer {
    // SAFETY: no handles of ours are given; every submission is waited for.
    unsafe { Renderer::new(headless.context(), &target(), options) }.unwrap()
}

fn begin(renderer: &mut Renderer) -> Frame {
    // SAFETY: all frames before are done.
    unsafe { renderer.begin_frame() }
}

/// The smallest mesh that there is.
fn mesh() -> ControlMesh {
    shape("single-quad").unwrap()
}

#[test]
fn models_share_a_pool_and_give_back_their_sets() {
    let headless = Headless::new(&HeadlessOptions::default()).unwrap();
    let mut renderer = renderer(&headless, &Options { frames_in_flight: 2, ..Options::default() });
    let sets = |renderer: &Renderer| renderer.pipelines.sets.pool.usage();
    // Of each frame.
    assert_eq!(sets(&renderer), [1, 2]);
    let options =
        ModelOptions { construction: Construction::Cached, evaluation: Evaluation::Compute, ..ModelOptions::default() };
    let mut add = |options: &ModelOptions| renderer.add_model(&mesh(), options).unwrap();
    let computed = add(&options);
    let models: Vec<_> = (0..40).map(|_| add(&ModelOptions::default())).collect();
    renderer.set_segments(computed, 4).unwrap();
    assert_eq!(sets(&renderer), [2, 2 + 41 + 1]);
    renderer.set_segments(computed, 2).unwrap();
    for model in models {
        renderer.remove_model(model).unwrap();
    }
    assert_eq!(begin(&mut renderer).index(), 0);
    assert_eq!(sets(&renderer), [2, 2 + 41 + 2], "frames with index 1 may still use them");
    assert_eq!(begin(&mut renderer).index(), 1);
    assert_eq!(sets(&renderer)[1], 2 + 1 + 1);
}

#[test]
fn items_that_do_not_fit_a_frame_are_refused() {
    let headless = Headless::new(&HeadlessOptions::default()).unwrap();
    let renderer = renderer(&headless, &Options::default());
    let lists = &renderer.lists[0];
    assert_eq!(lists.grown(0, 65).unwrap(), (0, 128));
    assert_eq!(lists.grown(5000, 1).unwrap(), (8192, 64));
    assert_eq!(lists.grown(1 << 31, 1 << 23).unwrap(), (1 << 31, 1 << 23));
    let error = lists.grown(0, (1 << 23) + 1).unwrap_err().to_string();
    assert_eq!(error, "8388609 items are drawn in a frame, 8388608 at most: draw fewer");
    let error = lists.grown((1 << 31) + 1, 1).unwrap_err().to_string();
    assert_eq!(
        error,
        "lists of patches that can be seen take 2147483649 bytes in a frame, 2147483648 at most: draw fewer items"
    );
}

#[test]
fn storage_buffers_of_a_stage_are_as_many_as_check_says() {
    let headless = Headless::new(&HeadlessOptions::default()).unwrap();
    let options = Options { evaluations: Evaluation::ALL.to_vec(), visible_lists: true, ..Options::default() };
    let mut renderer = renderer(&headless, &options);
    // Its conversion has a pipeline layout of its own.
    let two_passes = ModelOptions {
        construction: Construction::Cached,
        evaluation: Evaluation::GeometryTwoPass,
        ..ModelOptions::default()
    };
    renderer.add_model(&mesh(), &two_passes).unwrap();
    let most = demand::most();
    assert!(most <= 8, "{most}");
    let check = |max_stage_storage_buffers| {
        let properties = DeviceProperties { max_stage_storage_buffers, ..headless.properties().clone() };
        let formats = |format| headless.context().format_properties(format);
        check_properties(&properties, properties.features, &formats, &target(), &options)
    };
    check(most).unwrap();
    let told = check(most - 1).unwrap_err().to_string();
    assert!(told.contains(&format!("{most} storage buffers a shader stage")), "{told}");
}
