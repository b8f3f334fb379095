//! Evaluation by compute: when it happens, and what evaluations say when they are used wrongly.

use crate::common::stage::{Stage, begin, read_vertices, with_segments};
use ash_subdiv::adaptive::{AdaptiveOptions, DrawnBy};
use ash_subdiv::gpu::{Allocation, AllocationRequest, Allocator, AllocatorError};
use ash_subdiv::renderer::{Evaluation, Factor, MemoryUsage, ModelTables};
use ash_subdiv::topology::Topology;
use ash_subdiv::{
    Construction, DeviceContext, DrawItem, Error, Fallback, ModelId, ModelOptions, Options, Renderer, Scheme, Spacing,
    Style, Target, View, requirements, shape,
};
use std::sync::Arc;

fn compute(scheme: Scheme) -> ModelOptions {
    ModelOptions { scheme, fallback: Fallback::Gregory, ..ModelOptions::evaluated(Evaluation::Compute) }
}

#[test]
fn vertices_follow_positions_and_segments() {
    let stage = Stage::new();
    let mesh = shape("creature").expect("built in");
    let patches = mesh.face_count() as u32;
    let options = Options { texcoords: true, ..Options::default() };
    let mut renderer = stage.renderer(&options);
    let model = renderer.add_model(&mesh, &compute(Scheme::Gregory)).expect("a model");
    let tessellated = ModelOptions { construction: Construction::Cached, ..ModelOptions::default() };
    let tessellated = renderer.add_model(&mesh, &tessellated).expect("a model");
    let picture = |renderer: &mut Renderer, frame, (model, factor): (ModelId, Factor)| {
        stage.draw(renderer, frame, &[DrawItem::new(model, factor)]).expect("a picture")
    };
    let small: Vec<_> = mesh.positions_f32().iter().map(|p| p.map(|x| 0.5 * x)).collect();
    renderer.set_segments(model, 4).unwrap();
    for (n, moves) in [(4, false), (4, true), (9, false), (9, true), (1, true), (3, true), (3, true), (3, false)] {
        renderer.set_segments(model, n).unwrap();
        let frame = begin(&mut renderer);
        if moves {
            let positions = if frame.index() == 1 { &small } else { &mesh.positions_f32() };
            renderer.set_positions(model, frame, positions).unwrap();
            renderer.set_positions(tessellated, frame, positions).unwrap();
        }
        stage.prepare(&mut renderer, frame);
        let vertices = renderer.evaluated_vertices(model).unwrap().unwrap();
        assert_eq!((vertices.segments, vertices.stride), (n, 32));
        assert_eq!(vertices.size, u64::from(patches * 32 * (n + 1) * (n + 1)));
        let both = [(model, Factor::Segments), (tessellated, Factor::Uniform(n as f32))];
        let [a, b] = both.map(|drawn| picture(&mut renderer, frame, drawn));
        let differ = a.iter().zip(&b).filter(|(a, b)| a.abs_diff(**b) > 2).count();
        assert!(a.iter().any(|&x| x > 0) && differ == 0, "{n} in {frame:?}: {differ}");
    }
    // The vertices, and indices of as many patches as the largest group has, at most.
    let MemoryUsage { vertices, indices, .. } = renderer.memory_usage();
    assert_eq!(vertices, u64::from(patches * 32 * 16));
    assert!(indices > 0 && indices <= u64::from(patches * 4 * 6 * 9), "{indices}");
    // Texture coordinates are bilinear in each patch.
    let words = read_vertices(&stage.headless, &renderer, model);
    let topology = Topology::new(&mesh);
    let corners = renderer.tables(model).unwrap().plan().texcoords(&topology).expect("texture coordinates");
    for (patch, corners) in words.chunks_exact(8 * 16).zip(corners.chunks_exact(4)) {
        for (at, corner) in [0, 3, 15, 12].into_iter().zip(corners) {
            assert_eq!(patch[8 * at + 6..8 * at + 8], *corner);
        }
    }
    drop(renderer);
    stage.finish();
}

/// What happens before a frame.
#[derive(Clone, Copy, PartialEq)]
enum Change {
    None,
    Vertices,
    Segments(u32),
}

