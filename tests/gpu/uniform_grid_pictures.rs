//! What every evaluation on a uniform grid draws: the pictures of the tessellation stages.

use crate::common::stage::{Stage, begin, with_segments};
use crate::uniform_grids::ways;
use ash::vk;
use ash_subdiv::renderer::{Evaluation, Factor, Fragment, Geometry};
use ash_subdiv::{Construction, DrawItem, ModelOptions, Options, Renderer, Scheme, Style, shape};
use glam::{Mat4, Vec3};

mod test_shaders {
    #![allow(dead_code, reason = "each test takes those that it needs")]
    include!(concat!(env!("OUT_DIR"), "/test_shaders.rs"));
}

/// Whether pictures are the same within rounding, and show something.
fn assert_same(a: &[u8], b: &[u8], what: &str) {
    let differ = a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 2).count();
    assert!(a.iter().any(|&x| x > 0) && differ == 0, "{what}: {differ}");
}

#[test]
fn pictures_follow_positions_and_segments() {
    let stage = Stage::new();
    let mesh = shape("creature").expect("built in");
    // Texture coordinates as colours, from the front only.
    let fragment = Fragment::Spirv(test_shaders::TEXCOORD_FRAG.to_vec());
    let cull = vk::CullModeFlags::BACK;
    let styles = vec![Style { fragment, cull, ..Style::default() }, Style::default()];
    let mut renderer = stage.renderer(&Options { texcoords: true, styles, ..Options::default() });
    let tessellated = renderer.add_model(&mesh, &ModelOptions::default()).expect("a model");
    let models: Vec<_> = ways(Scheme::Gregory)
        .map(|options| (renderer.add_model(&mesh, &options).expect("a model"), options.evaluation))
        .collect();
    let small: Vec<_> = mesh.positions_f32().iter().map(|p| p.map(|x| 0.5 * x)).collect();
    for (n, moves) in [(4, false), (4, true), (9, false), (9, true), (1, true), (3, false), (16, false)] {
        let frame = begin(&mut renderer);
        for &(model, evaluation) in &models {
            if evaluation.needs_segments() {
                renderer.set_segments(model, n).unwrap();
            }
        }
        if moves {
            let positions = if frame.index() == 1 { &small } else { &mesh.positions_f32() };
            for model in models.iter().map(|(model, _)| *model).chain([tessellated]) {
                renderer.set_positions(model, frame, positions).unwrap();
            }
        }
        stage.prepare(&mut renderer, frame);
        for style in 0..2 {
            let mut picture = |model, evaluation: Evaluation| {
                let factor = if evaluation.needs_segments() { Factor::Segments } else { Factor::Uniform(n as f32) };
                let item = DrawItem { style, ..DrawItem::new(model, factor) };
                stage.draw(&mut renderer, frame, &[item]).expect("a picture")
            };
            let expected = picture(tessellated, Evaluation::Tessellation);
            for &(model, evaluation) in &models {
                assert_same(&picture(model, evaluation), &expected, &format!("{evaluation:?}: {n} in {frame:?}"));
            }
        }
    }
    drop(renderer);
    stage.finish();
}

/// Lines tell: also of what is hidden, and of what faces away.
#[test]
fn triangles_are_those_of_the_tessellation_stages() {
    let stage = Stage::new();
    let inside = Style { cull: vk::CullModeFlags::FRONT, ..Style::wireframe() };
    let styles = vec![Style::default(), Style::wireframe(), inside];
    let mut renderer = stage.renderer(&Options { styles, views_per_frame: 32, ..Options::default() });
    for (name, n) in ["single-quad", "cube"].into_iter().flat_map(|name| [3, 4, 16, 17].map(|n| (name, n))) {
        let mesh = shape(name).expect("built in");
        let mut expected = [None, None];
        for way in std::iter::once(ModelOptions::default()).chain(ways(Scheme::Gregory)) {
            let model = renderer.add_model(&mesh, &way).expect("a model");
            let factor = with_segments(&mut renderer, model, way.evaluation, n);
            let frame = stage.frame(&mut renderer);
            // Of a single quad nothing faces away.
            let styles = if name == "cube" { vec![vec![0, 1], vec![2]] } else { vec![vec![0, 1]] };
            for (styles, expected) in styles.into_iter().zip(&mut expected) {
                let items = styles.into_iter().map(|style| DrawItem {
                    style,
                    colors: [[0.2 + 0.4 * style as f32; 4]; 4],
                    ..DrawItem::new(model, factor)
                });
                let items: Vec<_> = items.collect();
                let picture = stage.draw(&mut renderer, frame, &items).expect("a picture");
                let what = format!("{name}, {:?} {:?}: {n}", way.evaluation, way.construction);
                assert_same(&picture, expected.get_or_insert(picture.clone()), &what);
            }
            renderer.remove_model(model).unwrap();
        }
    }
    drop(renderer);
    stage.finish();
}

