//! The drop-in module as a caller uses it: frames in flight, moving and removed models, the caller's own shaders, and
//! what it says when it is used wrongly.

use crate::common::stage::with_segments;
use ash::vk;
use ash_subdiv::adaptive::AdaptiveOptions;
use ash_subdiv::headless::{Headless, HeadlessOptions, Offscreen, OffscreenDesc};
use ash_subdiv::mesh::FaceVarying;
use ash_subdiv::renderer::{ColorEncoding, Evaluation, Fragment, Geometry};
use ash_subdiv::{
    Construction, ControlMesh, DrawItem, Error, Frame, ModelOptions, Options, Renderer, Style, Target, View, shape,
};

#[allow(dead_code, reason = "other tests use the other shaders")]
mod shaders {
    include!(concat!(env!("OUT_DIR"), "/test_shaders.rs"));
}

const SIZE: u32 = 64;
const BLACK: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
const WHITE: [f32; 4] = [1.0; 4];

/// A device, and a square picture without gamma.
struct Stage {
    target: Offscreen,
    headless: Headless,
}

impl Stage {
    fn new() -> Self {
        let headless = Headless::new(&HeadlessOptions { validation: true, ..HeadlessOptions::default() });
        let headless = headless.expect("a Vulkan device with the validation layer");
        let desc = OffscreenDesc { color: vk::Format::R8G8B8A8_UNORM, ..OffscreenDesc::new(SIZE, SIZE) };
        Self { target: Offscreen::new(&headless, &desc).expect("an image"), headless }
    }

    fn target(&self) -> Target {
        let desc = self.target.desc();
        Target::dynamic(desc.color, desc.depth, desc.samples)
    }

    fn renderer(&self, options: &Options) -> Renderer {
        // SAFETY: every submission is waited for, and the renderer is dropped before the stage.
        unsafe { Renderer::new(self.headless.context(), &self.target(), options) }.expect("a renderer")
    }

    /// Begins a frame and prepares it.
    fn frame(&self, renderer: &mut Renderer) -> Frame {
        let frame = begin(renderer);
        self.prepare(renderer, frame);
        frame
    }

    fn prepare(&self, renderer: &mut Renderer, frame: Frame) {
        // SAFETY: the command buffer is being recorded, and submitted.
        self.headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) }).expect("prepared");
    }

    fn draw(&self, renderer: &mut Renderer, frame: Frame, items: &[DrawItem]) -> Result<Picture, Error> {
        // SAFETY: as above, inside rendering.
        let pixels =
            self.target.draw(&self.headless, BLACK, |cmd| unsafe { renderer.cmd_draw(cmd, frame, &front(), items) })?;
        Ok(Picture(pixels))
    }

    fn finish(self) {
        drop(self.target);
        self.headless.finish_silent();
    }
}

/// Begins a frame, where every submission is waited for.
fn begin(renderer: &mut Renderer) -> Frame {
    // SAFETY: all frames before are done.
    unsafe { renderer.begin_frame() }
}

/// What lies in [`orthographic`], seen from the front.
fn front() -> View {
    View {
        view_projection: orthographic(),
        eye: [0.0, 0.0, 10.0],
        light: [0.0, 0.0, 1.0],
        viewport: [0.0; 2],
        mirrored: false,
        measured_from: None,
    }
}

/// From x and y in -1..1, z in -4..4; y up.
fn orthographic() -> [[f32; 4]; 4] {
    [[1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -0.125, 0.0], [0.0, 0.0, 0.5, 1.0]]
}

struct Picture(Vec<u8>);

impl Picture {
    /// The pixel at x, y in -1..1, y up.
    fn at(&self, x: f32, y: f32) -> [u8; 4] {
        let pixel = |t: f32| (((t + 1.0) / 2.0 * SIZE as f32) as usize).min(SIZE as usize - 1);
        let start = 4 * (pixel(-y) * SIZE as usize + pixel(x));
        [0, 1, 2, 3].map(|i| self.0[start + i])
    }

    fn covered(&self) -> usize {
        self.0.chunks(4).filter(|p| p[..3] != [0, 0, 0]).count()
    }
}