/// Invocations of compute shader and geometry shader in frames of three passes.
fn counts<const FRAMES: usize>(options: &ModelOptions, changes: [Change; FRAMES]) -> [[u64; 2]; FRAMES] {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&Options::default());
    let mesh = shape("cube").expect("built in");
    let model = renderer.add_model(&mesh, options).expect("a model");
    let mut segments = 5;
    renderer.set_segments(model, segments).unwrap();
    let counts = changes.map(|change| {
        let frame = begin(&mut renderer);
        match change {
            Change::None => {}
            Change::Vertices => renderer.set_positions(model, frame, &mesh.positions_f32()).unwrap(),
            Change::Segments(other) => {
                segments = other;
                renderer.set_segments(model, segments).unwrap();
            }
        }
        let view = View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0);
        // SAFETY: outside rendering, then inside; each submission is waited for.
        let counted = stage.headless.counted(|cmd| unsafe {
            renderer.cmd_prepare(cmd, frame)?;
            for _ in 0..3 {
                stage.target.cmd_begin(cmd, [0.0; 4]);
                renderer.cmd_draw(cmd, frame, &view, &[DrawItem::new(model, Factor::Segments)])?;
                stage.target.cmd_end(cmd);
            }
            Ok::<_, Error>(())
        });
        let counted = counted.expect("counts");
        assert_eq!((counted.evaluation_invocations, counted.control_patches), (0, 0));
        assert_eq!(counted.clipping_invocations, 3 * 6 * 2 * u64::from(segments * segments));
        [counted.compute_invocations, counted.geometry_invocations]
    });
    drop(renderer);
    stage.finish();
    counts
}

#[test]
fn several_passes_evaluate_once() {
    // The first of anything makes all; other segments need other vertices of the same control points.
    let changes = [Change::None, Change::None, Change::Vertices, Change::Segments(3)];
    // 8 rings in a group of 64, 6 patches in another, and a group of 32 for each patch.
    let points = 64 + 64;
    let vertices = 6 * 32;
    let options = compute(Scheme::Gregory);
    assert_eq!(counts(&options, changes), [[points + vertices, 0], [0, 0], [points + vertices, 0], [vertices, 0]]);
    let instanced = ModelOptions { evaluation: Evaluation::Instanced, ..options.clone() };
    assert_eq!(counts(&instanced, changes), [[points, 0], [0, 0], [points, 0], [0, 0]]);
    let two_pass = ModelOptions { evaluation: Evaluation::GeometryTwoPass, ..options };
    assert_eq!(counts(&two_pass, changes), [[0, 24], [0, 0], [0, 24], [0, 0]]);
}

/// lavapipe counts the primitives of a geometry shader that emits none by what the last one left behind.
#[test]
fn two_passes_can_be_counted_after_other_geometry_shaders() {
    let stage = Stage::new();
    let evaluations = vec![Evaluation::Geometry, Evaluation::GeometryTwoPass];
    let mut renderer = stage.renderer(&Options { evaluations: evaluations.clone(), ..Options::default() });
    let mesh = shape("cube").expect("built in");
    let near = View::perspective([0.0, 0.0, 2.0], [0.0; 3], [0.0, 1.0, 0.0], 0.3, 1.0, [0.1, 9.0]);
    for evaluation in evaluations {
        let model =
            renderer.add_model(&mesh, &ModelOptions { evaluation, ..compute(Scheme::Gregory) }).expect("a model");
        let item = DrawItem::new(model, with_segments(&mut renderer, model, evaluation, 2));
        let frame = begin(&mut renderer);
        // SAFETY: outside rendering, then inside; the submission is waited for.
        let counted = stage.headless.counted(|cmd| unsafe {
            renderer.cmd_prepare(cmd, frame)?;
            stage.target.cmd_begin(cmd, [0.0; 4]);
            renderer.cmd_draw(cmd, frame, &near, &[item])?;
            stage.target.cmd_end(cmd);
            Ok::<_, Error>(())
        });
        assert_eq!(counted.expect("counts").clipping_invocations, 6 * 2 * 4, "{evaluation:?}");
        renderer.remove_model(model).unwrap();
    }
    drop(renderer);
    stage.finish();
}

