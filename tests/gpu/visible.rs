//! Patches that compute leaves out before the draws.

use crate::common;
use crate::common::stage::{Stage, begin, with_segments};
use ash_subdiv::adaptive::AdaptiveOptions;
use ash_subdiv::capture::{CaptureDraw, Captured};
use ash_subdiv::headless::{Statistics, Texels, Texture};
use ash_subdiv::renderer::{Cull, Evaluation, Factor, Fragment, VisibleItems};
use ash_subdiv::{
    Construction, ControlMesh, DrawItem, Error, Fallback, Frame, ModelId, ModelOptions, Options, Renderer, Scheme,
    Style, View, shape,
};
use glam::{Mat4, Vec3};

const BACK: Cull = Cull { back: true, ..Cull::NONE };
const FRUSTUM: Cull = Cull { frustum: true, ..Cull::NONE };

fn options() -> Options {
    Options { visible_lists: true, evaluations: vec![Evaluation::Instanced], ..Options::default() }
}

fn cached(scheme: Scheme, evaluation: Evaluation) -> ModelOptions {
    ModelOptions { evaluation, ..tessellated(scheme, Construction::Cached) }
}

fn tessellated(scheme: Scheme, construction: Construction) -> ModelOptions {
    ModelOptions { scheme, fallback: Fallback::Gregory, construction, ..ModelOptions::default() }
}

/// All of a mesh, and a part of it from near by.
fn views(mesh: &ControlMesh) -> [View; 2] {
    let [low, high] = mesh.bounds().map(|corner| corner.as_vec3());
    let (middle, radius) = ((low + high) / 2.0, (high - low).length() / 2.0);
    let eye = middle + Vec3::new(0.4, 0.3, 1.0) * (2.0 * radius);
    let target = middle + 0.5 * (high - middle);
    let near = View::perspective(eye.into(), target.into(), [0.0, 1.0, 0.0], 0.25, 1.0, [0.1 * radius, 9.0 * radius]);
    [View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0), near].map(|view| view.sized(96, 96))
}

fn cull(stage: &Stage, renderer: &mut Renderer, frame: Frame, view: &View, items: &[DrawItem]) -> VisibleItems {
    find(stage, renderer, frame, view, items).expect("lists")
}

fn find(
    stage: &Stage,
    renderer: &mut Renderer,
    frame: Frame,
    view: &View,
    items: &[DrawItem],
) -> Result<VisibleItems, Error> {
    // SAFETY: the command buffer is being recorded, outside rendering, and every submission is waited for.
    stage.headless.try_submit(|cmd| unsafe { renderer.cmd_cull(cmd, frame, view, items) })
}

fn draw(stage: &Stage, renderer: &mut Renderer, frame: Frame, visible: &VisibleItems) -> Result<Vec<u8>, Error> {
    // SAFETY: as above, inside rendering.
    let record = |cmd| unsafe { renderer.cmd_draw_visible(cmd, frame, visible) };
    stage.target.draw(&stage.headless, [0.0; 4], record)
}

fn draw_all(stage: &Stage, renderer: &mut Renderer, frame: Frame, view: &View, items: &[DrawItem]) -> Vec<u8> {
    // SAFETY: as above.
    let record = |cmd| unsafe { renderer.cmd_draw(cmd, frame, view, items) };
    stage.target.draw(&stage.headless, [0.0; 4], record).expect("a picture")
}

/// What the stages do for an item, looked through before or not.
fn count(stage: &Stage, renderer: &mut Renderer, frame: Frame, view: &View, item: DrawItem, lists: bool) -> Statistics {
    let counted = stage.headless.counted(|cmd| {
        // SAFETY: as above.
        unsafe {
            let visible = if lists { Some(renderer.cmd_cull(cmd, frame, view, &[item])?) } else { None };
            stage.target.cmd_begin(cmd, [0.0; 4]);
            match &visible {
                Some(visible) => renderer.cmd_draw_visible(cmd, frame, visible)?,
                None => renderer.cmd_draw(cmd, frame, view, &[item])?,
            }
            stage.target.cmd_end(cmd);
        }
        Ok::<(), Error>(())
    });
    counted.expect("counts")
}