/// The unit square around the origin, in the plane z = 0, facing +z. Its smooth surface is itself.
fn square(half: f64) -> ControlMesh {
    let mut data = shape("single-quad").expect("built in").into_data();
    data.positions =
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [x * half, y * half, 0.0]).into();
    data.face_vertices = vec![0, 1, 2, 3];
    data.texcoords =
        Some(FaceVarying { values: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], indices: vec![0, 1, 2, 3] });
    ControlMesh::new(data).expect("a square")
}

fn flat() -> Options {
    let style = Style { fragment: Fragment::Flat, ..Style::default() };
    Options { styles: vec![style], ..Options::default() }
}

#[test]
fn positions_of_a_frame_move_the_model() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&flat());
    let mesh = square(0.25);
    let model = renderer.add_model(&mesh, &ModelOptions::default()).unwrap();
    let item = DrawItem::new(model, 3.0).color(WHITE);
    let moved = |x: f32| mesh.positions_f32().iter().map(|p| [p[0] + x, p[1], p[2]]).collect::<Vec<_>>();

    let frame = stage.frame(&mut renderer);
    let picture = stage.draw(&mut renderer, frame, &[item]).unwrap();
    assert_eq!((picture.at(0.0, 0.0), picture.at(0.6, 0.0)), ([255; 4], [0, 0, 0, 255]));
    assert_eq!(picture.covered(), 16 * 16);
    // What was set for a frame after its copies were recorded, or without recording any, is in the next.
    let late = stage.frame(&mut renderer);
    renderer.set_positions(model, late, &moved(-0.5)).unwrap();
    let frame = stage.frame(&mut renderer);
    assert_eq!(stage.draw(&mut renderer, frame, &[item]).unwrap().at(-0.6, 0.0), [255; 4]);
    let skipped = begin(&mut renderer);
    renderer.set_positions(model, skipped, &moved(-0.5)).unwrap();
    let frame = begin(&mut renderer);
    renderer.set_positions(model, frame, &moved(0.5)).unwrap();
    stage.prepare(&mut renderer, frame);
    // They stay.
    for _ in 0..3 {
        let frame = stage.frame(&mut renderer);
        let picture = stage.draw(&mut renderer, frame, &[item]).unwrap();
        assert_eq!((picture.at(0.0, 0.0), picture.at(0.6, 0.0)), ([0, 0, 0, 255], [255; 4]));
    }
    drop(renderer);
    stage.finish();
}

#[test]
fn refined_models_move_too() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&flat());
    let mesh = square(0.25);
    for construction in Construction::ALL {
        let options = ModelOptions { refine: 2, construction, ..ModelOptions::default() };
        let model = renderer.add_model(&mesh, &options).unwrap();
        assert_eq!(renderer.tables(model).unwrap().origins().len(), 16);
        let positions: Vec<_> = mesh.positions_f32().iter().map(|p| [p[0], p[1] + 0.5, p[2]]).collect();
        let frame = begin(&mut renderer);
        renderer.set_positions(model, frame, &positions).unwrap();
        stage.prepare(&mut renderer, frame);
        let picture = stage.draw(&mut renderer, frame, &[DrawItem::new(model, 1.0).color(WHITE)]).unwrap();
        assert_eq!((picture.at(0.0, 0.5), picture.at(0.0, 0.0)), ([255; 4], [0, 0, 0, 255]));
        assert_eq!(picture.covered(), 16 * 16);
    }
    drop(renderer);
    stage.finish();
}

/// The device refines them anew in each frame in which they moved.
#[test]
fn adaptive_models_move_too() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&Options::default());
    let mut data = shape("cube").expect("built in").into_data();
    data.positions.iter_mut().for_each(|p| *p = p.map(|x| 0.6 * x));
    let mesh = ControlMesh::new(data.clone()).unwrap();
    data.positions.iter_mut().for_each(|p| *p = [0.5 * p[0] + 0.3, p[1] - 0.4 * p[0], 1.5 * p[2]]);
    let moved = ControlMesh::new(data).unwrap();
    let adaptive = Some(AdaptiveOptions { depth: 3, ..AdaptiveOptions::default() });
    let ways = Construction::ALL.map(|construction| (Evaluation::Tessellation, construction));
    for (evaluation, construction) in ways.into_iter().chain([(Evaluation::Compute, Construction::Cached)]) {
        let options = ModelOptions { adaptive, construction, evaluation, ..ModelOptions::default() };
        let [model, other] = [&mesh, &moved].map(|mesh| renderer.add_model(mesh, &options).unwrap());
        let [factor, _] = [model, other].map(|model| with_segments(&mut renderer, model, evaluation, 6));
        let draw = |renderer: &mut Renderer, model, moved: Option<&ControlMesh>| {
            let frame = begin(renderer);
            if let Some(moved) = moved {
                renderer.set_positions(model, frame, &moved.positions_f32()).unwrap();
            }
            stage.prepare(renderer, frame);
            stage.draw(renderer, frame, &[DrawItem::new(model, factor)]).unwrap().0
        };
        let before = draw(&mut renderer, model, None);
        let after = draw(&mut renderer, model, Some(&moved));
        assert!(after != before && after == draw(&mut renderer, other, None), "{evaluation:?} {construction:?}");
        assert!(after == draw(&mut renderer, model, None), "they stay");
        assert!(before == draw(&mut renderer, model, Some(&mesh)), "{evaluation:?} {construction:?}");
    }
    drop(renderer);
    stage.finish();
}

