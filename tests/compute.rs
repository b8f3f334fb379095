//! Evaluation by compute: the vertices are those of the tessellation stages, and what it says when it is used wrongly.
#![cfg(feature = "headless")]

mod common;

use ash::vk;
use ash_subdiv::capture::{Captured, CapturedVertex};
use ash_subdiv::gpu::{Buffer, BufferDesc, MemoryLocation};
use ash_subdiv::headless::{Headless, Offscreen, OffscreenDesc};
use ash_subdiv::renderer::{Evaluation, Factor};
use ash_subdiv::table::grid_parameters;
use ash_subdiv::topology::Topology;
use ash_subdiv::{
    Construction, ControlMesh, DrawItem, Error, Fallback, ModelId, ModelOptions, Options, Renderer, Scheme, Spacing,
    Style, Target, View, shape,
};
use common::edges::{bits, corner_parameters, edge_parameters, shared_edges};
use glam::Vec3;
use std::collections::HashMap;

type Vertex = [f32; 6];

fn compute(scheme: Scheme) -> ModelOptions {
    ModelOptions {
        scheme,
        fallback: Fallback::Gregory,
        construction: Construction::Cached,
        evaluation: Evaluation::Compute,
        ..ModelOptions::default()
    }
}

/// A picture, and a renderer for it.
struct Stage {
    target: Offscreen,
    headless: Headless,
}

impl Stage {
    fn new() -> Self {
        let headless = common::headless();
        Self { target: Offscreen::new(&headless, &OffscreenDesc::new(96, 96)).expect("an image"), headless }
    }

    fn renderer(&self, options: &Options) -> Renderer {
        let desc = self.target.desc();
        let target = Target::dynamic(desc.color, desc.depth, desc.samples);
        // SAFETY: every submission is waited for, and the renderer is dropped before the stage.
        unsafe { Renderer::new(self.headless.context(), &target, options) }.expect("a renderer")
    }

    fn prepare(&self, renderer: &mut Renderer, frame: u32) {
        // SAFETY: the command buffer is being recorded, and all frames before are done.
        self.headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) }).expect("a frame");
    }

    fn draw(&self, renderer: &mut Renderer, frame: u32, items: &[DrawItem]) -> Result<Vec<u8>, Error> {
        let view = View::framing([glam::DVec3::NEG_ONE, glam::DVec3::ONE], [-0.6, 0.5, 1.0], 1.0);
        let record = |cmd| {
            // SAFETY: as above, inside rendering.
            unsafe { renderer.cmd_draw(cmd, frame, &view, items) }
        };
        self.target.draw(&self.headless, [0.0; 4], record)
    }

    fn finish(self) {
        drop(self.target);
        self.headless.finish_silent();
    }
}

/// The vertices of a model that was prepared, as words.
fn read_vertices(headless: &Headless, renderer: &Renderer, model: ModelId) -> Vec<f32> {
    let vertices = renderer.evaluated_vertices(model).expect("a model").expect("segments");
    let (name, size) = ("vertices to read", vertices.size);
    let usage = vk::BufferUsageFlags::TRANSFER_DST;
    let desc = BufferDesc { name, size, usage, location: MemoryLocation::Readback };
    let buffer = Buffer::new(headless.context(), &desc).expect("a buffer");
    let region = vk::BufferCopy { size, ..vk::BufferCopy::default() };
    let device = headless.device();
    // SAFETY: both buffers hold the range; what wrote it was waited for.
    let copy = |cmd| unsafe { device.cmd_copy_buffer(cmd, vertices.buffer, buffer.raw(), &[region]) };
    headless.submit(copy).expect("a copy");
    buffer.read(0, size as usize / 4).expect("as many words")
}

