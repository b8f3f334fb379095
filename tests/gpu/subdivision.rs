//! Subdivision of faces in a geometry shader against refinement of the whole mesh on the CPU.

use crate::common;
use crate::common::edges::bits;
use ash::vk;
use ash_subdiv::capture::Captured;
use ash_subdiv::headless::{Headless, Offscreen, OffscreenDesc};
use ash_subdiv::limit::refine;
use ash_subdiv::mesh::{BoundaryRule, Corner, Crease, CreaseMethod, ReadOptions, read};
use ash_subdiv::patch::RingValues;
use ash_subdiv::renderer::Evaluation;
use ash_subdiv::table::prepare_quads;
use ash_subdiv::topology::{RingKind, Topology};
use ash_subdiv::{
    ControlMesh, DrawItem, MeshData, ModelOptions, Options, Renderer, Target, View, requirements, shape, shapes,
};
use glam::{DVec3, IVec2, Vec3};
use std::collections::HashMap;

const LEVELS: u32 = 3;
const CORNERS: [IVec2; 4] = [IVec2::ZERO, IVec2::X, IVec2::ONE, IVec2::Y];
const PLUS: [IVec2; 4] = [IVec2::X, IVec2::Y, IVec2::NEG_X, IVec2::NEG_Y];

fn options() -> ModelOptions {
    ModelOptions { evaluation: Evaluation::Subdivision, ..ModelOptions::default() }
}

/// The vertices of a face that was refined, by their place in a uniform grid, each as a corner of the refined mesh: child `k` of a
/// face is around its corner `k`.
fn uniform_grid(face: u32, levels: u32, origin: IVec2, [x, y]: [IVec2; 2], found: &mut HashMap<IVec2, u32>) {
    let side = 1 << levels;
    for k in 0..4 {
        let (at, plus) = (CORNERS[k], PLUS[k]);
        let turned = |v: IVec2| v.x * x + v.y * y;
        let origin = origin + side * turned(at);
        match levels {
            0 => _ = found.entry(origin).or_insert(4 * face + k as u32),
            _ => uniform_grid(4 * face + k as u32, levels - 1, origin, [turned(plus), turned(plus.perp())], found),
        }
    }
}

/// The normal at a corner, as far as there is one.
fn normal(topology: &Topology, corner: u32) -> DVec3 {
    let place = topology.place(corner);
    let ring = &topology.rings()[place.ring as usize];
    let values = RingValues::new(topology, ring, |v| topology.mesh().position(v));
    let frame = values.frame();
    let edge = |j| values.edge_vector(&frame, j);
    let j = place.index as usize;
    let [a, b] = match ring.kind {
        RingKind::Corner => [edge(j), edge(j + 1)],
        _ => [frame.a, frame.b],
    };
    let normal = a.cross(b);
    if normal.length() > 1e-4 * a.length() * b.length() { normal.normalize_or_zero() } else { DVec3::ZERO }
}

/// How far the GPU's normals are from the refined mesh's, at most. The more faces there are around a vertex, the more is rounded.
fn check(headless: &Headless, name: &str, mesh: &ControlMesh, faces: u32) -> f64 {
    let captured = Captured::new(headless, mesh, &options()).expect("a model");
    let (prepared, plan) = prepare_quads(mesh, 0).expect("small");
    assert_eq!(captured.tables().plan(), &plan);
    let mut data = prepared.mesh().clone().into_data();
    // The GPU starts from these.
    data.positions.iter_mut().for_each(|p| *p = p.map(|x| f64::from(x as f32)));
    let mut refined = ControlMesh::new(data).expect("as before");
    let tolerance = (4.0 + 0.1 * f64::from(faces)) * f64::from(f32::EPSILON) * common::largest_coordinate(mesh);
    let mut largest_turn = 0.0f64;
    for level in 0..=LEVELS {
        if level > 0 {
            refined = refine(&Topology::new(&refined)).expect("small").mesh;
        }
        let topology = Topology::new(&refined);
        let mut seen = HashMap::new();
        let grids = captured.grid((1 << level) + 1).expect("a capture");
        for (patch, grid) in plan.patches().iter().zip(&grids) {
            let mut corners = HashMap::new();
            uniform_grid(patch.face, level, IVec2::ZERO, [IVec2::X, IVec2::Y], &mut corners);
            assert_eq!(corners.len(), grid.len());
            for (at, corner) in corners {
                let vertex = &grid[(at.y * ((1 << level) + 1) + at.x) as usize];
                let what = || format!("{name}, level {level}, face {} at {at}: {vertex:?}", patch.face);
                let expected = refined.position(topology.mesh_vertex(corner));
                let off = (Vec3::from(vertex.position).as_dvec3() - expected).length();
                assert!(off <= tolerance, "{}: {off} of {tolerance}", what());
                let same = bits(vertex.position);
                assert_eq!(*seen.entry(topology.vertex(corner)).or_insert(same), same, "{}", what());
                let length = Vec3::from(vertex.normal).length();
                assert!((length - 1.0).abs() < 1e-5, "{}: {length}", what());
                let normal = normal(&topology, corner);
                if normal != DVec3::ZERO {
                    let turn = (Vec3::from(vertex.normal).as_dvec3() - normal).length();
                    assert!(turn < 2e-2, "{}: {turn} {normal}", what());
                    largest_turn = largest_turn.max(turn);
                }
            }
        }
    }
    largest_turn
}

