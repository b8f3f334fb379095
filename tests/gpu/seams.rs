//! Not one crack: bits of positions and normals where patches meet, under any factors, with displacement, for any order of
//! faces; and that each of the things that make it so is needed.
#![cfg(all(feature = "measure", feature = "png"))]

use crate::common;
use crate::common::random::{random_creased_mesh, random_mesh};
use ash_subdiv::adaptive::{AdaptiveOptions, DrawnBy};
use ash_subdiv::capture::{CaptureDraw, Captured, Which};
use ash_subdiv::headless::{Headless, Texels, Texture};
use ash_subdiv::measure::watertight::{Seams, Tally, compare, leaked_pixels, random_factors, with_seams_everywhere};
use ash_subdiv::mesh::FaceVarying;
use ash_subdiv::renderer::{Cull, Evaluation, Factor, ShaderId};
use ash_subdiv::{Construction, ControlMesh, MeshData, ModelOptions, ReadOptions, Spacing, View, read, shape, shapes};
use glam::Vec3;
use std::path::Path;
use std::process::Command;

const SIDE: u32 = 200;
/// Of the bounding box's diagonal.
const DISPLACEMENT: f32 = 0.05;

fn scales(headless: &Headless) -> Texture {
    let texels = Texels::open("assets/scales.png", false).expect("the built-in height map");
    Texture::new(headless, "scales", &texels).expect("a texture")
}

fn diagonal(mesh: &ControlMesh) -> f32 {
    let [low, high] = mesh.bounds();
    (high - low).length() as f32
}

fn view(mesh: &ControlMesh) -> View {
    View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0).sized(SIDE, SIDE)
}

pub fn with_texcoords(mesh: ControlMesh) -> ControlMesh {
    if mesh.data().texcoords.is_some() { mesh } else { with_seams_everywhere(&mesh).expect("the same mesh") }
}

/// Compares a mesh drawn with random factors, and with those that a view asks for; displaced or not. Gives what differs.
fn tally(
    headless: &Headless,
    mesh: &ControlMesh,
    options: &ModelOptions,
    texture: Option<&Texture>,
    seed: u64,
) -> Tally {
    let options = ModelOptions { edge_factors: true, shared_normals: true, ..options.clone() };
    let captured = match texture {
        // SAFETY: the texture outlives what is captured.
        Some(texture) => unsafe { Captured::displaced(headless, mesh, &options, texture.into()) },
        None => Captured::new(headless, mesh, &options),
    };
    let captured = captured.expect("a model");
    let seams = Seams::new(mesh, captured.tables()).expect("small");
    let edges = captured.tables().edges().expect("asked for").vertices.len();
    let displacement = if texture.is_some() { [DISPLACEMENT * diagonal(mesh), 0.0] } else { [0.0; 2] };
    let mut sum = Tally::default();
    // By leaves, one for all asks for another of each level.
    let by_leaves = options.adaptive.is_some_and(|adaptive| adaptive.drawn_by == DrawnBy::Leaves);
    for factor in
        [Factor::Edges(1.0), Factor::Pixels(9.0)].into_iter().chain(by_leaves.then_some(Factor::Uniform(11.0)))
    {
        // As many as make enough vertices of a small mesh.
        let most = (120_000.0 / edges as f32).clamp(9.0, 60.0);
        let edge_factors = random_factors(edges, most, seed);
        let draw = CaptureDraw { view: view(mesh), edge_factors, displacement, ..CaptureDraw::new(factor) };
        sum.add(compare(&captured, &seams, &draw, true).expect("a capture"));
    }
    sum
}

const SPACINGS: [Spacing; 3] = [Spacing::FractionalOdd, Spacing::FractionalEven, Spacing::Equal];

/// A mesh, its name, and the seed of its factors.
type Case = (String, ControlMesh, u64);