fn moved(model: ModelId, factor: Factor) -> DrawItem {
    let transform = Mat4::from_scale_rotation_translation(
        Vec3::new(-0.9, 1.1, 1.0),
        glam::Quat::from_rotation_y(0.2),
        Vec3::new(0.05, -0.02, 0.0),
    );
    DrawItem { transform: transform.to_cols_array_2d(), ..DrawItem::new(model, factor) }
}

/// The control shader and the lists leave out the same patches, however edges get their factors.
#[test]
fn lists_leave_out_what_the_control_shader_does() {
    let models = [
        ("creature-mixed", Scheme::Gregory),
        ("creature", Scheme::Acc),
        ("pentagons", Scheme::Pm),
        ("cloth", Scheme::Gregory),
    ];
    let all = FACTORS.into_iter().flat_map(|factor| CULLS.map(|cull| (factor, cull)));
    leave_out_the_same(Construction::Cached, None, &models, &all.collect::<Vec<_>>());
}

/// Likewise where the lists are of control points that are made for nothing else.
#[test]
fn lists_leave_out_the_same_without_cached_points() {
    let some: Vec<_> = FACTORS.into_iter().zip(CULLS.into_iter().cycle()).collect();
    let models = [
        ("creature-mixed", Scheme::Gregory),
        ("creature", Scheme::Acc),
        ("pentagons", Scheme::Pm),
        ("machine-part", Scheme::GregoryFitted),
    ];
    leave_out_the_same(Construction::TwoStage, None, &models, &some);
    let models = [("creature-mixed", Scheme::Gregory), ("cloth", Scheme::Acc)];
    leave_out_the_same(Construction::Stencil, None, &models, &some);
}

/// Likewise of faces that are refined, which are culled by their hulls.
#[test]
fn lists_leave_out_the_same_refined_faces() {
    let adaptive = Some(AdaptiveOptions { depth: 2, ..AdaptiveOptions::default() });
    let models = [("creature-mixed", Scheme::Gregory), ("machine-part", Scheme::GregoryFitted)];
    let ways = [(FACTORS[0], FRUSTUM), (FACTORS[1], Cull::ALL)];
    leave_out_the_same(Construction::TwoStage, adaptive, &models, &ways);
}

const FACTORS: [Factor; 4] = [Factor::Uniform(6.0), Factor::Pixels(3.0), Factor::Curvature(0.3), Factor::Edges(1.0)];
const CULLS: [Cull; 3] = [BACK, FRUSTUM, Cull::ALL];

fn leave_out_the_same(
    construction: Construction,
    adaptive: Option<AdaptiveOptions>,
    models: &[(&str, Scheme)],
    ways: &[(Factor, Cull)],
) {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&options());
    for &(name, scheme) in models {
        let mesh = if name == "pentagons" { common::pentagons() } else { shape(name).expect("built in") };
        let options = ModelOptions { edge_factors: true, adaptive, ..tessellated(scheme, construction) };
        let model = renderer.add_model(&mesh, &options).expect("a model");
        let edges = renderer.tables(model).unwrap().edges().expect("asked for").vertices.len();
        let factors: Vec<f32> = (0..edges).map(|edge| 2.0 + (edge % 5) as f32).collect();
        let frame = begin(&mut renderer);
        renderer.set_edge_factors(model, frame, &factors).expect("factors");
        let mut less = 0;
        for view in views(&mesh) {
            for &(factor, cull) in ways {
                let frame = stage.frame(&mut renderer);
                let item = DrawItem { cull, ..moved(model, factor) };
                let [shader, lists] =
                    [false, true].map(|lists| count(&stage, &mut renderer, frame, &view, item, lists));
                let numbers = |s: &Statistics| (s.evaluation_invocations, s.clipping_invocations);
                assert_eq!(numbers(&lists), numbers(&shader), "{name}, {factor:?}, {cull:?}");
                let fewer = shader.control_patches - lists.control_patches;
                less += fewer;
                // Nor do corners of patches that are left out reach the vertex shader.
                let vertices = shader.input_vertices - lists.input_vertices;
                assert!(vertices >= fewer && (fewer == 0) == (vertices == 0), "{name}: {vertices}, {fewer}");
            }
        }
        // Pm-patches stay, and there are no others.
        assert_eq!(less > 0, scheme != Scheme::Pm, "{name}");
        renderer.remove_model(model).unwrap();
    }
    drop(renderer);
    stage.finish();
}

