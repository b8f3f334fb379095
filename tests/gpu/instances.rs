//! Instances: one item with many is many items.

use crate::common::stage::{Stage, begin, with_segments};
use crate::device_positions::ways;
use ash::vk;
use ash_subdiv::headless::objects::Buffer;
use ash_subdiv::renderer::{Cull, Evaluation, Factor, Fragment, Geometry};
use ash_subdiv::{
    ControlMesh, DrawItem, Error, Frame, Instance, Instances, ModelId, ModelOptions, Options, Renderer, Style, View,
    shape,
};
use glam::{Mat4, Quat, Vec3};

#[allow(dead_code, reason = "other tests use the other shaders")]
mod shaders {
    include!(concat!(env!("OUT_DIR"), "/test_shaders.rs"));
}

/// Instances side by side that are turned, stretched and mirrored, in other colours.
fn instances(mesh: &ControlMesh, count: usize) -> Vec<Instance> {
    let [low, high] = mesh.bounds().map(|corner| corner.as_vec3());
    let (middle, size) = ((low + high) / 2.0, (high - low).max_element());
    let side = (count as f32).sqrt().ceil();
    let instance = |i: usize| {
        let (column, row) = (i as f32 % side, (i as f32 / side).floor());
        let at = Vec3::new(column + 0.5 - side / 2.0, row + 0.5 - side / 2.0, 0.0) * (2.0 / side);
        let mirror = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let scale = Vec3::new(1.0, 0.7 * mirror, 0.9) * (1.2 / (side * size));
        let turn = Quat::from_rotation_y(0.7 * i as f32) * Quat::from_rotation_x(0.3 * i as f32);
        let matrix = Mat4::from_scale_rotation_translation(scale, turn, at) * Mat4::from_translation(-middle);
        let shade = (i % 7) as f32 / 7.0;
        let (color, words) = ([shade, 1.0 - shade, 0.5, 1.0], [i as u32; 4].map(|i| 40 * (i % 6)));
        Instance { color, words, ..Instance::new(&matrix.to_cols_array_2d()) }
    };
    (0..count).map(instance).collect()
}

/// The same as items.
fn items(item: DrawItem, instances: &[Instance]) -> Vec<DrawItem> {
    let of = |instance: &Instance| {
        let [x, y, z] = instance.transform;
        let transform = Mat4::from_cols_array_2d(&[x, y, z, [0.0, 0.0, 0.0, 1.0]]).transpose().to_cols_array_2d();
        DrawItem { transform, words: instance.words, ..item.color(instance.color) }
    };
    instances.iter().map(of).collect()
}

/// Styles that say something of instances: all, or the first two.
fn styles(all: bool) -> Vec<Style> {
    let back = Style { cull: vk::CullModeFlags::BACK, ..Style::default() };
    let words = Style { fragment: Fragment::Spirv(shaders::WORDS_FRAG.to_vec()), ..Style::default() };
    let faces = Style { geometry: Geometry::ControlFaces, ..Style::default() };
    let normals = Style { fragment: Fragment::Normals, ..Style::default() };
    let mut styles = vec![back, words, faces, Style::cage(), normals, Style::default()];
    styles.truncate(if all { styles.len() } else { 2 });
    styles
}

fn view() -> View {
    Stage::view().sized(96, 96)
}

fn draw(stage: &Stage, renderer: &mut Renderer, frame: Frame, items: &[DrawItem]) -> Result<Vec<u8>, Error> {
    // SAFETY: the command buffer is being recorded, inside rendering.
    let record = |cmd| unsafe { renderer.cmd_draw(cmd, frame, &view(), items) };
    stage.target.draw(&stage.headless, [0.0; 4], record)
}

/// A buffer of the caller's with instances from some offset on.
fn buffer(stage: &Stage, instances: &[Instance], offset: u64, stride: u32) -> Buffer {
    let mut words = vec![u32::MAX; offset as usize / 4];
    for instance in instances {
        words.extend(bytemuck::cast_slice::<_, u32>(std::slice::from_ref(instance)));
        words.resize(words.len() + stride as usize / 4 - 20, u32::MAX);
    }
    words.truncate(words.len() + 20 - stride as usize / 4);
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    Buffer::with_data(stage.headless.context(), "instances of the caller's", usage, &words).expect("a buffer")
}

fn covered(pixels: &[u8]) -> usize {
    pixels.chunks(4).filter(|pixel| pixel[3] > 0).count()
}