/// Models with as many segments have their indices once, whoever of them came or goes first.
#[test]
fn indices_are_shared() {
    let stage = Stage::new();
    let mesh = shape("creature-mixed").expect("built in");
    let mut renderer = stage.renderer(&Options { views_per_frame: 32, ..Options::default() });
    let options = |evaluation| {
        let construction = Construction::Cached;
        ModelOptions { construction, evaluation, ..ModelOptions::default() }
    };
    let add = |renderer: &mut Renderer, evaluation, segments| {
        let model = renderer.add_model(&mesh, &options(evaluation)).expect("a model");
        renderer.set_segments(model, segments).expect("segments");
        model
    };
    // A quad and a triangle on six segments.
    let bytes = 4 * 3 * (2 * 6 * 6 + 6 * 6);
    for evaluation in [Evaluation::Instanced, Evaluation::Compute] {
        let mut pictures = Vec::new();
        let [first, second] = [0; 2].map(|_| add(&mut renderer, evaluation, 6));
        let of_one = renderer.memory_usage().indices;
        assert_eq!(of_one % bytes, 0, "{evaluation:?}");
        assert!(evaluation == Evaluation::Compute || of_one == bytes);
        // What was to be copied for both does not go with the first.
        renderer.remove_model(first).expect("a model");
        let frame = stage.frame(&mut renderer);
        let third = add(&mut renderer, evaluation, 6);
        let item = |model| DrawItem::new(model, Factor::Segments);
        let early = stage.draw(&mut renderer, frame, &[item(third)]).unwrap_err().to_string();
        assert!(early.contains("it was not yet prepared"), "{early}");
        let frame = stage.frame(&mut renderer);
        for model in [second, third] {
            pictures.push(stage.draw(&mut renderer, frame, &[item(model)]).expect("a picture"));
        }
        assert_eq!(renderer.memory_usage().indices, of_one);
        // Others are others, and go when nobody has them.
        renderer.set_segments(third, 3).expect("segments");
        assert!(renderer.memory_usage().indices > of_one);
        renderer.set_segments(third, 6).expect("segments");
        renderer.remove_model(second).expect("a model");
        (0..3).for_each(|_| _ = stage.frame(&mut renderer));
        let frame = stage.frame(&mut renderer);
        assert_eq!(renderer.memory_usage().indices, of_one);
        pictures.push(stage.draw(&mut renderer, frame, &[item(third)]).expect("a picture"));
        renderer.remove_model(third).expect("a model");
        (0..2).for_each(|_| _ = stage.frame(&mut renderer));
        assert_eq!((renderer.memory_usage().indices, renderer.memory_usage().staging), (0, 0));
        let alone = add(&mut renderer, evaluation, 6);
        let frame = stage.frame(&mut renderer);
        let expected = stage.draw(&mut renderer, frame, &[item(alone)]).expect("a picture");
        pictures.iter().for_each(|picture| assert_same(picture, &expected, &format!("{evaluation:?}")));
        renderer.remove_model(alone).expect("a model");
    }
    drop(renderer);
    stage.finish();
}

/// Whatever was drawn before an item, it is drawn as if nothing had been: what is bound is known.
#[test]
fn items_do_not_depend_on_those_before() {
    let stage = Stage::new();
    let mesh = shape("polygons").expect("built in");
    let styles = vec![Style::default(), Style { geometry: Geometry::ControlEdges, ..Style::default() }];
    let mut renderer = stage.renderer(&Options { styles, views_per_frame: 600, ..Options::default() });
    let mut kinds = Vec::new();
    for way in std::iter::once(ModelOptions::default()).chain(ways(Scheme::Gregory)) {
        // As lists of triangles, and as strips on the CI device.
        for segments in [2, 14] {
            let model = renderer.add_model(&mesh, &way).expect("a model");
            kinds.push(DrawItem::new(model, with_segments(&mut renderer, model, way.evaluation, segments)));
        }
    }
    kinds.push(DrawItem { style: 1, ..kinds[0] });
    let kind_count = kinds.len();
    // Each after each, itself too, and again what was there before.
    let pairs = (0..kind_count).flat_map(|first| (first..kind_count).map(move |second| (first, second)));
    let order: Vec<usize> = pairs.flat_map(|(first, second)| [first, second, first, second]).collect();
    let side = (order.len() as f32).sqrt().ceil();
    let items = order.iter().enumerate().map(|(place, &kind)| {
        let at = [place as f32 % side, (place as f32 / side).floor()].map(|x| (2.0 * x + 1.0) / side - 1.0);
        let scale = Mat4::from_scale(Vec3::splat(0.8 / side));
        let transform = Mat4::from_translation(Vec3::new(at[0], at[1], 0.0)) * scale;
        DrawItem { transform: transform.to_cols_array_2d(), ..kinds[kind] }
    });
    let items: Vec<DrawItem> = items.collect();
    let frame = stage.frame(&mut renderer);
    let together = stage.draw(&mut renderer, frame, &items).expect("a picture");
    let view = Stage::view();
    let record = |cmd| {
        for item in &items {
            // SAFETY: inside rendering, after the preparation of the frame.
            unsafe { renderer.cmd_draw(cmd, frame, &view, &[*item]) }?;
        }
        Ok::<_, ash_subdiv::Error>(())
    };
    let one_by_one = stage.target.draw(&stage.headless, [0.0; 4], record).expect("a picture");
    assert!(together == one_by_one, "pictures differ");
    drop(renderer);
    stage.finish();
}

