//! Frames as an engine records them: some twice, some that are thrown away.

use crate::common::random::Random;
use crate::common::stage::{Stage, begin, with_segments};
use ash_subdiv::adaptive::AdaptiveOptions;
use ash_subdiv::mesh::Crease;
use ash_subdiv::renderer::{Evaluation, Factor};
use ash_subdiv::topology::SHARP_FROM;
use ash_subdiv::{Construction, ControlMesh, DrawItem, Error, Frame, ModelId, ModelOptions, Options, Renderer, shape};

const SEGMENTS: u32 = 3;

/// What a model has that frames send: tables and positions; control points that compute makes; evaluated vertices and indices;
/// refined vertices.
fn ways() -> Vec<ModelOptions> {
    let adaptive = Some(AdaptiveOptions { depth: 2, ..AdaptiveOptions::default() });
    let cached = ModelOptions { construction: Construction::Cached, ..ModelOptions::default() };
    vec![
        ModelOptions { edge_factors: true, ..ModelOptions::default() },
        cached.clone(),
        ModelOptions { evaluation: Evaluation::Compute, ..cached.clone() },
        ModelOptions { evaluation: Evaluation::Instanced, adaptive, ..cached },
    ]
}

/// Records a frame's preparation and throws it away.
fn lose(stage: &Stage, renderer: &mut Renderer, frame: Frame) {
    // SAFETY: recorded outside rendering, and never run.
    stage.headless.record(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) }).expect("recorded");
    renderer.frame_lost(frame).expect("the newest");
}

fn moved(mesh: &ControlMesh, scale: f32) -> Vec<[f32; 3]> {
    mesh.positions_f32().iter().map(|p| p.map(|x| scale * x)).collect()
}

/// Also where the only frame in flight is prepared twice: its staging buffers are read until it is done.
#[test]
fn preparing_a_frame_twice_does_no_harm() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let mut renderer = stage.renderer(&Options { frames_in_flight: 1, ..Options::default() });
    for options in ways() {
        let model = renderer.add_model(&mesh, &options).expect("a model");
        let item = DrawItem::new(model, with_segments(&mut renderer, model, options.evaluation, SEGMENTS));
        let view = Stage::view();
        let mut picture = |scale: Option<f32>| {
            let frame = begin(&mut renderer);
            let record = |cmd| {
                // SAFETY: outside rendering, and then inside; the submission is waited for.
                unsafe {
                    renderer.cmd_prepare(cmd, frame)?;
                    if let Some(scale) = scale {
                        renderer.set_positions(model, frame, &moved(&mesh, scale))?;
                    }
                    renderer.cmd_prepare(cmd, frame)?;
                    renderer.cmd_prepare(cmd, frame)?;
                    stage.target.cmd_begin(cmd, [0.0; 4]);
                    renderer.cmd_draw(cmd, frame, &view, &[item])?;
                    stage.target.cmd_end(cmd);
                    stage.target.cmd_read_back(cmd);
                }
                Ok::<_, Error>(())
            };
            stage.headless.try_submit(record).expect("a frame");
            stage.target.pixels().expect("pixels")
        };
        let covered = |pixels: &[u8]| pixels.chunks(4).filter(|pixel| pixel[3] > 0).count();
        let whole = covered(&picture(None));
        let half = covered(&picture(Some(0.5)));
        assert!(whole > 1000 && half.abs_diff(whole / 4) < whole / 20, "{options:?}: {whole} {half}");
        renderer.remove_model(model).expect("a model");
    }
    drop(renderer);
    stage.finish();
}

/// A model as it should look.
struct Expected {
    model: ModelId,
    way: usize,
    scale: f32,
    factor: f32,
}