/// Compares both sources of instances with items, in every style and with every rule that shaders know for it.
fn assert_same(
    stage: &Stage,
    renderer: &mut Renderer,
    (model, styles): (ModelId, usize),
    of: (&[Instance], Factor, [f32; 2]),
    what: &str,
) {
    let (instances, factor, displacement) = of;
    let own = buffer(stage, instances, 260, 96);
    let frame = stage.frame(renderer);
    let host = renderer.instances(frame, instances).expect("instances");
    // SAFETY: the buffer outlives what is drawn with it, which is waited for.
    let device = unsafe { Instances::in_buffer(own.raw(), own.size(), 260, 96, instances.len() as u32) };
    for style in 0..styles {
        for cull in if style == 0 { vec![Cull::ALL, Cull::NONE] } else { vec![Cull::NONE] } {
            let item = DrawItem { style, cull, displacement, ..DrawItem::new(model, factor) };
            let expected = draw(stage, renderer, frame, &items(item, instances)).expect("a picture");
            assert!(covered(&expected) > 100, "{what}, style {style}: {}", covered(&expected));
            for (source, instances) in [("host", host), ("device", device)] {
                let item = DrawItem { instances: Some(instances), ..item };
                let drawn = draw(stage, renderer, frame, &[item]).expect("a picture");
                let differ = drawn.iter().zip(&expected).filter(|(a, b)| a != b).count();
                assert!(differ == 0, "{what}, style {style}, {cull:?}, {source}: {differ}");
            }
        }
    }
}

#[test]
fn instances_are_items_in_every_construction_and_evaluation() {
    let stage = Stage::new();
    for (number, (mesh, options)) in ways().into_iter().enumerate() {
        let styles = styles(number < 3 || options.evaluation != Evaluation::Tessellation);
        let count = styles.len();
        let options_of = Options { styles, texcoords: number % 2 == 0, views_per_frame: 64, ..Options::default() };
        let mut renderer = stage.renderer(&options_of);
        let model = renderer.add_model(&mesh, &options).expect("a model");
        let factor = with_segments(&mut renderer, model, options.evaluation, 4);
        let of = instances(&mesh, 5);
        assert_same(&stage, &mut renderer, (model, count), (&of, factor, [0.0; 2]), &format!("{options:?}"));
        if number == 0 {
            for factor in [Factor::Pixels(4.0), Factor::Curvature(0.5)] {
                assert_same(
                    &stage,
                    &mut renderer,
                    (model, count),
                    (&of, factor, [0.0; 2]),
                    &format!("{options:?}, {factor:?}"),
                );
            }
        }
        drop(renderer);
    }
    stage.finish();
}

#[cfg(feature = "png")]
#[test]
fn displaced_instances_are_displaced_items() {
    use ash_subdiv::Construction;
    use ash_subdiv::headless::{Texels, Texture};
    let stage = Stage::new();
    let mesh = shape("creature").expect("built in");
    let texels = Texels::open("assets/scales.png", false).expect("the built-in height map");
    let texture = Texture::new(&stage.headless, "scales", &texels).expect("a texture");
    let of_construction = |construction| ModelOptions { construction, ..ModelOptions::default() };
    let shared = Evaluation::ALL.map(ModelOptions::evaluated).into_iter();
    let shared = shared.filter(|way| way.evaluation.shares(way.construction));
    for options in Construction::ALL.map(of_construction).into_iter().chain(shared) {
        let mut renderer =
            stage.renderer(&Options { styles: styles(false), views_per_frame: 64, ..Options::default() });
        // SAFETY: the texture outlives the renderer and is readable.
        let displacement = Some(unsafe { renderer.add_displacement((&texture).into()) });
        let options = ModelOptions { displacement, ..options };
        let model = renderer.add_model(&mesh, &options).expect("a model");
        let factor = with_segments(&mut renderer, model, options.evaluation, 4);
        let of = instances(&mesh, 3);
        assert_same(&stage, &mut renderer, (model, 2), (&of, factor, [0.1, 0.0]), &format!("{options:?}"));
        drop(renderer);
    }
    drop(texture);
    stage.finish();
}

#[test]
fn ten_thousand_instances_are_one_item() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let of = instances(&mesh, 10_000);
    for evaluation in Evaluation::ALL {
        let mut renderer = stage.renderer(&Options::default());
        let model = renderer.add_model(&mesh, &ModelOptions::evaluated(evaluation)).expect("a model");
        let factor = with_segments(&mut renderer, model, evaluation, 1);
        let frame = stage.frame(&mut renderer);
        let item = DrawItem::new(model, factor);
        let many = Some(renderer.instances(frame, &of).expect("instances"));
        let drawn = draw(&stage, &mut renderer, frame, &[DrawItem { instances: many, ..item }]).expect("a picture");
        let expected = draw(&stage, &mut renderer, frame, &items(item, &of)).expect("a picture");
        assert!(covered(&expected) > 100 && drawn == expected, "{evaluation:?}: {}", covered(&expected));
        drop(renderer);
    }
    stage.finish();
}