/// Also how finely a patch is cut at most, which the host knows: it is of the frame that was prepared.
#[test]
fn factors_of_edges_wait_for_their_frame() {
    let stage = Stage::new();
    let mesh = shape("cube").expect("built in");
    let mut renderer = stage.renderer(&Options { evaluations: vec![Evaluation::Geometry], ..Options::default() });
    for evaluation in [Evaluation::Tessellation, Evaluation::Geometry] {
        let options = ModelOptions { edge_factors: true, evaluation, ..compute(Scheme::Gregory) };
        let model = renderer.add_model(&mesh, &options).expect("a model");
        let edges = renderer.tables(model).unwrap().edges().expect("edges").vertices.len();
        let frame = begin(&mut renderer);
        let draw = |renderer: &mut Renderer, frame, set: Option<f32>, prepare: bool| {
            if let Some(factor) = set {
                renderer.set_edge_factors(model, frame, &vec![factor; edges]).expect("factors");
            }
            if prepare {
                stage.prepare(renderer, frame);
            }
            stage.draw(renderer, frame, &[DrawItem::new(model, Factor::Edges(1.0))]).expect("a picture")
        };
        let fine = draw(&mut renderer, frame, Some(6.0), true);
        assert!(draw(&mut renderer, frame, Some(1.0), false) == fine, "{evaluation:?}");
        let frame = begin(&mut renderer);
        assert!(draw(&mut renderer, frame, None, true) != fine, "{evaluation:?}");
    }
    drop(renderer);
    stage.finish();
}