/// Meshes of three kinds: built-in shapes and random ones; shapes with their faces in another order; models, where they are.
fn cases() -> [Vec<Case>; 3] {
    let built_in = |name: &str| with_texcoords(shape(name).expect("built in"));
    let shapes = shapes().iter().zip(0..).map(|(info, seed)| (info.name.to_owned(), built_in(info.name), seed));
    let random = (0..3).flat_map(|seed| [random_mesh(seed), random_creased_mesh(seed)].map(|mesh| (mesh, seed)));
    let random = random.map(|(mesh, seed)| ("random".to_owned(), with_texcoords(mesh), seed));
    let order = [("creature-mixed", 7), ("machine-part", 8), ("valences", 9)];
    let order = order.map(|(name, seed)| (format!("{name}, in another order"), shuffled(&built_in(name), seed), seed));
    let mut files = if cfg!(shared) { common::files(&common::shared().join("meshes"), "obj") } else { Vec::new() };
    files.retain(|file| file.file_stem() != Some("catmark_fan".as_ref()));
    let options = ReadOptions { drop_isolated: true, ..ReadOptions::default() };
    let models = files
        .iter()
        .zip(0..)
        .map(|(file, seed)| (file.display().to_string(), with_texcoords(read(file, &options).expect("a mesh")), seed));
    [shapes.chain(random).collect(), order.into(), models.collect()]
}

/// Every mesh with a construction, displaced or not; with one spacing or another.
fn assert_watertight(construction: Construction) {
    let headless = common::headless();
    let texture = scales(&headless);
    let cases = cases();
    let mut samples = [0; 3];
    // Mesh by mesh last, so that all can use the same pipelines.
    for (k, spacing) in SPACINGS.into_iter().enumerate() {
        for displaced in [false, true] {
            let options = ModelOptions { construction, spacing, ..ModelOptions::default() };
            for (cases, samples) in cases.iter().zip(&mut samples) {
                let has_spacing = |seed: u64| (seed as usize + construction as usize) % 3 == k;
                for (name, mesh, seed) in cases.iter().filter(|(_, _, seed)| has_spacing(*seed)) {
                    let tally = tally(&headless, mesh, &options, displaced.then_some(&texture), *seed);
                    assert!(
                        tally.is_watertight(),
                        "{name} {construction:?} {spacing:?} displaced {displaced}: {tally:?}"
                    );
                    *samples += tally.samples;
                }
            }
        }
    }
    let [shapes, order, models] = samples;
    assert!(shapes > 330_000 && order > 10_000 && (models > 0) == cfg!(shared), "{samples:?} pairs");
    drop(texture);
    headless.finish_silent();
}

#[test]
fn meshes_are_watertight_in_two_stages() {
    assert_watertight(Construction::TwoStage);
}

#[test]
fn meshes_are_watertight_by_stencils() {
    assert_watertight(Construction::Stencil);
}

#[test]
fn meshes_are_watertight_when_cached() {
    assert_watertight(Construction::Cached);
}