#[test]
fn vertices_are_those_of_the_refined_mesh() {
    let headless = common::headless();
    for info in shapes() {
        let turn = check(&headless, info.name, &shape(info.name).expect("built in"), 0);
        assert!(turn < 1e-3, "{}: {turn}", info.name);
    }
    headless.finish_silent();
}

/// Creases and corners of any sharpness, ends of creases, crossings, and vertices of high valence, with each rule.
#[test]
fn sharpness_is_followed() {
    let headless = common::headless();
    let rules = [BoundaryRule::None, BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner];
    for (name, boundary) in ["cube", "cloth", "valences"].into_iter().zip(rules) {
        let mesh = shape(name).expect("built in");
        for crease_method in [CreaseMethod::Uniform, CreaseMethod::Chaikin] {
            let mut data = MeshData { boundary, crease_method, ..mesh.clone().into_data() };
            let topology = Topology::new(&mesh);
            let mut state = 1u32;
            let mut random = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 16) as f32 / 65_536.0
            };
            for h in 0..mesh.corner_count() as u32 {
                let sharpness = [0.3, 0.7, 1.0, 1.6, 2.5, 4.0, 10.0][(7.0 * random()) as usize];
                let vertices = [topology.mesh_vertex(h), topology.mesh_vertex(topology.next(h))];
                if vertices[0] < vertices[1] && random() < 0.25 {
                    data.creases.push(Crease { vertices, sharpness });
                } else if random() < 0.04 && data.corners.iter().all(|corner| corner.vertex != vertices[0]) {
                    data.corners.push(Corner { vertex: vertices[0], sharpness });
                }
            }
            assert!(data.creases.iter().any(|crease| crease.sharpness < 10.0));
            let mesh = ControlMesh::new(data).expect("tags only");
            check(&headless, &format!("{name} {boundary:?} {crease_method:?}"), &mesh, 0);
        }
    }
    headless.finish_silent();
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared/meshes")]
fn shared_meshes() {
    let headless = common::headless();
    let mut compared = 0;
    for file in std::fs::read_dir(common::shared().join("meshes")).expect("../shared/meshes") {
        let path = file.expect("a readable folder").path();
        // Some have edges with three faces.
        let Ok(mesh) = read(&path, &ReadOptions::default()) else { continue };
        check(&headless, &path.display().to_string(), &mesh, 0);
        compared += 1;
    }
    assert!(compared >= 30, "{compared}");
    headless.finish_silent();
}

/// Hundreds of faces around a vertex.
#[test]
fn valence_has_no_limit() {
    let headless = common::headless();
    for faces in [2, 37, 300] {
        // Two poles, with a zigzag around.
        let ring = |i: u32| 2 + i % (2 * faces);
        let top = (0..faces).flat_map(|i| [0, ring(2 * i), ring(2 * i + 1), ring(2 * i + 2)]);
        let bottom = (0..faces).flat_map(|i| [1, ring(2 * i + 3), ring(2 * i + 2), ring(2 * i + 1)]);
        let around = (0..2 * faces).map(|i| {
            let (sin, cos) = (std::f64::consts::PI * f64::from(i) / f64::from(faces)).sin_cos();
            [cos, if i % 2 == 0 { 0.3 } else { -0.3 }, sin]
        });
        let mesh = ControlMesh::new(MeshData {
            positions: [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]].into_iter().chain(around).collect(),
            face_sizes: vec![4; 2 * faces as usize],
            face_vertices: top.chain(bottom).collect(),
            // One pole with a crease that ends there, so that its faces are not all alike.
            creases: vec![Crease { vertices: [1, ring(1)], sharpness: 10.0 }],
            ..MeshData::default()
        });
        check(&headless, &format!("{faces} faces around a pole"), &mesh.expect("manifold"), faces);
    }
    headless.finish_silent();
}