/// Whatever is added, moved and removed in whichever frames, a third of which are thrown away: what is drawn is what a renderer
/// draws that was told it at once.
// Longer than a screen: one course of random frames.
#[test]
fn lost_frames_change_nothing() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let ways = ways();
    let mut random = Random::new(20);
    let (mut lost, mut moves, mut pictures) = (0, 0, 0);
    for frames_in_flight in 1..=3 {
        let options = Options { frames_in_flight, ..Options::default() };
        let mut renderer = stage.renderer(&options);
        let mut all: Vec<Expected> = Vec::new();
        let mut index = 0;
        for _ in 0..60 {
            let frame = begin(&mut renderer);
            assert_eq!(frame.index(), index, "lost ones are not counted");
            match random.below(6) {
                0 | 1 if all.len() < 5 => {
                    let way = random.below(ways.len());
                    let model = renderer.add_model(&mesh, &ways[way]).expect("a model");
                    if ways[way].evaluation.needs_segments() {
                        renderer.set_segments(model, SEGMENTS).expect("segments");
                    }
                    all.push(Expected { model, way, scale: 1.0, factor: 1.0 });
                }
                2 if !all.is_empty() => {
                    let gone = all.swap_remove(random.below(all.len()));
                    renderer.remove_model(gone.model).expect("a model");
                }
                _ => {}
            }
            for expected in &mut all {
                if random.below(3) == 0 {
                    moves += 1;
                    expected.scale = 0.4 + 0.1 * random.below(7) as f32;
                    renderer.set_positions(expected.model, frame, &moved(&mesh, expected.scale)).expect("positions");
                }
                if expected.way == 0 && random.below(3) == 0 {
                    expected.factor = 1.0 + random.below(4) as f32;
                    set_factors(&mut renderer, expected, frame);
                }
            }
            if random.below(3) == 0 {
                lost += 1;
                lose(&stage, &mut renderer, frame);
                continue;
            }
            index = (index + 1) % frames_in_flight;
            stage.prepare(&mut renderer, frame);
            if all.is_empty() || random.below(4) > 0 {
                continue;
            }
            // One picture of all of them side by side.
            let drawn = draw(&stage, &mut renderer, frame, &all);
            let mut other = stage.renderer(&options);
            let again: Vec<Expected> = all.iter().map(|of| add(&mut other, &mesh, &ways[of.way], of)).collect();
            let first = begin(&mut other);
            for expected in &again {
                other.set_positions(expected.model, first, &moved(&mesh, expected.scale)).expect("positions");
                set_factors(&mut other, expected, first);
            }
            stage.prepare(&mut other, first);
            assert!(
                drawn == draw(&stage, &mut other, first, &again),
                "{frames_in_flight} in flight, picture {pictures}"
            );
            pictures += 1;
        }
    }
    assert!(lost > 30 && moves > 60 && pictures > 12, "{lost} {moves} {pictures}");
    stage.finish();
}

fn add(renderer: &mut Renderer, mesh: &ControlMesh, options: &ModelOptions, of: &Expected) -> Expected {
    let model = renderer.add_model(mesh, options).expect("a model");
    if options.evaluation.needs_segments() {
        renderer.set_segments(model, SEGMENTS).expect("segments");
    }
    Expected { model, ..*of }
}

fn set_factors(renderer: &mut Renderer, of: &Expected, frame: Frame) {
    if of.way == 0 {
        let edges = renderer.tables(of.model).expect("a model").edges().expect("asked for").vertices.len();
        renderer.set_edge_factors(of.model, frame, &vec![of.factor; edges]).expect("factors");
    }
}

fn draw(stage: &Stage, renderer: &mut Renderer, frame: Frame, all: &[Expected]) -> Vec<u8> {
    let item = |(i, of): (usize, &Expected)| {
        let factor = match ways()[of.way].evaluation {
            _ if of.way == 0 => Factor::Edges(1.0),
            evaluation if evaluation.needs_segments() => Factor::Segments,
            _ => Factor::Uniform(SEGMENTS as f32),
        };
        let at = glam::Vec3::new(0.8 * (i as f32 - 2.0), 0.0, 0.0);
        let transform = glam::Mat4::from_translation(at) * glam::Mat4::from_scale(glam::Vec3::splat(0.35));
        DrawItem { transform: transform.to_cols_array_2d(), ..DrawItem::new(of.model, factor) }
    };
    let items: Vec<DrawItem> = all.iter().enumerate().map(item).collect();
    stage.draw(renderer, frame, &items).expect("a picture")
}

/// What a lost frame was to send to models that are gone by now is not missed, and indices that others share are sent by the next.
#[test]
fn what_models_share_is_sent_after_all() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let way = ModelOptions {
        construction: Construction::Cached,
        evaluation: Evaluation::Instanced,
        ..ModelOptions::default()
    };
    let mut renderer = stage.renderer(&Options { frames_in_flight: 1, ..Options::default() });
    let [first, second] = [0; 2].map(|_| {
        let model = renderer.add_model(&mesh, &way).expect("a model");
        renderer.set_segments(model, SEGMENTS).expect("segments");
        model
    });
    let frame = begin(&mut renderer);
    lose(&stage, &mut renderer, frame);
    renderer.remove_model(first).expect("a model");
    let frame = stage.frame(&mut renderer);
    let pixels = stage.draw(&mut renderer, frame, &[DrawItem::new(second, Factor::Segments)]).expect("a picture");
    assert!(pixels.chunks(4).filter(|pixel| pixel[3] > 0).count() > 1000);
    drop(renderer);
    stage.finish();
}

