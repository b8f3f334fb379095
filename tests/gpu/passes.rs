//! Several passes over the same models, into attachments of their own.

use crate::common;
use crate::common::passes::{Moment, PassTarget};
use crate::common::stage::with_segments;
use ash::vk;
use ash_subdiv::headless::{Headless, Offscreen, OffscreenDesc};
use ash_subdiv::renderer::{Cull, Evaluation, Factor, Fragment, VisibleItems};
use ash_subdiv::{Construction, DrawItem, Frame, ModelOptions, Options, Renderer, Style, Target, View};
use ash_subdiv::{requirements, shape};

#[allow(dead_code, reason = "other tests use the other shaders")]
mod shaders {
    include!(concat!(env!("OUT_DIR"), "/test_shaders.rs"));
}

const EXTENT: vk::Extent2D = vk::Extent2D { width: 96, height: 96 };
const BLACK: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];

/// A renderer for `main` with a style for it, and one for each of the others.
fn renderer(headless: &Headless, main: &PassTarget, others: &[&PassTarget], options: Options) -> Renderer {
    let own = others.iter().map(|other| Style { target: Some(other.target()), ..options.styles[0].clone() });
    let styles = options.styles.iter().cloned().chain(own).collect();
    // SAFETY: the targets outlive the renderer, and every submission is waited for.
    unsafe { Renderer::new(headless.context(), &main.target(), &Options { styles, ..options }) }.expect("a renderer")
}

/// Begins a frame and prepares it.
fn prepare(headless: &Headless, renderer: &mut Renderer) -> Frame {
    // SAFETY: all frames before are done.
    let frame = unsafe { renderer.begin_frame() };
    // SAFETY: the command buffer is being recorded, and submitted.
    headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) }).expect("prepared");
    frame
}

type Pictures = (Vec<Vec<u8>>, Vec<f32>);

fn draw(pass: &PassTarget, renderer: &mut Renderer, frame: Frame, view: &View, items: &[DrawItem]) -> Pictures {
    pass.draw_all(&[BLACK, GREEN], |cmd, moment| match moment {
        Moment::Before => Ok(()),
        // SAFETY: inside rendering, after the preparation.
        Moment::Inside => unsafe { renderer.cmd_draw(cmd, frame, view, items) },
    })
}

fn draw_visible(pass: &PassTarget, renderer: &mut Renderer, frame: Frame, visible: &VisibleItems) -> Vec<f32> {
    let drawn = pass.draw_all(&[BLACK, GREEN], |cmd, moment| match moment {
        Moment::Before => Ok(()),
        // SAFETY: inside rendering, after the search.
        Moment::Inside => unsafe { renderer.cmd_draw_visible(cmd, frame, visible) },
    });
    drawn.1
}

#[test]
fn depth_alone_is_drawn_as_with_colours() {
    let headless = common::headless();
    let mesh = shape("creature-mixed").expect("built in");
    let view = View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0).sized(EXTENT.width, EXTENT.height);
    for dynamic in [true, false] {
        let [shadow, main] = [0, 1].map(|colors| PassTarget::with(&headless, EXTENT, colors, dynamic));
        let evaluations = vec![Evaluation::Instanced];
        let options = Options { visible_lists: true, evaluations, ..Options::default() };
        let mut renderer = renderer(&headless, &main, &[&shadow], options);
        for (evaluation, construction, factor) in [
            (Evaluation::Tessellation, Construction::TwoStage, Factor::Pixels(4.0)),
            (Evaluation::Tessellation, Construction::Cached, Factor::Uniform(6.0)),
            (Evaluation::Compute, Construction::Cached, Factor::Uniform(6.0)),
            (Evaluation::Instanced, Construction::Cached, Factor::Uniform(6.0)),
        ] {
            let options = ModelOptions { evaluation, construction, ..ModelOptions::default() };
            let model = renderer.add_model(&mesh, &options).expect("a model");
            let factor = match factor {
                Factor::Uniform(n) => with_segments(&mut renderer, model, evaluation, n as u32),
                _ => factor,
            };
            let frame = prepare(&headless, &mut renderer);
            let item = DrawItem { cull: Cull { small: false, ..Cull::ALL }, ..DrawItem::new(model, factor) };
            let of_style = |style| DrawItem { style, cull: Cull::NONE, ..item };
            let (colors, depths) = draw(&main, &mut renderer, frame, &view, &[of_style(0)]);
            let seen = depths.iter().filter(|&&depth| depth < 1.0).count();
            assert_eq!(colors[0].chunks(4).filter(|pixel| pixel[..3] != [0; 3]).count(), seen);
            assert!(seen > 1000, "{seen}");
            let (colors, alone) = draw(&shadow, &mut renderer, frame, &view, &[of_style(1)]);
            assert!(colors.is_empty() && alone == depths, "{evaluation:?} {construction:?}, dynamic: {dynamic}");
            // One search for both.
            // SAFETY: outside rendering, after the preparation.
            let visible = headless.try_submit(|cmd| unsafe { renderer.cmd_cull(cmd, frame, &view, &[item]) });
            let visible = visible.expect("lists");
            assert!(draw_visible(&shadow, &mut renderer, frame, &visible.in_style(1)) == depths, "{evaluation:?}");
            assert!(draw_visible(&main, &mut renderer, frame, &visible) == depths, "{evaluation:?}");
        }
    }
    headless.finish_silent();
}