/// Each patch on a lattice, as the compute shader evaluates it.
fn lattices(stage: &Stage, mesh: &ControlMesh, options: &ModelOptions, segments: u32) -> Vec<Vec<Vertex>> {
    let mut renderer = stage.renderer(&Options::default());
    let model = renderer.add_model(mesh, options).expect("a model");
    renderer.set_segments(model, segments).expect("segments");
    stage.prepare(&mut renderer, 0);
    let words = read_vertices(&stage.headless, &renderer, model);
    let mut vertices = words.chunks_exact(6).map(|v| [v[0], v[1], v[2], v[3], v[4], v[5]]);
    let patches = renderer.tables(model).unwrap().plan().patches();
    let lattices: Vec<Vec<Vertex>> = patches
        .iter()
        .map(|patch| vertices.by_ref().take(grid_parameters(patch.kind, segments + 1).len()).collect())
        .collect();
    assert!(vertices.next().is_none() && lattices.len() == patches.len());
    lattices
}

fn position(vertex: &Vertex) -> Vec3 {
    Vec3::new(vertex[0], vertex[1], vertex[2])
}

fn normal(vertex: &Vertex) -> Vec3 {
    Vec3::new(vertex[3], vertex[4], vertex[5])
}

/// Where a vertex lies, by numbers of segments: the tessellator's parameters are rounded.
fn place(patch: u32, [u, v]: [f64; 2], segments: u32) -> (u32, [u32; 2]) {
    (patch, [u, v].map(|x| (x * f64::from(segments)).round() as u32))
}

/// On an edge of a triangle.
fn on_edge(vertex: &CapturedVertex) -> bool {
    vertex.coordinate.contains(&0.0)
}

#[test]
fn vertices_are_those_of_the_tessellation_stages() {
    let stage = Stage::new();
    let shapes = [
        ("creature-mixed", &Scheme::ALL[..]),
        ("cube", &Scheme::ALL[..]),
        ("cloth", &[Scheme::Gregory]),
        ("pentagons", &[Scheme::Pm]),
    ];
    for (name, schemes) in shapes {
        let mesh = if name == "pentagons" { common::pentagons() } else { shape(name).expect("built in") };
        for &scheme in schemes {
            for segments in [1, 6, 13, 31] {
                let options = compute(scheme);
                let lattices = lattices(&stage, &mesh, &options, segments);
                let captured = Captured::new(&stage.headless, &mesh, &options).expect("a model");
                let patches = captured.tables().plan().patches();
                let what = || format!("{name} {scheme:?} {segments}");
                let tessellated = captured.vertices(segments as f32).expect("a capture");
                let at: HashMap<_, &CapturedVertex> = tessellated
                    .iter()
                    .filter(|v| patches[v.patch as usize].kind.is_triangular() <= on_edge(v))
                    .map(|v| (place(v.patch, [v.coordinate[0], v.coordinate[1]].map(f64::from), segments), v))
                    .collect();
                for (i, (patch, lattice)) in patches.iter().zip(&lattices).enumerate() {
                    let n = segments as f64;
                    for (uv, vertex) in grid_parameters(patch.kind, segments + 1).into_iter().zip(lattice) {
                        let w = 1.0 - uv[0] - uv[1];
                        let edge = uv[0] == 0.0 || uv[1] == 0.0 || w.abs() < 0.5 / n;
                        // Within triangles the tessellator has vertices elsewhere.
                        if patch.kind.is_triangular() && !edge {
                            continue;
                        }
                        let other = at[&place(i as u32, uv, segments)];
                        assert_eq!(bits(position(vertex)), bits(other.position), "{} {uv:?} {other:?}", what());
                        let turn = (normal(vertex) - Vec3::from(other.normal)).length();
                        assert!(turn < 1e-5, "{} {uv:?}: {turn}", what());
                    }
                }
                for (lattice, grid) in lattices.iter().zip(captured.grid(segments + 1).expect("a capture")) {
                    for (vertex, sample) in lattice.iter().zip(&grid) {
                        let off = (position(vertex) - Vec3::from(sample.position)).length();
                        let turn = (normal(vertex) - Vec3::from(sample.normal)).length();
                        // The grid's parameters are not rounded to 16 bits.
                        assert!(off < 5e-5 && turn < 1e-3, "{}: {off} {turn} {sample:?}", what());
                    }
                }
            }
        }
    }
    stage.finish();
}