#[test]
fn a_callers_shader_gets_texture_coordinates() {
    let stage = Stage::new();
    let style = Style { fragment: Fragment::Spirv(shaders::TEXCOORD_FRAG.to_vec()), ..Style::default() };
    let mut renderer = stage.renderer(&Options { styles: vec![style], texcoords: true, ..Options::default() });
    for construction in Construction::ALL {
        for triangles in [false, true] {
            let mut data = square(1.0).into_data();
            if triangles {
                data.face_sizes = vec![3, 3];
                data.face_vertices = vec![0, 1, 2, 0, 2, 3];
                data.texcoords.as_mut().unwrap().indices = vec![0, 1, 2, 0, 2, 3];
                // So that every vertex is a corner, and the surface is the square itself.
                data.creases = vec![];
            }
            let mesh = ControlMesh::new(data).unwrap();
            let model = renderer.add_model(&mesh, &ModelOptions { construction, ..Default::default() }).unwrap();
            let frame = stage.frame(&mut renderer);
            let picture = stage.draw(&mut renderer, frame, &[DrawItem::new(model, 8.0)]).unwrap();
            if triangles {
                // Two triangles round off their shared corners; inside, the coordinate is that of the plane nearly.
                assert_ne!(picture.at(0.3, -0.3), [0, 0, 0, 255]);
                continue;
            }
            for (x, y) in [(-0.9, -0.9), (0.0, 0.0), (0.5, -0.25), (0.9, 0.9)] {
                let [r, g, ..] = picture.at(x, y);
                let expected = [x, y].map(|t: f32| (t + 1.0) / 2.0 * 255.0);
                // A pixel of 64 is 4 of 255 wide.
                assert!((f32::from(r) - expected[0]).abs() < 4.0 && (f32::from(g) - expected[1]).abs() < 4.0);
            }
        }
    }
    // A model without texture coordinates gets zeros.
    let mut data = square(1.0).into_data();
    data.texcoords = None;
    let model = renderer.add_model(&ControlMesh::new(data).unwrap(), &ModelOptions::default()).unwrap();
    let frame = stage.frame(&mut renderer);
    let picture = stage.draw(&mut renderer, frame, &[DrawItem::new(model, 1.0)]).unwrap();
    assert_eq!(picture.at(0.5, 0.5), [0, 0, 0, 255]);
    drop(renderer);
    stage.finish();
}