// Longer than a screen: a list of cases on one renderer.
#[test]
fn wrong_use_is_told() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&Options { styles: vec![Style::default()], ..Options::default() });
    let mesh = shape("cube").expect("built in");
    let text = |error: Error| error.to_string();
    let fractional = ModelOptions { spacing: Spacing::FractionalOdd, ..compute(Scheme::Gregory) };
    let shared = ModelOptions { shared_normals: true, ..compute(Scheme::Gregory) };
    let of_stencils = ModelOptions { construction: Construction::Stencil, ..shared.clone() };
    for (evaluation, options, what) in [
        (Evaluation::Compute, &fractional, "fractional spacing"),
        (Evaluation::Instanced, &fractional, "fractional spacing"),
        (Evaluation::GeometryTwoPass, &fractional, "fractional spacing"),
        (Evaluation::GeometryTwoPass, &shared, "shared normals"),
        (Evaluation::Geometry, &of_stencils, "shared normals of Construction::Stencil"),
    ] {
        let error = text(renderer.add_model(&mesh, &ModelOptions { evaluation, ..options.clone() }).unwrap_err());
        let told = format!(
            "model 0: Evaluation::{evaluation:?} does not go with {what}: do without, or choose Evaluation::Tessellation"
        );
        assert_eq!(error, told);
    }
    let tables = ModelTables::new(&mesh, &compute(Scheme::Gregory)).expect("tables");
    let other = ModelOptions { evaluation: Evaluation::GeometryTwoPass, ..compute(Scheme::Gregory) };
    assert_eq!(
        text(renderer.add_tables(tables, &mesh.positions_f32(), &other).unwrap_err()),
        "model 0: its tables were built for Evaluation::Compute, not for GeometryTwoPass: build them with the same options"
    );
    let adaptive = Some(AdaptiveOptions { drawn_by: DrawnBy::Leaves, ..AdaptiveOptions::default() });
    let by_leaves = ModelOptions { adaptive, construction: Construction::Cached, ..ModelOptions::default() };
    let tables = ModelTables::new(&mesh, &by_leaves).expect("tables");
    assert_eq!(
        text(renderer.add_tables(tables, &mesh.positions_f32(), &compute(Scheme::Gregory)).unwrap_err()),
        "model 0: Evaluation::Compute does not go with patches by leaves: do without, or choose Evaluation::Tessellation"
    );
    let options = ModelOptions { construction: Construction::TwoStage, ..compute(Scheme::Gregory) };
    assert_eq!(
        text(renderer.add_model(&mesh, &options).unwrap_err()),
        "model 0: Evaluation::Compute goes with Construction::Cached, not with TwoStage"
    );
    let model = renderer.add_model(&mesh, &compute(Scheme::Gregory)).unwrap();
    let other = renderer.add_model(&mesh, &ModelOptions::default()).unwrap();
    assert_eq!(
        text(renderer.set_segments(other, 4).unwrap_err()),
        "model 1: Evaluation::Tessellation takes its segments from DrawItem::factor: set_segments and Factor::Segments are for others"
    );
    assert_eq!(
        text(renderer.evaluated_vertices(other).unwrap_err()),
        "model 1: no vertices of it are kept: set ModelOptions::evaluation to Compute"
    );
    let geometry = ModelOptions { evaluation: Evaluation::Geometry, ..compute(Scheme::Gregory) };
    let geometry = renderer.add_model(&mesh, &geometry).unwrap();
    assert_eq!(
        text(renderer.set_segments(geometry, 4).unwrap_err()),
        "model 2: Evaluation::Geometry takes its segments from DrawItem::factor: set_segments and Factor::Segments are for others"
    );
    for segments in [0, 1025] {
        let error = text(renderer.set_segments(model, segments).unwrap_err());
        assert_eq!(error, format!("model 0: {segments} segments: from 1 to 1024 are possible along an edge"));
    }
    assert_eq!(renderer.evaluated_vertices(model).unwrap(), None);
    let frame = stage.frame(&mut renderer);
    let draw_in = |renderer: &mut Renderer, frame, model, factor: Factor| {
        stage.draw(renderer, frame, &[DrawItem::new(model, factor)]).map_err(text)
    };
    assert_eq!(
        draw_in(&mut renderer, frame, geometry, Factor::Uniform(1024.5)),
        Err("model 2: 1025 segments: from 1 to 1024 are possible along an edge".into())
    );
    assert_eq!(
        draw_in(&mut renderer, frame, geometry, Factor::Edges(2.0)),
        Err("model 2: its edges have no factors: set ModelOptions::edge_factors when you add it, or draw with another Factor".into())
    );
    let sized = View::framing(mesh.bounds(), [0.0, 0.0, 1.0], 1.0).sized(8, 8);
    let by_pixels = DrawItem::new(geometry, Factor::Pixels(2.0));
    // SAFETY: nothing is submitted, for it fails.
    let error = stage.headless.try_submit(|cmd| unsafe { renderer.cmd_draw(cmd, frame, &sized, &[by_pixels]) });
    assert_eq!(
        text(error.unwrap_err()),
        "model 2: Pixels(2.0): Evaluation::Geometry has one factor for all edges: draw with a uniform one"
    );
    let draw = |renderer: &mut Renderer, frame, factor: Factor| draw_in(renderer, frame, model, factor);
    let own = |factor: &str, n: u32| {
        Err(format!(
            "model {n}: {factor}: Evaluation::Compute has the segments of set_segments: draw with Factor::Segments"
        ))
    };
    assert_eq!(draw(&mut renderer, frame, Factor::Uniform(4.0)), own("Uniform(4.0)", 0));
    assert_eq!(
        draw(&mut renderer, frame, Factor::Segments),
        Err("model 0: no segments are set: call set_segments before cmd_prepare".into())
    );
    assert_eq!(
        draw_in(&mut renderer, frame, geometry, Factor::Segments),
        Err("model 2: Evaluation::Geometry takes its segments from DrawItem::factor: set_segments and Factor::Segments are for others".into())
    );
    renderer.set_segments(model, 4).unwrap();
    assert_eq!(
        draw(&mut renderer, frame, Factor::Segments),
        Err("model 0: it was not yet prepared: record cmd_prepare after add_model and set_segments, and before cmd_draw".into())
    );
    // Never copied, and gone.
    renderer.set_segments(model, 3).unwrap();
    renderer.set_segments(model, 4).unwrap();
    let frame = stage.frame(&mut renderer);
    assert!(draw(&mut renderer, frame, Factor::Segments).is_ok());
    assert_eq!(draw(&mut renderer, frame, Factor::Uniform(5.0)), own("Uniform(5.0)", 0));
    let of_edges = ModelOptions { edge_factors: true, ..compute(Scheme::Gregory) };
    let of_edges = renderer.add_model(&mesh, &of_edges).unwrap();
    renderer.set_segments(of_edges, 4).unwrap();
    let frame = stage.frame(&mut renderer);
    assert!(draw_in(&mut renderer, frame, of_edges, Factor::Segments).is_ok());
    assert_eq!(draw_in(&mut renderer, frame, of_edges, Factor::Edges(1.0)), own("Edges(1.0)", 3));
    let tiles = ModelOptions { edge_factors: true, evaluation: Evaluation::Geometry, ..compute(Scheme::Gregory) };
    let tiles = renderer.add_model(&mesh, &tiles).unwrap();
    let frame = stage.frame(&mut renderer);
    assert!(draw_in(&mut renderer, frame, tiles, Factor::Edges(1.0)).is_ok());
    for factor in [Factor::Uniform(4.0), Factor::Edges(0.5)] {
        let told = format!(
            "model 4: {factor:?}: Evaluation::Geometry with edges that have factors of their own takes these as they are: \
             draw with Factor::Edges(1.0)"
        );
        assert_eq!(draw_in(&mut renderer, frame, tiles, factor), Err(told));
    }
    drop(renderer);
    stage.finish();
}