/// Faces that are refined have their leaves evaluated: what two of them share by one of them.
#[test]
fn adaptive_surfaces_are_watertight() {
    let headless = common::headless();
    let texture = scales(&headless);
    let mut samples = 0;
    let built_in = ["creature-mixed", "machine-part", "valences", "cloth", "cube", "fan", "polygons"];
    let built_in = built_in.map(|name| (name.to_owned(), shape(name).expect("built in")));
    let random = (0..4).map(|seed| ("random".to_owned(), random_creased_mesh(seed)));
    let meshes: Vec<_> =
        built_in.into_iter().chain(random).map(|(name, mesh)| (name, with_texcoords(mesh))).zip(0..).collect();
    let (faces, leaves) = (DrawnBy::Faces, DrawnBy::Leaves);
    let by_faces = [(None, true, faces), (Some(0), true, faces), (Some(1), false, faces), (Some(3), true, faces)];
    let by_leaves = [(Some(0), false, leaves), (Some(2), true, leaves)];
    // Meshes last, so that all can use the same pipelines.
    for (way, (depth, displaced, drawn_by)) in by_faces.into_iter().chain(by_leaves).enumerate() {
        // Where depths differ, levels do by more than one.
        let sharp_depth = depth.filter(|_| drawn_by == leaves).map(|depth| 2 * depth);
        let adaptive =
            depth.map(|depth| AdaptiveOptions { depth, sharp_depth, drawn_by, ..AdaptiveOptions::default() });
        for (k, construction) in Construction::ALL.into_iter().enumerate() {
            let options =
                ModelOptions { construction, spacing: SPACINGS[(way + k) % 3], adaptive, ..ModelOptions::default() };
            for ((name, mesh), i) in meshes.iter().filter(|(_, i)| i % 3 == k) {
                // Faces of five and more corners are drawn by leaves in any case.
                if depth.is_none() && !mesh.data().face_sizes.iter().any(|&size| size > 4) {
                    continue;
                }
                let tally = tally(&headless, mesh, &options, displaced.then_some(&texture), *i as u64);
                assert!(
                    tally.is_watertight(),
                    "{name} depth {depth:?} by {drawn_by:?} displaced {displaced} {construction:?}: {tally:?}"
                );
                samples += tally.samples;
            }
        }
    }
    assert!(samples > 500_000, "{samples} pairs");
    drop(texture);
    headless.finish_silent();
}

/// Without the tessellation stages, too: with factors of edges and with one for all, displaced or not.
#[test]
fn uniform_grids_are_watertight() {
    let headless = common::headless();
    let texture = scales(&headless);
    let (mut samples, construction) = (0, Construction::Cached);
    for name in ["creature-mixed", "machine-part", "valences", "cloth"] {
        let mesh = with_texcoords(shape(name).expect("built in"));
        for (evaluation, displaced) in
            [Evaluation::Instanced, Evaluation::Geometry].into_iter().flat_map(|e| [(e, false), (e, true)])
        {
            let options = ModelOptions {
                construction,
                evaluation,
                edge_factors: true,
                shared_normals: true,
                ..ModelOptions::default()
            };
            let captured = match displaced {
                // SAFETY: the texture outlives what is captured.
                true => unsafe { Captured::displaced(&headless, &mesh, &options, (&texture).into()) },
                false => Captured::new(&headless, &mesh, &options),
            };
            let captured = captured.expect("a model");
            let seams = Seams::new(&mesh, captured.tables()).expect("small");
            let edges = captured.tables().edges().expect("asked for").vertices.len();
            let displacement = if displaced { [DISPLACEMENT * diagonal(&mesh), 0.0] } else { [0.0; 2] };
            let edge_factors = random_factors(edges, 12.0, 3);
            let draw = CaptureDraw { edge_factors, displacement, ..CaptureDraw::new(Factor::Edges(1.0)) };
            let tally = compare(&captured, &seams, &draw, true).expect("a capture");
            assert!(tally.is_watertight(), "{name} {evaluation:?} displaced {displaced}: {tally:?}");
            samples += tally.samples;
        }
    }
    assert!(samples > 20_000, "{samples} pairs");
    drop(texture);
    headless.finish_silent();
}