#[test]
fn instances_that_cannot_be_drawn() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let mut renderer = stage.renderer(&Options { visible_lists: true, views_per_frame: 64, ..Options::default() });
    let model = renderer.add_model(&mesh, &ModelOptions::default()).expect("a model");
    let of = instances(&mesh, 3);
    let own = buffer(&stage, &of, 0, 80);
    let frame = stage.frame(&mut renderer);
    let told = |renderer: &mut Renderer, frame, instances| {
        let item = DrawItem { instances: Some(instances), ..DrawItem::new(model, 2.0) };
        draw(&stage, renderer, frame, &[item]).expect_err("an error").to_string()
    };
    // SAFETY: none is drawn that does not fit.
    let in_buffer = |buffer, offset, stride, count| unsafe { Instances::in_buffer(buffer, 240, offset, stride, count) };
    for (instances, expected) in [
        (in_buffer(vk::Buffer::null(), 0, 80, 3), "the buffer of its instances is null"),
        (in_buffer(own.raw(), 2, 80, 1), "the offset 2 and the stride 80 are in bytes, multiples of 4"),
        (in_buffer(own.raw(), 0, 82, 1), "the offset 0 and the stride 82"),
        (in_buffer(own.raw(), 0, 64, 1), "the offset 0 and the stride 64"),
        (in_buffer(own.raw(), 0, 80, 4), "the buffer has 240 bytes, but its instances end after 320"),
        (in_buffer(own.raw(), u64::MAX - 3, 80, 4), "but its instances end after"),
    ] {
        let told = told(&mut renderer, frame, instances);
        assert!(told.contains(expected), "{told}");
    }
    // More than a shader sees at once, which takes no memory on the device to find out.
    let max = stage.headless.properties().max_storage_buffer_range;
    let count = max / size_of::<Instance>() as u64 + 1;
    // SAFETY: it is not drawn.
    let large = unsafe { Instances::in_buffer(own.raw(), u64::MAX, 0, 80, count as u32) };
    let expected = format!("instances of an item take {} bytes, but a shader can see {max}", 80 * count);
    let told_large = told(&mut renderer, frame, large);
    assert!(told_large.contains(&expected) && told_large.ends_with("draw them as several items"), "{told_large}");
    if max < 1 << 28 {
        let many = vec![of[0]; count as usize];
        let error = renderer.instances(frame, &many).expect_err("an error").to_string();
        let expected = format!("{count} instances are given at once, {} at most on this device", count - 1);
        assert!(error.starts_with(&expected) && error.ends_with("give them in parts, each for an item"), "{error}");
    }
    // None at all draw nothing, from any buffer.
    for instances in [in_buffer(own.raw(), 0, 80, 0), renderer.instances(frame, &[]).expect("no instances")] {
        let item = DrawItem { instances: Some(instances), ..DrawItem::new(model, 2.0) };
        assert_eq!(covered(&draw(&stage, &mut renderer, frame, &[item]).expect("a picture")), 0);
    }
    let of_frame = renderer.instances(frame, &of).expect("instances");
    let item = DrawItem { instances: Some(of_frame), cull: Cull::ALL, ..DrawItem::new(model, 2.0) };
    // SAFETY: nothing is recorded.
    let culled = unsafe { renderer.cmd_cull(vk::CommandBuffer::null(), frame, &view(), &[item]) };
    assert!(culled.unwrap_err().to_string().contains("cmd_cull makes no lists of instances"));
    let next = begin(&mut renderer);
    assert!(matches!(renderer.instances(frame, &of), Err(Error::OldFrame)));
    stage.prepare(&mut renderer, next);
    assert!(told(&mut renderer, next, of_frame).contains("the frame is over"));
    let mut other = stage.renderer(&Options::default());
    let model_of_other = other.add_model(&mesh, &ModelOptions::default()).expect("a model");
    let of_other = stage.frame(&mut other);
    let item = DrawItem { instances: Some(of_frame), ..DrawItem::new(model_of_other, 2.0) };
    assert!(matches!(draw(&stage, &mut other, of_other, &[item]), Err(Error::OldFrame)));
    drop((renderer, other, own));
    stage.finish();
}

/// Room for instances grows within a frame, and what was given before is still there.
#[test]
fn instances_of_a_frame_stay() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let mut renderer = stage.renderer(&Options { frames_in_flight: 2, ..Options::default() });
    let model = renderer.add_model(&mesh, &ModelOptions::default()).expect("a model");
    let of = instances(&mesh, 1000);
    let mut before = None;
    for _ in 0..4 {
        let frame = stage.frame(&mut renderer);
        let parts: Vec<_> = of.chunks(90).map(|part| renderer.instances(frame, part).expect("instances")).collect();
        assert!(parts.iter().map(|part| part.count()).sum::<u32>() == 1000);
        let items: Vec<_> =
            parts.into_iter().map(|part| DrawItem { instances: Some(part), ..DrawItem::new(model, 1.0) }).collect();
        let all = Some(renderer.instances(frame, &of).expect("instances"));
        let all = draw(&stage, &mut renderer, frame, &[DrawItem { instances: all, ..DrawItem::new(model, 1.0) }]);
        let drawn = draw(&stage, &mut renderer, frame, &items).expect("a picture");
        assert!(drawn == all.expect("a picture") && covered(&drawn) > 100);
        let used = renderer.memory_usage().views;
        assert!(before.replace(used).is_none_or(|before| used < 4 * before));
    }
    drop(renderer);
    stage.finish();
}