#[test]
fn pictures_stay_the_same() {
    let stage = Stage::new();
    use ash::vk::CullModeFlags as Faces;
    let styles = [Faces::BACK, Faces::FRONT].map(|cull| Style { cull, ..Style::default() });
    let mut renderer = stage.renderer(&Options { styles: styles.into(), ..options() });
    use Construction::{Cached, Stencil, TwoStage};
    for (name, scheme, shared_normals, constructions) in [
        ("creature-mixed", Scheme::Gregory, true, &[Cached, TwoStage, Stencil][..]),
        ("machine-part", Scheme::Gregory, false, &[Cached, Stencil]),
        ("machine-part", Scheme::GregoryFitted, false, &[TwoStage]),
        ("cloth", Scheme::Acc, false, &[TwoStage]),
        ("valences", Scheme::Pm, false, &[Cached, TwoStage]),
    ] {
        let mesh = shape(name).expect("built in");
        let tessellated = constructions.iter().map(|&construction| tessellated(scheme, construction));
        let instanced = constructions.contains(&Cached).then(|| cached(scheme, Evaluation::Instanced));
        for options in tessellated.chain(instanced) {
            let ModelOptions { construction, evaluation, .. } = options;
            let options = ModelOptions { shared_normals, ..options };
            let model = renderer.add_model(&mesh, &options).expect("a model");
            let factor = with_segments(&mut renderer, model, evaluation, 6);
            for (view, style) in views(&mesh).into_iter().flat_map(|view| [(view, 0), (view, 1)]) {
                let frame = stage.frame(&mut renderer);
                let item = DrawItem { cull: Cull::ALL, style, ..moved(model, factor) };
                let all = draw_all(&stage, &mut renderer, frame, &view, &[DrawItem { cull: Cull::NONE, ..item }]);
                let visible = cull(&stage, &mut renderer, frame, &view, &[item]);
                let drawn = draw(&stage, &mut renderer, frame, &visible).unwrap();
                assert!(drawn == all, "{name}, {construction:?}, {evaluation:?}, {style}");
                assert!(all.chunks(4).any(|pixel| pixel != [0; 4]));
            }
        }
    }
    // Displaced ones are moved into the picture, and have more control points than there are attributes.
    let texels = Texels { width: 1, height: 1, channels: 1, values: vec![1.0] };
    let texture = Texture::new(&stage.headless, "flat", &texels).expect("a texture");
    // SAFETY: the texture outlives the renderer.
    let displacement = Some(unsafe { renderer.add_displacement((&texture).into()) });
    let mesh = shape("creature").expect("built in");
    let instanced = cached(Scheme::Gregory, Evaluation::Instanced);
    let others = [TwoStage, Stencil].map(|construction| tessellated(Scheme::Gregory, construction));
    for options in [instanced].into_iter().chain(others) {
        let options = ModelOptions { displacement, ..options };
        let model = renderer.add_model(&mesh, &options).expect("a model");
        let factor = with_segments(&mut renderer, model, options.evaluation, 6);
        for view in views(&mesh) {
            let frame = stage.frame(&mut renderer);
            let item = DrawItem { cull: Cull::ALL, displacement: [0.2, 0.0], ..moved(model, factor) };
            let not_culled = DrawItem { cull: Cull::NONE, ..item };
            let all = draw_all(&stage, &mut renderer, frame, &view, &[not_culled]);
            let visible = cull(&stage, &mut renderer, frame, &view, &[item]);
            assert!(draw(&stage, &mut renderer, frame, &visible).unwrap() == all, "{options:?}");
            let before = count(&stage, &mut renderer, frame, &view, not_culled, false);
            let now = count(&stage, &mut renderer, frame, &view, item, true);
            assert_eq!(before.clipping_invocations > now.clipping_invocations, view == views(&mesh)[1]);
        }
    }
    drop((renderer, texture));
    stage.finish();
}