/// The same surface with faces in another order, and every face from another of its corners on.
fn shuffled(mesh: &ControlMesh, seed: u64) -> ControlMesh {
    let keys = random_factors(mesh.face_count(), 5.0, seed);
    let mut order: Vec<usize> = (0..mesh.face_count()).collect();
    order.sort_by(|&a, &b| keys[a].total_cmp(&keys[b]));
    let data = mesh.data();
    let texcoords = data.texcoords.as_ref();
    let (mut face_sizes, mut face_vertices, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for face in order {
        let corners: Vec<usize> = mesh.face_corners(face as u32).collect();
        face_sizes.push(corners.len() as u32);
        for k in 0..corners.len() {
            let h = corners[(k + keys[face] as usize) % corners.len()];
            face_vertices.push(data.face_vertices[h]);
            indices.extend(texcoords.map(|t| t.indices[h]));
        }
    }
    let texcoords = texcoords.map(|t| FaceVarying { values: t.values.clone(), indices });
    ControlMesh::new(MeshData { face_sizes, face_vertices, texcoords, ..data.clone() }).expect("the same mesh")
}

#[test]
fn closed_shapes_have_no_holes_in_pictures() {
    let headless = common::headless();
    let texture = scales(&headless);
    for (name, seed) in ["creature", "creature-mixed", "machine-part", "tetrahedron"].into_iter().zip(0..) {
        let mesh = with_texcoords(shape(name).expect("built in"));
        assert_eq!(mesh.boundary_edge_count(), 0, "{name} is closed");
        for (displaced, factor) in
            [(false, Factor::Edges(1.0)), (true, Factor::Edges(1.0)), (true, Factor::Pixels(5.0))]
        {
            let spacing = SPACINGS[seed as usize % 3];
            let options = ModelOptions { spacing, edge_factors: true, shared_normals: true, ..ModelOptions::default() };
            let tables = ash_subdiv::renderer::ModelTables::new(&mesh, &options).expect("tables");
            let edges = tables.edges().expect("asked for").vertices.len();
            let draw = CaptureDraw {
                view: view(&mesh),
                edge_factors: random_factors(edges, 9.0, seed),
                displacement: [if displaced { DISPLACEMENT * diagonal(&mesh) } else { 0.0 }, 0.0],
                // What is left out of the picture must not be missed.
                cull: Cull { frustum: true, small: !displaced, back: false },
                ..CaptureDraw::new(factor)
            };
            let texture = displaced.then_some(&texture);
            let leaked = leaked_pixels(&headless, &mesh, &options, texture, &draw, SIDE).expect("a picture");
            assert_eq!(leaked, 0, "{name} displaced {displaced} {factor:?}");
        }
    }
    drop(texture);
    headless.finish_silent();
}

/// A shader compiled with one thing left out.
fn faulty(id: ShaderId, fault: &str) -> Vec<u32> {
    let code = compiled(id, &[fault], &[]);
    if fault == "precise=" { without_invariance(&code) } else { code }
}

/// Without what keeps `gl_Position`, and all that it is made of, the same.
fn without_invariance(code: &[u32]) -> Vec<u32> {
    const HEADER_WORDS: usize = 5;
    const OP_MEMBER_DECORATE: u32 = 72;
    const INVARIANT: u32 = 18;
    let (header, mut rest) = code.split_at(HEADER_WORDS);
    let mut kept = header.to_vec();
    while let Some(&first) = rest.first() {
        let (instruction, after) = rest.split_at((first >> 16) as usize);
        if (first & 0xffff, instruction.last()) != (OP_MEMBER_DECORATE, Some(&INVARIANT)) {
            kept.extend(instruction);
        }
        rest = after;
    }
    assert!(kept.len() < code.len());
    kept
}

/// A shader of ours compiled with more macros, and with folders in which includes are looked for first.
pub fn compiled(id: ShaderId, defines: &[&str], folders: &[&str]) -> Vec<u32> {
    let compiler = std::env::var("GLSLANG").unwrap_or_else(|_| "glslangValidator".into());
    let name = format!("{}{}{}.spv", id.name(), defines.concat(), folders.concat().replace('/', "_"));
    let output = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let status = Command::new(compiler)
        .args(["-V", "--target-env", "vulkan1.2", "--quiet", "-o"])
        .arg(&output)
        .args(folders.iter().map(|folder| format!("-I{folder}")))
        .args(id.arguments())
        .args(defines.iter().map(|define| format!("-D{define}")))
        .arg(id.source())
        .status();
    assert!(status.expect("glslang runs").success(), "{id:?} {defines:?}");
    let bytes = std::fs::read(&output).expect("SPIR-V");
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().expect("four bytes"))).collect()
}