#[test]
fn samples_are_those_of_the_style() {
    let headless = common::headless();
    let mesh = shape("creature").expect("built in");
    let view = View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0);
    let [one, four] = [vk::SampleCountFlags::TYPE_1, vk::SampleCountFlags::TYPE_4].map(|samples| {
        let desc = OffscreenDesc { samples, ..OffscreenDesc::new(EXTENT.width, EXTENT.height) };
        (Offscreen::new(&headless, &desc).expect("images"), Target::dynamic(desc.color, desc.depth, samples))
    });
    let mut pictures = Vec::new();
    for (target, own) in [(&one.1, Some(four.1.clone())), (&four.1, None)] {
        let styles = vec![Style::default(), Style { target: own, ..Style::default() }];
        // SAFETY: every submission is waited for, so the renderer is dropped when idle.
        let renderer = unsafe { Renderer::new(headless.context(), target, &Options { styles, ..Options::default() }) };
        let mut renderer = renderer.expect("a renderer");
        let model = renderer.add_model(&mesh, &ModelOptions::default()).expect("a model");
        let frame = prepare(&headless, &mut renderer);
        let item = DrawItem { style: 1, ..DrawItem::new(model, 4.0) };
        // SAFETY: inside rendering, after the preparation.
        let record = |cmd| unsafe { renderer.cmd_draw(cmd, frame, &view, &[item]) };
        pictures.push(four.0.draw(&headless, BLACK, record).expect("a picture"));
    }
    assert!(pictures[0] == pictures[1]);
    drop((one, four));
    headless.finish_silent();
}

/// The crate's shaders have nothing to do where there is only depth; the caller's may still leave out fragments.
#[test]
fn a_callers_shader_cuts_holes_into_depth() {
    let headless = common::headless();
    let mesh = shape("creature").expect("built in");
    let pass = PassTarget::with(&headless, EXTENT, 0, true);
    let cut_out = Style { fragment: Fragment::Spirv(shaders::CUT_OUT_FRAG.to_vec()), ..Style::default() };
    let options = Options { styles: vec![Style::default(), cut_out], texcoords: true, ..Options::default() };
    let mut renderer = renderer(&headless, &pass, &[], options);
    let model = renderer.add_model(&mesh, &ModelOptions::default()).expect("a model");
    let frame = prepare(&headless, &mut renderer);
    let view = View::framing(mesh.bounds(), [0.1, 0.2, 1.0], 1.0);
    let mut covered = |style| {
        let (_, depths) = draw(&pass, &mut renderer, frame, &view, &[DrawItem { style, ..DrawItem::new(model, 4.0) }]);
        depths.into_iter().filter(|&depth| depth < 1.0).count()
    };
    let [all, cut] = [0, 1].map(&mut covered);
    assert!(cut > 0 && cut < all, "{cut} of {all}");
    drop((renderer, pass));
    headless.finish_silent();
}

/// What nothing is written to stays.
#[test]
fn attachments_that_our_shaders_do_not_know_stay() {
    let headless = common::headless();
    let mesh = shape("creature").expect("built in");
    let view = View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0);
    for dynamic in [true, false] {
        let pass = PassTarget::with(&headless, EXTENT, 2, dynamic);
        let two = Style { fragment: Fragment::Spirv(shaders::TWO_OUTPUTS_FRAG.to_vec()), ..Style::default() };
        let options = Options { styles: vec![Style::default(), two], ..Options::default() };
        assert!(requirements(&pass.target(), &options).features.independent_blend);
        let mut renderer = renderer(&headless, &pass, &[], options);
        let model = renderer.add_model(&mesh, &ModelOptions::default()).expect("a model");
        let frame = prepare(&headless, &mut renderer);
        let mut drawn =
            |style| draw(&pass, &mut renderer, frame, &view, &[DrawItem { style, ..DrawItem::new(model, 2.0) }]).0;
        let of = |picture: &[u8], color: [u8; 4]| picture.chunks(4).filter(|pixel| *pixel == color).count();
        let pixels = (EXTENT.width * EXTENT.height) as usize;
        let ours = drawn(0);
        let black = of(&ours[0], [0, 0, 0, 255]);
        assert!(black > 0 && black < pixels);
        assert_eq!(of(&ours[1], [0, 255, 0, 255]), pixels, "dynamic: {dynamic}");
        let theirs = drawn(1);
        assert_eq!(of(&theirs[0], [255, 0, 0, 255]), pixels - black);
        assert_eq!(of(&theirs[1], [0, 0, 255, 255]), pixels - black);
    }
    headless.finish_silent();
}