/// Several levels of one model in one frame, and vertices that move.
#[test]
fn faces_follow_positions() {
    let headless = common::headless();
    let target = Offscreen::new(&headless, &OffscreenDesc::new(96, 96)).expect("an image");
    let desc = target.desc();
    let render_target = Target::dynamic(desc.color, desc.depth, desc.samples);
    let evaluations = vec![Evaluation::Subdivision];
    let options = Options { evaluations, texcoords: true, ..Options::default() };
    // SAFETY: every submission is waited for, and the renderer is dropped before the target.
    let mut renderer = unsafe { Renderer::new(headless.context(), &render_target, &options) }.expect("a renderer");
    let mesh = shape("creature").expect("built in");
    let model = renderer.add_model(&mesh, &self::options()).expect("a model");
    let view = View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0);
    let mut picture = |positions: &[[f32; 3]], factors: &[f32]| {
        // SAFETY: all frames before are done.
        let frame = unsafe { renderer.begin_frame() };
        renderer.set_positions(model, frame, positions).expect("as many");
        // SAFETY: outside rendering, then inside.
        headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) }).expect("prepared");
        let items: Vec<_> = factors.iter().map(|&factor| DrawItem::new(model, factor)).collect();
        target.draw(&headless, [0.0; 4], |cmd| unsafe { renderer.cmd_draw(cmd, frame, &view, &items) })
    };
    let positions = mesh.positions_f32();
    let half: Vec<_> = positions.iter().map(|p| p.map(|x| 0.5 * x)).collect();
    let covered = |pixels: &[u8]| pixels.chunks(4).filter(|pixel| pixel[3] > 0).count();
    let whole = covered(&picture(&positions, &[4.0]).expect("a picture"));
    let smaller = covered(&picture(&half, &[4.0]).expect("a picture"));
    assert!(whole > 1000 && smaller.abs_diff(whole / 4) < whole / 20, "{whole} {smaller}");
    let levels = covered(&picture(&positions, &[8.0, 1.0, 2.0]).expect("a picture"));
    assert!(levels >= whole, "{levels} {whole}");
    let error = picture(&positions, &[4.0, 3.0]).unwrap_err().to_string();
    let told = "model 0: Uniform(3.0): subdivision has uniform factors of 1, 2, 4 and 8, for levels 0 to 3";
    assert_eq!(error, told);
    drop(renderer);
    drop(target);
    headless.finish_silent();
}

/// What is captured is compiled otherwise than what is drawn. Each child of a face is turned to its corner, as the quarters are
/// that level 3 draws.
#[test]
fn a_level_less_of_a_refined_mesh_is_the_same_picture() {
    let headless = common::headless();
    let target = Offscreen::new(&headless, &OffscreenDesc::new(128, 128)).expect("an image");
    let desc = target.desc();
    let render_target = Target::dynamic(desc.color, desc.depth, desc.samples);
    let named = Options { evaluations: vec![Evaluation::Subdivision], ..Options::default() };
    // SAFETY: every submission is waited for, and the renderer is dropped before the target.
    let mut renderer = unsafe { Renderer::new(headless.context(), &render_target, &named) }.expect("a renderer");
    for name in ["creature", "machine-part", "valences", "cloth"] {
        let mesh = shape(name).expect("built in");
        let view = View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0);
        let mut picture = |refine, factor: f32| {
            let model = renderer.add_model(&mesh, &ModelOptions { refine, ..options() }).expect("a model");
            // SAFETY: all frames before are done.
            let frame = unsafe { renderer.begin_frame() };
            // SAFETY: outside rendering, then inside.
            headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, frame) }).expect("prepared");
            let item = [DrawItem::new(model, factor)];
            let draw = |cmd| unsafe { renderer.cmd_draw(cmd, frame, &view, &item) };
            target.draw(&headless, [0.0; 4], draw).expect("a picture")
        };
        let (whole, refined) = (picture(0, 8.0), picture(1, 4.0));
        let differ =
            whole.chunks(4).zip(refined.chunks(4)).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 8));
        // Rounding moves the silhouette by a pixel here and there.
        let differ = differ.count();
        assert!(differ <= 12, "{name}: {differ}");
    }
    drop(renderer);
    drop(target);
    headless.finish_silent();
}

#[test]
fn wrong_use_is_told() {
    let target = Target::dynamic(vk::Format::R8G8B8A8_SRGB, vk::Format::D32_SFLOAT, vk::SampleCountFlags::TYPE_1);
    let named = Options { evaluations: vec![Evaluation::Subdivision], ..Options::default() };
    assert!(requirements(&target, &named).features.geometry);
    assert!(!requirements(&target, &Options::default()).features.geometry);
    let headless = common::headless();
    // SAFETY: nothing is submitted, and the renderer is dropped before the device.
    let mut renderer = unsafe { Renderer::new(headless.context(), &target, &named) }.expect("a renderer");
    let mesh = shape("cube").expect("built in");
    let wrong = [
        (ModelOptions { shared_normals: true, ..options() }, "shared normals"),
        (ModelOptions { edge_factors: true, ..options() }, "factors of edges"),
    ];
    for (options, what) in wrong {
        let error = renderer.add_model(&mesh, &options).unwrap_err().to_string();
        let told = format!(
            "model 0: Evaluation::Subdivision does not go with {what}: do without, or choose Evaluation::Tessellation"
        );
        assert_eq!(error, told);
    }
    let polygons = shape("polygons").expect("built in");
    let model = renderer.add_model(&polygons, &options()).expect("a model");
    let notices: Vec<String> = renderer.notices(model).expect("a model").iter().map(ToString::to_string).collect();
    assert!(
        notices[0].ends_with("faces are no quads (the first is face 0): the whole mesh is refined once"),
        "{notices:?}"
    );
    drop(renderer);
    headless.finish_silent();
}