#[test]
fn patches_meet_to_the_bit() {
    let stage = Stage::new();
    for name in ["creature-mixed", "machine-part", "cloth", "valences"] {
        let mesh = shape(name).expect("built in");
        let topology = Topology::new(&mesh);
        for segments in [2, 7, 19] {
            let options = compute(Scheme::Gregory);
            let lattices = lattices(&stage, &mesh, &options, segments);
            let mut renderer = stage.renderer(&Options::default());
            let model = renderer.add_model(&mesh, &options).expect("a model");
            let patches = renderer.tables(model).unwrap().plan().patches();
            let of_face: HashMap<u32, usize> = patches.iter().enumerate().map(|(i, p)| (p.face, i)).collect();
            for edge in shared_edges(&topology) {
                let [a, mut b] = edge.sides.map(|(face, k)| {
                    let patch = of_face[&face];
                    let kind = patches[patch].kind;
                    assert_eq!(corner_parameters(kind).len(), kind.corners());
                    let parameters = grid_parameters(kind, segments + 1);
                    let along = (0..=segments).map(|i| edge_parameters(kind, k, f64::from(i) / f64::from(segments)));
                    let at = |uv: [f64; 2]| {
                        let near = |other: &[f64; 2]| (0..2).all(|i| (uv[i] - other[i]).abs() < 1e-9);
                        bits(position(&lattices[patch][parameters.iter().position(near).expect("on the lattice")]))
                    };
                    along.map(at).collect::<Vec<_>>()
                });
                b.reverse();
                assert_eq!(a, b, "{name} {segments} {:?}", edge.sides);
            }
        }
    }
    stage.finish();
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
    let picture = |renderer: &mut Renderer, frame, model, n: f32| {
        stage.draw(renderer, frame, &[DrawItem::new(model, n)]).expect("a picture")
    };
    let small: Vec<_> = mesh.positions_f32().iter().map(|p| p.map(|x| 0.5 * x)).collect();
    renderer.set_segments(model, 4).unwrap();
    for (frame, n, moves) in [
        (0, 4, false),
        (1, 4, true),
        (0, 9, false),
        (1, 9, true),
        (0, 1, true),
        (1, 3, true),
        (0, 3, true),
        (1, 3, false),
    ] {
        renderer.set_segments(model, n).unwrap();
        if moves {
            let positions = if frame == 1 { &small } else { &mesh.positions_f32() };
            renderer.set_positions(model, frame, positions).unwrap();
            renderer.set_positions(tessellated, frame, positions).unwrap();
        }
        stage.prepare(&mut renderer, frame);
        let vertices = renderer.evaluated_vertices(model).unwrap().unwrap();
        assert_eq!((vertices.segments, vertices.stride), (n, 32));
        assert_eq!(vertices.size, u64::from(patches * 32 * (n + 1) * (n + 1)));
        let [a, b] = [model, tessellated].map(|model| picture(&mut renderer, frame, model, n as f32));
        let differ = a.iter().zip(&b).filter(|(a, b)| a.abs_diff(**b) > 2).count();
        assert!(a.iter().any(|&x| x > 0) && differ == 0, "{n} in frame {frame}: {differ}");
    }
    // The vertices, and indices of as many patches as the largest group has, at most.
    let indices = renderer.memory_usage().vertices - u64::from(patches * 32 * 16);
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

#[test]
fn several_passes_evaluate_once() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&Options::default());
    let mesh = shape("cube").expect("built in");
    let model = renderer.add_model(&mesh, &compute(Scheme::Gregory)).expect("a model");
    renderer.set_segments(model, 5).unwrap();
    let mut frame = |moves: bool| {
        if moves {
            renderer.set_positions(model, 0, &mesh.positions_f32()).unwrap();
        }
        let view = View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0);
        // SAFETY: outside rendering, then inside; each submission is waited for.
        let counted = stage.headless.counted(|cmd| unsafe {
            renderer.cmd_prepare(cmd, 0)?;
            for _ in 0..3 {
                stage.target.cmd_begin(cmd, [0.0; 4]);
                renderer.cmd_draw(cmd, 0, &view, &[DrawItem::new(model, 5.0)])?;
                stage.target.cmd_end(cmd);
            }
            Ok::<_, Error>(())
        });
        let counted = counted.expect("counts");
        assert_eq!((counted.evaluation_invocations, counted.control_patches), (0, 0));
        assert_eq!(counted.clipping_invocations, 3 * 6 * 2 * 25);
        counted.compute_invocations
    };
    // 24 corners in a group of 64, and a group of 32 for each patch.
    assert_eq!([true, false, true].map(&mut frame), [64 + 6 * 32, 0, 64 + 6 * 32]);
    drop(renderer);
    stage.finish();
}