/// Instances are left out by the factors that their edges have, and only whole patches.
#[test]
fn instances_are_of_the_patches_that_are_left() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&options());
    let mesh = shape("creature-mixed").expect("built in");
    let instanced = cached(Scheme::Gregory, Evaluation::Instanced);
    let captured = Captured::new(&stage.headless, &mesh, &cached(Scheme::Gregory, Evaluation::Tessellation)).unwrap();
    let plain = renderer.add_model(&mesh, &instanced).expect("a model");
    let options = ModelOptions { edge_factors: true, ..instanced };
    let uneven = renderer.add_model(&mesh, &options).expect("a model");
    let edges = renderer.tables(uneven).unwrap().edges().expect("asked for").vertices.len();
    let frame = begin(&mut renderer);
    renderer.set_edge_factors(uneven, frame, &vec![8.0; edges]).expect("factors");
    for model in [plain, uneven] {
        renderer.set_segments(model, 8).expect("segments");
    }
    for view in views(&mesh) {
        for cull in [BACK, FRUSTUM] {
            let frame = stage.frame(&mut renderer);
            let factors = captured.factors(&CaptureDraw { view, cull, ..CaptureDraw::new(8.0) }).expect("a capture");
            let patches = captured.tables().plan().patches().iter().zip(factors).filter(|(_, f)| !f.culled);
            let triangles: u64 = patches.map(|(patch, _)| if patch.kind.corners() == 4 { 2 * 64 } else { 64 }).sum();
            for model in [plain, uneven] {
                let item = DrawItem { cull, ..DrawItem::new(model, Factor::Segments) };
                let counted = count(&stage, &mut renderer, frame, &view, item, true);
                assert_eq!(counted.clipping_invocations, triangles, "{model:?}, {cull:?}");
            }
        }
    }
    // Of edges with fewer segments less is known: nothing that they turn to the eye may be missed.
    let [view, _] = views(&mesh);
    let factors: Vec<f32> = (0..edges).map(|edge| [1.0, 8.0, 3.0][edge % 3]).collect();
    let frame = begin(&mut renderer);
    renderer.set_edge_factors(uneven, frame, &factors).expect("factors");
    stage.prepare(&mut renderer, frame);
    let item = DrawItem { cull: BACK, ..DrawItem::new(uneven, Factor::Segments) };
    let all = draw_all(&stage, &mut renderer, frame, &view, &[item]);
    let visible = cull(&stage, &mut renderer, frame, &view, &[item]);
    assert!(draw(&stage, &mut renderer, frame, &visible).unwrap() == all);
    drop((renderer, captured));
    stage.finish();
}