/// The shaders of a source that evaluate for a capture, of the patches that share their edges; `sharing` is the macro of what else
/// they share.
pub fn evaluations(source: &str, sharing: Option<&str>) -> Vec<ShaderId> {
    let is_wanted = |id: &&ShaderId| {
        let has = |argument: &str| id.arguments().contains(&argument);
        let shares = ["-DSHARED", "-DDISPLACED"].into_iter().find(|&argument| has(argument));
        id.source() == source && has("-DCAPTURE") && has("-DKEEPS_FRAME") && shares == sharing && !has("-DATTRIBUTES")
    };
    let ids: Vec<ShaderId> = ShaderId::ALL.iter().filter(is_wanted).copied().collect();
    let schemes = ["bicubic", "gregory"].map(|scheme| format!("-Iglsl/schemes/{scheme}"));
    let has = |scheme: &String| ids.iter().any(|id| id.arguments().contains(&scheme.as_str()));
    assert!(schemes.iter().all(has), "{ids:?}");
    ids
}

pub const TESSELLATION: &str = "glsl/evaluate/tessellation.tese";

/// What differs when the evaluation shaders are compiled with this macro.
fn tally_with(headless: &Headless, texture: &Texture, shared_normals: bool, displaced: bool, fault: &str) -> Tally {
    let mesh = shape("creature-mixed").expect("built in");
    let options = ModelOptions { shared_normals, edge_factors: true, ..ModelOptions::default() };
    let sharing = match (displaced, shared_normals) {
        (true, _) => Some("-DDISPLACED"),
        (false, true) => Some("-DSHARED"),
        (false, false) => None,
    };
    let shaders = evaluations(TESSELLATION, sharing).into_iter().map(|id| (id, faulty(id, fault)));
    let captured = match displaced {
        // SAFETY: the texture outlives what is captured.
        true => unsafe { Captured::displaced(headless, &mesh, &options, texture.into()) },
        false => Captured::new(headless, &mesh, &options),
    };
    let captured = captured.expect("a model").with_shaders(shaders.collect());
    let seams = Seams::new(&mesh, captured.tables()).expect("small");
    let displacement = if displaced { [DISPLACEMENT * diagonal(&mesh), 0.0] } else { [0.0; 2] };
    let draw = CaptureDraw { displacement, ..CaptureDraw::new(7.0) };
    compare(&captured, &seams, &draw, shared_normals).expect("a capture")
}

#[test]
fn every_rule_is_needed() {
    let headless = common::headless();
    let texture = scales(&headless);
    // As it is, nothing differs.
    for (shared_normals, displaced) in [(false, false), (true, false), (true, true)] {
        let tally = tally_with(&headless, &texture, shared_normals, displaced, "FAULT_NONE");
        assert!(tally.is_watertight() && tally.samples > 10_000, "{tally:?}");
    }
    // Sums that are not the same from both ends of an edge.
    let one_way = tally_with(&headless, &texture, true, false, "FAULT_ONE_WAY");
    assert!(one_way.normal_mismatches > 1000, "{one_way:?}");
    let displaced = tally_with(&headless, &texture, true, true, "FAULT_ONE_WAY");
    assert!(displaced.position_mismatches > 100, "{displaced:?}");
    // Each face's own normal.
    let own_normal = tally_with(&headless, &texture, true, false, "FAULT_OWN_NORMAL");
    assert!(own_normal.normal_mismatches > 1000, "{own_normal:?}");
    let displaced = tally_with(&headless, &texture, true, true, "FAULT_OWN_NORMAL");
    assert!(displaced.position_mismatches > 1000, "{displaced:?}");
    // A compiler that may do sums in any order.
    let imprecise = tally_with(&headless, &texture, false, false, "precise=");
    assert!(imprecise.position_mismatches > 100, "{imprecise:?}");
    drop(texture);
    headless.finish_silent();
}