/// Takes memory where another context does.
struct Borrowed(Arc<DeviceContext>);

// SAFETY: as the other context's.
unsafe impl Allocator for Borrowed {
    fn allocate(&self, request: &AllocationRequest<'_>) -> Result<Allocation, AllocatorError> {
        self.0.allocator().allocate(request)
    }

    unsafe fn free(&self, allocation: Allocation) {
        // SAFETY: as the caller promises.
        unsafe { self.0.allocator().free(allocation) }
    }
}

#[test]
fn evaluations_that_need_features_say_so() {
    let stage = Stage::new();
    let desc = stage.target.desc();
    let target = Target::dynamic(desc.color, desc.depth, desc.samples);
    let evaluations = vec![Evaluation::GeometryTwoPass, Evaluation::Compute];
    let options = Options { evaluations, visible_lists: true, ..Options::default() };
    let needs = requirements(&target, &options).features;
    assert!(needs.geometry && needs.vertex_stores);
    assert!(needs.indirect_first_instance && needs.multi_draw_indirect);
    let without = requirements(&target, &Options::default()).context_options();
    let (instance, device) = (stage.headless.instance(), stage.headless.device());
    let allocator = Arc::new(Borrowed(stage.headless.context().clone()));
    // SAFETY: the device is of the instance, has more than these features, and outlives the context; nothing is recorded.
    let context = unsafe { DeviceContext::new(instance, stage.headless.physical_device(), device, allocator, without) };
    // SAFETY: nothing is recorded.
    let error = unsafe { Renderer::new(&context, &target, &options) }.expect_err("an error").to_string();
    for feature in ["geometryShader (the device has it", "vertexPipelineStores", "drawIndirectFirstInstance"] {
        assert!(error.contains(feature), "{error}");
    }
    // SAFETY: nothing is recorded.
    let mut renderer = unsafe { Renderer::new(&context, &target, &Options::default()) }.expect("a renderer");
    for (evaluation, missing) in [
        (Evaluation::Geometry, "geometryShader"),
        (Evaluation::GeometryTwoPass, "vertexPipelineStoresAndAtomics and geometryShader"),
    ] {
        let options = ModelOptions { evaluation, construction: Construction::Cached, ..ModelOptions::default() };
        let error = renderer.add_model(&shape("cube").expect("built in"), &options).unwrap_err().to_string();
        let told = format!(
            "model 0: Evaluation::{evaluation:?} needs {missing}: name it in Options::evaluations and make the device with \
             what requirements lists then, or choose another evaluation"
        );
        assert_eq!(error, told);
    }
    let view = View::framing([glam::DVec3::NEG_ONE, glam::DVec3::ONE], [0.0, 0.0, 1.0], 1.0);
    let frame = stage.frame(&mut renderer);
    // SAFETY: the command buffer is being recorded, outside rendering.
    let error = stage.headless.try_submit(|cmd| unsafe { renderer.cmd_cull(cmd, frame, &view, &[]) }).unwrap_err();
    assert_eq!(
        error.to_string(),
        "cmd_cull goes with Options::visible_lists only: set it, and make the device with what requirements lists then"
    );
    drop((renderer, context));
    stage.finish();
}