/// More patches than a list has room for, and more lists than there was room for at first; items that are not looked through;
/// one search for several draws.
// Longer than a screen: one course of frames.
#[test]
fn lists_grow_with_what_is_drawn() {
    let stage = Stage::new();
    let flat = Style { fragment: Fragment::Flat, ..Style::default() };
    let mut renderer = stage.renderer(&Options { styles: vec![Style::default(), flat], ..options() });
    let [creature, torus] = ["creature", "torus"].map(|name| shape(name).expect("built in"));
    let small = renderer.add_model(&creature, &cached(Scheme::Gregory, Evaluation::Tessellation)).expect("a model");
    let others = [ModelOptions::default(), cached(Scheme::Gregory, Evaluation::Compute)];
    let [two_stage, computed] = others.map(|options| renderer.add_model(&creature, &options).expect("a model"));
    renderer.set_segments(computed, 3).expect("segments");
    let options = ModelOptions { refine: 4, ..cached(Scheme::Gregory, Evaluation::Tessellation) };
    let large = renderer.add_model(&torus, &options).expect("a model");
    let instanced = ModelOptions { evaluation: Evaluation::Instanced, ..options };
    let instanced = renderer.add_model(&torus, &instanced).expect("a model");
    let stencil = ModelOptions { refine: 4, ..tessellated(Scheme::Gregory, Construction::Stencil) };
    let stencil = renderer.add_model(&torus, &stencil).expect("a model");
    renderer.set_segments(instanced, 1).expect("segments");
    // Instances have 192 bytes of each; a list takes a mebibyte at most.
    assert!(192 * renderer.tables(large).unwrap().plan().patches().len() > 2 << 20);
    let away = |x: f32| Mat4::from_translation(Vec3::new(x, 0.3, -0.4)).to_cols_array_2d();
    let item = |model, factor: Factor, x: f32| DrawItem {
        cull: Cull { small: false, ..Cull::ALL },
        transform: away(x),
        ..DrawItem::new(model, factor)
    };
    let scenes = [
        vec![item(small, 5.0.into(), 0.0)],
        vec![
            item(large, 1.0.into(), 0.0),
            item(two_stage, 3.0.into(), 0.4),
            item(computed, Factor::Segments, -0.6),
            item(small, 2.0.into(), -0.3),
            item(instanced, Factor::Segments, 0.2),
            item(stencil, 1.0.into(), -0.2),
        ],
    ];
    let mut before = 0;
    for _ in 0..3 {
        let frame = stage.frame(&mut renderer);
        let [view, near] = views(&creature);
        let views = [view, near, view];
        let visible: Vec<_> = views.iter().zip(scenes.iter().cycle()).collect();
        let mut find = |view, items| find(&stage, &mut renderer, frame, view, items).expect("lists");
        let visible: Vec<_> = visible.into_iter().map(|(view, items)| (view, items, find(view, items))).collect();
        for (view, items, visible) in visible {
            for style in [0, 1] {
                let items: Vec<_> = items.iter().map(|&item| DrawItem { cull: Cull::NONE, style, ..item }).collect();
                let all = draw_all(&stage, &mut renderer, frame, view, &items);
                let drawn = draw(&stage, &mut renderer, frame, &visible.in_style(style)).unwrap();
                assert!(drawn == all, "{frame:?}, style {style}");
            }
        }
        // Each frame has its own, and keeps them.
        let lists = renderer.memory_usage().lists;
        let patches = renderer.tables(instanced).unwrap().plan().patches().len() as u64;
        assert_eq!(lists > before + (4 + 192) * patches, before == 0 || frame.index() == 1, "{lists} bytes");
        before = lists;
    }
    // More than offsets of 32 bits reach, which takes no memory to find out.
    let frame = stage.frame(&mut renderer);
    let many = vec![item(instanced, Factor::Segments, 0.2); 400];
    let error = find(&stage, &mut renderer, frame, &views(&creature)[0], &many).unwrap_err().to_string();
    let told = error.strip_suffix(" bytes in a frame, 2147483648 at most: draw fewer items").expect(&error);
    let bytes = told.strip_prefix("lists of patches that can be seen take ").expect(&error);
    assert!(bytes.parse::<u64>().unwrap() > 400 * (4 + 192) * 32_768, "{error}");
    assert_eq!(renderer.memory_usage().lists, before);
    drop(renderer);
    stage.finish();
}

/// What was copied in the same command buffer is there for the search, also where no model computes anything else.
#[test]
fn copies_come_before_the_search() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&options());
    let mesh = shape("cube").expect("built in");
    let model = renderer.add_model(&mesh, &ModelOptions::default()).expect("a model");
    let item = DrawItem { cull: BACK, ..DrawItem::new(model, 2.0) };
    renderer.make_pipelines(model, item.factor, item.cull).expect("pipelines");
    let [view, _] = views(&mesh);
    for _ in 0..2 {
        let frame = begin(&mut renderer);
        renderer.set_positions(model, frame, &mesh.positions_f32()).expect("positions");
        // SAFETY: outside rendering, and every submission is waited for.
        let visible = stage.headless.try_submit(|cmd| unsafe {
            renderer.cmd_prepare(cmd, frame)?;
            renderer.cmd_cull(cmd, frame, &view, &[item])
        });
        let drawn = draw(&stage, &mut renderer, frame, &visible.expect("lists")).unwrap();
        assert!(drawn == draw_all(&stage, &mut renderer, frame, &view, &[item]));
    }
    drop(renderer);
    stage.finish();
}