#[test]
fn items_have_colours_and_words_of_their_own() {
    let stage = Stage::new();
    let style = Style { fragment: Fragment::Spirv(shaders::WORDS_FRAG.to_vec()), ..Style::default() };
    let mut renderer = stage.renderer(&Options { styles: vec![style], views_per_frame: 3, ..Options::default() });
    let model = renderer.add_model(&square(1.0 / 16.0), &ModelOptions::default()).unwrap();
    let empty = renderer.memory_usage().views;
    // More than there is room for at first, in one draw and by the next of the same frame: four pixels each.
    let centre = |i: u32| [i % 16, i / 16].map(|k| (2 * k + 1) as f32 / 16.0 - 1.0);
    let item = |i: u32| {
        let [x, y] = centre(i);
        let transform = glam::Mat4::from_translation(glam::vec3(x, y, 0.0)).to_cols_array_2d();
        let mut item = DrawItem { words: [i, 200 - i / 2, 7, 0], transform, ..DrawItem::new(model, 1.0) };
        // Corners without a tag are sharp: the square is regular.
        item.colors[0] = [0.0, 0.4, 0.0, 0.0];
        item
    };
    let items: Vec<_> = (0..256).map(item).collect();
    for _ in 0..3 {
        let frame = stage.frame(&mut renderer);
        let pixels = stage.target.draw(&stage.headless, BLACK, |cmd| {
            // SAFETY: as in `Stage::draw`.
            unsafe {
                renderer.cmd_draw(cmd, frame, &front(), &items[..30])?;
                renderer.cmd_draw(cmd, frame, &front(), &items[30..100])?;
                renderer.cmd_draw(cmd, frame, &front(), &items[100..])
            }
        });
        let picture = Picture(pixels.unwrap());
        for i in 0..256 {
            let [x, y] = centre(i);
            assert_eq!(picture.at(x, y)[..3], [i as u8, (251 - i / 2) as u8, 7], "item {i}");
        }
    }
    assert!(renderer.memory_usage().views > empty);
    drop(renderer);
    stage.finish();
}

#[test]
fn removed_models_stay_until_their_frames_are_done() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&Options { styles: vec![Style::default(), Style::cage()], ..Options::default() });
    let empty = renderer.memory_usage();
    let creature = shape("creature").unwrap();
    for round in 0..4 {
        let model = renderer.add_model(&creature, &ModelOptions::default()).unwrap();
        let used = renderer.memory_usage();
        assert!(used.tables > 90_000 && used.positions == 16 * creature.vertex_count() as u64);
        assert_eq!(used.control_meshes, 4 * (2 * creature.edge_count() + 6 * creature.face_count()) as u64);
        let frame = stage.frame(&mut renderer);
        // Uploads are done; what is left is a copy of the positions for each frame.
        assert_eq!(renderer.memory_usage().staging, 2 * used.positions);
        let items = [DrawItem::new(model, 2.0), DrawItem { style: 1, ..DrawItem::new(model, 1.0) }];
        stage.draw(&mut renderer, frame, &items).unwrap();
        renderer.remove_model(model).unwrap();
        assert_eq!(renderer.memory_usage(), empty);
        let error = stage.draw(&mut renderer, frame, &items).err().unwrap().to_string();
        assert_eq!(error, format!("model {round}: there is no such model: it was removed, or is another renderer's"));
    }
    drop(renderer);
    stage.finish();
}

#[test]
fn faces_of_all_kinds_face_outwards() {
    let stage = Stage::new();
    let culled = |cull| Style { fragment: Fragment::Flat, cull, ..Style::default() };
    let styles = vec![
        culled(vk::CullModeFlags::NONE),
        culled(vk::CullModeFlags::BACK),
        Style { geometry: Geometry::ControlFaces, ..culled(vk::CullModeFlags::BACK) },
    ];
    let mut renderer = stage.renderer(&Options { styles, ..Options::default() });
    for name in ["cube", "tetrahedron", "torus", "creature-mixed"] {
        let mesh = shape(name).unwrap();
        for construction in Construction::ALL {
            let model = renderer.add_model(&mesh, &ModelOptions { construction, ..Default::default() }).unwrap();
            let frame = stage.frame(&mut renderer);
            let shrink = (1.6 / mesh.diagonal()) as f32;
            // Mirrored models are inside out: their culling is the caller's business.
            let transform = glam::Mat4::from_scale(glam::Vec3::splat(shrink)).to_cols_array_2d();
            let item = DrawItem { transform, ..DrawItem::new(model, 5.0).color(WHITE) };
            let all = stage.draw(&mut renderer, frame, &[item]).unwrap();
            let front = stage.draw(&mut renderer, frame, &[DrawItem { style: 1, ..item }]).unwrap();
            assert!(all.covered() > 50, "{name}");
            assert!(all.0 == front.0, "{name} {construction:?}: culling back faces leaves holes");
            let cage = stage.draw(&mut renderer, frame, &[DrawItem { style: 2, ..item }]).unwrap();
            assert!(cage.covered() > all.covered() / 2, "{name}");
        }
    }
    drop(renderer);
    stage.finish();
}