/// As `glsl/lib/displace/displace.glsl` says.
#[test]
fn callers_displace_as_they_like() {
    let headless = common::headless();
    let texture = scales(&headless);
    let mesh = shape("creature-mixed").expect("built in");
    // Those for control points as attributes may be left away.
    let own = |source| {
        let ids = evaluations(source, Some("-DDISPLACED")).into_iter();
        ids.map(|id| (id, compiled(id, &["OWN_DISPLACE"], &["tests/glsl/own"]))).collect()
    };
    let cached = ModelOptions {
        evaluation: Evaluation::Instanced,
        construction: Construction::Cached,
        ..ModelOptions::default()
    };
    let ways: [(_, Vec<_>); 2] =
        [(ModelOptions::default(), own(TESSELLATION)), (cached, own("glsl/evaluate/instanced.vert"))];
    for (options, shaders) in ways {
        // SAFETY: the texture outlives what is captured.
        let displaced = unsafe { Captured::displaced(&headless, &mesh, &options, (&texture).into()) };
        let displaced = displaced.expect("a model").with_shaders(shaders);
        let plain = Captured::new(&headless, &mesh, &ModelOptions { shared_normals: true, ..options });
        let [moved, plain] = [&displaced, &plain.expect("a model")].map(|captured| {
            let mut vertices = captured.vertices(3.0).expect("a capture");
            vertices.sort_by_key(|v| (v.patch, v.coordinate.map(f32::to_bits)));
            vertices
        });
        assert_eq!(moved.len(), plain.len());
        for (moved, plain) in moved.iter().zip(&plain) {
            let expected = Vec3::from(plain.position) + Vec3::new(0.0, 0.0, 0.25);
            assert!(expected.distance(moved.position.into()) < 1e-6, "{plain:?} {moved:?}");
        }
    }
    drop(texture);
    headless.finish_silent();
}

/// Moving a factor through an integer moves no vertex by more than fractional spacing lets it: what the new vertices do, they
/// do from where their neighbours are.
#[test]
fn nothing_pops() {
    const STEP: f32 = 0.01;
    let headless = common::headless();
    let mesh = shape("cube").expect("built in");
    for spacing in [Spacing::FractionalOdd, Spacing::FractionalEven] {
        let options = ModelOptions { spacing, ..ModelOptions::default() };
        let captured = Captured::new(&headless, &mesh, &options).expect("a model");
        // The points on an edge, in order.
        let along = |factor: f32| {
            let vertices = captured.vertices_of(&CaptureDraw::new(factor), Which::OnEdges).expect("a capture");
            let mut edge: Vec<f32> =
                vertices.iter().filter(|v| v.patch == 0 && v.coordinate[1] == 0.0).map(|v| v.coordinate[0]).collect();
            edge.sort_by(f32::total_cmp);
            edge.dedup();
            edge
        };
        let mut before = along(2.5);
        for i in 1..=300 {
            let factor = 2.5 + STEP * i as f32;
            let now = along(factor);
            // Every vertex comes from one that was there, and goes to one that is: the way is that of the spacing, by which
            // a segment of length 1/f changes by STEP / f^2 for each of up to f segments before it; twice that for rounding
            // to 2^-16 and the segments that share what is left.
            let allowed = 4.0 * STEP / factor + 2.0 / 65536.0;
            let far = |from: &[f32], to: &[f32]| {
                let nearest = |x: f32| to.iter().map(|y| (x - y).abs()).fold(f32::INFINITY, f32::min);
                from.iter().map(|&x| nearest(x)).fold(0.0, f32::max)
            };
            let moved = far(&before, &now).max(far(&now, &before));
            assert!(moved <= allowed, "{spacing:?}: at {factor} a vertex moved by {moved} of the edge, not {allowed}");
            before = now;
        }
        // With equal spacing it does pop: the measure can fail.
    }
    let options = ModelOptions { spacing: Spacing::Equal, ..ModelOptions::default() };
    let captured = Captured::new(&headless, &mesh, &options).expect("a model");
    let count = |factor| captured.vertices_of(&CaptureDraw::new(factor), Which::OnEdges).expect("a capture").len();
    assert!(count(3.0) < count(3.01));
    headless.finish_silent();
}