// Longer than a screen: a list of cases on one renderer.
#[test]
fn wrong_use_is_told() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let mut renderer = stage.renderer(&options());
    let model = renderer.add_model(&mesh, &cached(Scheme::Gregory, Evaluation::Tessellation)).expect("a model");
    let [view, _] = views(&mesh);
    let frame = stage.frame(&mut renderer);
    let item = DrawItem { cull: BACK, ..DrawItem::new(model, 2.0) };
    let visible = cull(&stage, &mut renderer, frame, &view, &[item]);
    let told = |error: Error| error.to_string();
    assert_eq!(
        told(draw(&stage, &mut renderer, frame, &visible.in_style(7)).unwrap_err()),
        "style 7: Options::styles has 1"
    );
    // Preparing it again does not matter.
    stage.prepare(&mut renderer, frame);
    draw(&stage, &mut renderer, frame, &visible).expect("a picture");
    let frame = stage.frame(&mut renderer);
    assert_eq!(
        told(draw(&stage, &mut renderer, frame, &visible).unwrap_err()),
        "what can be seen was found in another frame, or by another renderer: call cmd_cull, and draw in the same frame"
    );
    let frame = stage.frame(&mut renderer);
    let visible = cull(&stage, &mut renderer, frame, &view, &[item]);
    let mut other = stage.renderer(&options());
    let of_other = stage.frame(&mut other);
    let error = draw(&stage, &mut other, of_other, &visible);
    assert!(matches!(error, Err(Error::OtherFrame)), "{error:?}");
    for (renderer, frame) in [(&mut renderer, of_other), (&mut other, frame)] {
        let error = draw(&stage, renderer, frame, &visible);
        assert!(matches!(error, Err(Error::OldFrame)), "{error:?}");
    }
    drop(other);

    // What changed between.
    let options = ModelOptions { edge_factors: true, ..cached(Scheme::Gregory, Evaluation::Instanced) };
    let uniform_grid = renderer.add_model(&mesh, &options).expect("a model");
    renderer.set_segments(uniform_grid, 8).expect("segments");
    let frame = stage.frame(&mut renderer);
    let of_uniform_grid = DrawItem { cull: BACK, ..DrawItem::new(uniform_grid, Factor::Segments) };
    let visible = cull(&stage, &mut renderer, frame, &view, &[item, of_uniform_grid]);
    renderer.set_segments(uniform_grid, 2).expect("segments");
    stage.prepare(&mut renderer, frame);
    let error = draw(&stage, &mut renderer, frame, &visible);
    assert!(matches!(error, Err(Error::OtherSegments { segments: 2, .. })), "{error:?}");
    renderer.remove_model(model).unwrap();
    let error = draw(&stage, &mut renderer, frame, &visible);
    assert!(matches!(error, Err(Error::NoSuchModel { .. })), "{error:?}");
    let model = renderer.add_model(&mesh, &cached(Scheme::Gregory, Evaluation::Tessellation)).expect("a model");
    let frame = stage.frame(&mut renderer);
    let item = DrawItem { model, ..item };

    let bad = DrawItem { factor: Factor::Uniform(0.5), ..item };
    // SAFETY: outside rendering, and every submission is waited for.
    let error =
        stage.headless.try_submit(|cmd| unsafe { renderer.cmd_cull(cmd, frame, &view, &[item, bad]) }).unwrap_err();
    assert!(told(error).contains("a tessellation factor is a number from 1 up"));
    let frame = stage.frame(&mut renderer);
    let error = (0..17).find_map(|_| find(&stage, &mut renderer, frame, &view, &[item]).err()).expect("an error");
    assert!(matches!(error, Error::TooManyViews { max: 16, .. }), "{error}");
    drop(renderer);
    // The device could, but was not asked to.
    let mut renderer = stage.renderer(&Options::default());
    let frame = stage.frame(&mut renderer);
    let error = find(&stage, &mut renderer, frame, &view, &[]);
    assert!(matches!(error, Err(Error::NoVisibleLists)), "{error:?}");
    drop(renderer);
    stage.finish();
}