/// Other tables in a model's place, also while those of before are on their way: it is drawn as a new one would be. A crease
/// sharpens, and faces change.
// Longer than a screen: one course of frames.
#[test]
fn a_model_takes_another_mesh() {
    let stage = Stage::new();
    let mut data = shape("cube").expect("built in").into_data();
    data.creases = [[0, 1], [1, 3], [3, 2], [2, 0]].map(|vertices| Crease { vertices, sharpness: 0.0 }).into();
    let soft = ControlMesh::new(data).expect("edges of the cube");
    let [half, sharp] = [0.7, 2.5].map(|sharpness| soft.with_sharpness(&[sharpness; 4], &[]).expect("sharpness"));
    let told = |creases: &[f32], corners: &[f32]| soft.with_sharpness(creases, corners).unwrap_err().to_string();
    assert_eq!(told(&[1.0; 3], &[]), "sharpness of 3 creases is given, but the mesh has 4");
    assert_eq!(told(&[1.0; 4], &[1.0]), "sharpness of 1 corners is given, but the mesh has 0");
    assert!(told(&[-1.0; 4], &[]).contains("sharpness is a number from 0 up"));
    let other = shape("valences").expect("built in");
    for options in ways() {
        let adaptive = options.adaptive;
        let mut pictures = Vec::new();
        for frames_in_flight in 1..=2 {
            let mut renderer = stage.renderer(&Options { frames_in_flight, ..Options::default() });
            let mut add = |mesh: &ControlMesh| {
                let model = renderer.add_model(mesh, &options).expect("a model");
                if options.evaluation.needs_segments() {
                    renderer.set_segments(model, SEGMENTS).expect("segments");
                }
                model
            };
            let model = add(&soft);
            let meshes = [&soft, &half, &sharp, &other, &soft];
            let news: Vec<ModelId> = meshes.iter().map(|mesh| add(mesh)).collect();
            let factor = match options.evaluation {
                evaluation if evaluation.needs_segments() => Factor::Segments,
                _ if options.edge_factors => Factor::Edges(1.0),
                _ => Factor::Uniform(SEGMENTS as f32),
            };
            for (i, (&mesh, &new)) in meshes.iter().zip(&news).enumerate() {
                let frame = begin(&mut renderer);
                // What a lost frame was to send is of tables that are gone.
                match i % 2 {
                    1 => {
                        renderer.set_mesh(model, meshes[i + 1]).expect("one that is never drawn");
                        // SAFETY: recorded outside rendering, and never run.
                        stage.headless.record(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) }).expect("recorded");
                    }
                    _ => stage.prepare(&mut renderer, frame),
                }
                renderer.set_mesh(model, mesh).expect("another mesh");
                if i % 2 == 1 {
                    renderer.frame_lost(frame).expect("the newest");
                }
                let frame = stage.frame(&mut renderer);
                let [drawn, expected] = [model, new]
                    .map(|model| stage.draw(&mut renderer, frame, &[DrawItem::new(model, factor)]).expect("a picture"));
                assert!(drawn == expected, "{options:?}: mesh {i}");
                pictures.push(drawn);
            }
            let frame = stage.frame(&mut renderer);
            renderer.set_mesh(model, &sharp).expect("another mesh");
            let early = stage.draw(&mut renderer, frame, &[DrawItem::new(model, factor)]).unwrap_err();
            assert!(matches!(early, Error::NotPrepared { .. }), "{early}");
            stage.prepare(&mut renderer, frame);
            let again = stage.draw(&mut renderer, frame, &[DrawItem::new(model, factor)]).expect("a picture");
            assert!(again == pictures[2]);
        }
        // Without a depth, sharpness is rounded.
        assert_eq!(pictures[0] != pictures[1], adaptive.is_some() || SHARP_FROM < 0.7, "{options:?}");
        assert!(pictures[0] != pictures[2] && pictures[2] != pictures[3] && pictures[0] == pictures[4]);
    }
    stage.finish();
}

/// Where edges stay, so do their factors.
#[test]
fn factors_of_edges_outlive_their_tables() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let mut renderer = stage.renderer(&Options::default());
    let options = ModelOptions { edge_factors: true, ..ModelOptions::default() };
    let model = renderer.add_model(&mesh, &options).expect("a model");
    let picture = |renderer: &mut Renderer, factor: Option<f32>| {
        let frame = begin(renderer);
        let edges = renderer.tables(model).expect("a model").edges().expect("asked for").vertices.len();
        if let Some(factor) = factor {
            renderer.set_edge_factors(model, frame, &vec![factor; edges]).expect("factors");
        }
        stage.prepare(renderer, frame);
        stage.draw(renderer, frame, &[DrawItem::new(model, Factor::Edges(1.0))]).expect("a picture")
    };
    let [coarse, fine] = [None, Some(5.0)].map(|factor| picture(&mut renderer, factor));
    assert!(coarse != fine);
    renderer.set_mesh(model, &mesh).expect("the same");
    assert!(picture(&mut renderer, None) == fine);
    renderer.set_mesh(model, &shape("valences").expect("built in")).expect("another");
    renderer.set_mesh(model, &mesh).expect("the first");
    assert!(picture(&mut renderer, None) == coarse);
    drop(renderer);
    stage.finish();
}