#[test]
fn holes_are_not_drawn() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&flat());
    let mut data = square(0.9).into_data();
    data.holes = vec![0];
    let model = renderer.add_model(&ControlMesh::new(data).unwrap(), &ModelOptions::default()).unwrap();
    let frame = stage.frame(&mut renderer);
    let picture = stage.draw(&mut renderer, frame, &[DrawItem::new(model, 4.0).color(WHITE)]).unwrap();
    assert_eq!(picture.covered(), 0);
    drop(renderer);
    stage.finish();
}

#[test]
fn wrong_use_is_told() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&Options { views_per_frame: 2, ..Options::default() });
    let mesh = shape("cube").unwrap();
    let model = renderer.add_model(&mesh, &ModelOptions::default()).unwrap();
    let item = DrawItem::new(model, 1.0);
    let draw = |renderer: &mut Renderer, frame, item| {
        stage.draw(renderer, frame, &[item]).err().expect("an error").to_string()
    };
    let over = "the frame is over: another one began since, it was lost, or it is another renderer's: name what begin_frame gave last";
    let old = begin(&mut renderer);
    let told = "the frame was not prepared: record cmd_prepare before cmd_draw and cmd_cull, outside rendering";
    assert_eq!(draw(&mut renderer, old, item), told);
    stage.prepare(&mut renderer, old);
    let late = renderer.add_model(&mesh, &ModelOptions::default()).unwrap();
    assert_eq!(
        draw(&mut renderer, old, DrawItem::new(late, 1.0)),
        "model 1: it was not yet prepared: record cmd_prepare after add_model and set_segments, and before cmd_draw"
    );
    let mut frame = stage.frame(&mut renderer);
    assert_eq!(draw(&mut renderer, old, item), over);
    for factor in [0.5, f32::NAN] {
        assert_eq!(
            draw(&mut renderer, frame, DrawItem { factor: factor.into(), ..item }),
            format!(
                "model 0: Uniform({factor:?}): a tessellation factor is a number from 1 up, pixels and scales are above 0"
            )
        );
        frame = stage.frame(&mut renderer);
    }
    assert_eq!(draw(&mut renderer, frame, DrawItem { style: 1, ..item }), "style 1: Options::styles has 1");
    stage.draw(&mut renderer, frame, &[item]).unwrap();
    assert_eq!(
        draw(&mut renderer, frame, item),
        "2 views were already drawn or culled in the frame: raise Options::views_per_frame"
    );
    // Another renderer's first model is not this one's.
    let mut other = stage.renderer(&Options::default());
    let of_other = begin(&mut other);
    let error = other.set_positions(model, of_other, &[[0.0; 3]; 8]).unwrap_err().to_string();
    assert_eq!(error, "model 0: there is no such model: it was removed, or is another renderer's");
    let first = other.add_model(&mesh, &ModelOptions::default()).unwrap();
    assert!(first != model && other.set_positions(model, of_other, &[[0.0; 3]; 8]).is_err());
    drop(other);
    let error = renderer.set_positions(model, frame, &[[0.0; 3]; 7]).unwrap_err().to_string();
    assert_eq!(error, "model 0: 7 positions are given, but its control mesh has 8 vertices");
    for frame in [old, of_other] {
        assert_eq!(renderer.set_positions(model, frame, &[[0.0; 3]; 8]).unwrap_err().to_string(), over);
    }
    renderer.frame_lost(frame).unwrap();
    assert_eq!(renderer.frame_lost(frame).unwrap_err().to_string(), over);
    assert_eq!(draw(&mut renderer, frame, item), over);
    drop(renderer);
    stage.finish();
}

#[test]
fn colors_are_encoded_where_the_format_does_not() {
    let stage = Stage::new();
    for (encoding, expected) in [(ColorEncoding::Linear, [128, 0, 255]), (ColorEncoding::Srgb, [188, 0, 255])] {
        let target = Target { encoding, ..stage.target() };
        // SAFETY: as in `Stage::renderer`.
        let mut renderer = unsafe { Renderer::new(stage.headless.context(), &target, &flat()) }.unwrap();
        let model = renderer.add_model(&square(0.5), &ModelOptions::default()).unwrap();
        let frame = stage.frame(&mut renderer);
        let picture =
            stage.draw(&mut renderer, frame, &[DrawItem::new(model, 1.0).color([0.5, 0.0, 1.0, 1.0])]).unwrap();
        assert_eq!(picture.at(0.0, 0.0)[..3], expected, "{encoding:?}");
    }
    stage.finish();
}