/// A displaced surface, with and without texture coordinates for the fragment shader.
#[cfg(feature = "png")]
#[test]
fn displaced_pictures_are_those_of_the_tessellation_stages() {
    use ash_subdiv::headless::{Texels, Texture};
    let stage = Stage::new();
    let mesh = shape("creature").expect("built in");
    let texels = Texels::open("assets/scales.png", false).expect("the built-in height map");
    let texture = Texture::new(&stage.headless, "scales", &texels).expect("a texture");
    for texcoords in [false, true] {
        let mut renderer = stage.renderer(&Options { texcoords, ..Options::default() });
        // SAFETY: the texture outlives the renderer and is readable.
        let displacement = Some(unsafe { renderer.add_displacement((&texture).into()) });
        let shared = ways(Scheme::Gregory).filter(|way| way.evaluation.shares(way.construction));
        // The levels of the map are found in other stages there.
        let others = [Construction::Stencil, Construction::Cached];
        let others = others.map(|construction| ModelOptions { construction, ..ModelOptions::default() });
        let models: Vec<_> = std::iter::once(ModelOptions::default())
            .chain(others)
            .chain(shared)
            .map(|way| ModelOptions { displacement, ..way })
            .map(|way| (renderer.add_model(&mesh, &way).expect("a model"), way.evaluation))
            .collect();
        for n in [3, 16] {
            for &(model, _) in models.iter().filter(|(_, evaluation)| evaluation.needs_segments()) {
                renderer.set_segments(model, n).unwrap();
            }
            let frame = stage.frame(&mut renderer);
            let mut picture = |(model, evaluation): (ash_subdiv::ModelId, Evaluation), height| {
                let factor = if evaluation.needs_segments() { Factor::Segments } else { Factor::Uniform(n as f32) };
                let item = DrawItem { displacement: [height, 0.0], ..DrawItem::new(model, factor) };
                stage.draw(&mut renderer, frame, &[item]).expect("a picture")
            };
            let [expected, smooth] = [0.1, 0.0].map(|height| picture(models[0], height));
            let differ = |a: &[u8], b: &[u8]| a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 8).count();
            assert!(differ(&expected, &smooth) > 2000, "{}", differ(&expected, &smooth));
            for &(model, evaluation) in &models[1..] {
                let differ = differ(&picture((model, evaluation), 0.1), &expected);
                assert!(differ < 20, "{evaluation:?}, {n} segments, texture coordinates {texcoords}: {differ}");
            }
        }
        drop(renderer);
    }
    drop(texture);
    stage.finish();
}

/// More than the tessellator has, and in one draw more than lavapipe takes in one batch.
#[test]
fn uniform_grids_may_be_fine() {
    let stage = Stage::new();
    for (name, segments) in [("cube", 150), ("tetrahedron", 301), ("single-quad", 1024)] {
        let mesh = shape(name).expect("built in");
        let styles = vec![Style { cull: vk::CullModeFlags::BACK, ..Style::default() }];
        let mut renderer = stage.renderer(&Options { styles, ..Options::default() });
        let mut expected = None;
        for options in ways(Scheme::Gregory) {
            let model = renderer.add_model(&mesh, &options).expect("a model");
            let factor = with_segments(&mut renderer, model, options.evaluation, segments);
            let frame = stage.frame(&mut renderer);
            let picture = stage.draw(&mut renderer, frame, &[DrawItem::new(model, factor)]).expect("a picture");
            let what = format!("{name} {:?} {:?}", options.evaluation, options.construction);
            assert_same(&picture, expected.get_or_insert(picture.clone()), &what);
            renderer.remove_model(model).unwrap();
        }
        drop(renderer);
    }
    stage.finish();
}