#[test]
fn wrong_use_is_told() {
    let stage = Stage::new();
    let mut renderer = stage.renderer(&Options { styles: vec![Style::default()], ..Options::default() });
    let mesh = shape("cube").expect("built in");
    let text = |error: Error| error.to_string();
    let wrong = [
        (
            ModelOptions { construction: Construction::TwoStage, ..compute(Scheme::Gregory) },
            "constructions other than Construction::Cached",
        ),
        (ModelOptions { shared_normals: true, ..compute(Scheme::Gregory) }, "shared normals"),
        (ModelOptions { edge_factors: true, ..compute(Scheme::Gregory) }, "factors of edges"),
        (ModelOptions { spacing: Spacing::FractionalOdd, ..compute(Scheme::Gregory) }, "fractional spacing"),
    ];
    for (options, what) in wrong {
        let error = text(renderer.add_model(&mesh, &options).unwrap_err());
        let told = format!(
            "model 0: evaluation by compute does not go with {what}: do without, or choose Evaluation::Tessellation"
        );
        assert_eq!(error, told);
    }
    let model = renderer.add_model(&mesh, &compute(Scheme::Gregory)).unwrap();
    let other = renderer.add_model(&mesh, &ModelOptions::default()).unwrap();
    let told = "model 1: the tessellation stages evaluate it: set ModelOptions::evaluation to Compute";
    assert_eq!(text(renderer.set_segments(other, 4).unwrap_err()), told);
    assert_eq!(text(renderer.evaluated_vertices(other).unwrap_err()), told);
    for segments in [0, 1025] {
        let error = text(renderer.set_segments(model, segments).unwrap_err());
        assert_eq!(error, format!("model 0: {segments} segments: from 1 to 1024 are possible along an edge"));
    }
    assert_eq!(renderer.evaluated_vertices(model).unwrap(), None);
    stage.prepare(&mut renderer, 0);
    let draw = |renderer: &mut Renderer, factor: Factor| {
        stage.draw(renderer, 0, &[DrawItem::new(model, factor)]).map_err(text)
    };
    let told = |factor: &str, n: u32| {
        Err(format!(
            "model 0: {factor}: it was evaluated with {n} segments: call set_segments before cmd_prepare, and draw with that \
             number as uniform factor"
        ))
    };
    assert_eq!(draw(&mut renderer, Factor::Uniform(4.0)), told("Uniform(4.0)", 0));
    renderer.set_segments(model, 4).unwrap();
    assert_eq!(
        draw(&mut renderer, Factor::Uniform(4.0)),
        Err("model 0: it was not yet prepared: record cmd_prepare after add_model and before cmd_draw".into())
    );
    // Never copied, and gone.
    renderer.set_segments(model, 3).unwrap();
    renderer.set_segments(model, 4).unwrap();
    stage.prepare(&mut renderer, 0);
    assert!(draw(&mut renderer, Factor::Uniform(3.5)).is_ok());
    assert_eq!(draw(&mut renderer, Factor::Uniform(5.0)), told("Uniform(5.0)", 4));
    drop(renderer);
    stage.finish();
}
