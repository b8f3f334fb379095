//! Frames of thousands of patches at every size of batch: nothing is missing, nothing is drawn twice.
//!
//! lavapipe draws wrong pictures without an error when a draw instance has more than 65 536 tessellated vertices (bug A
//! of Mesa's llvmpipe), so patches are drawn in batches: [`ash_subdiv::gpu::PatchBatch`].
//!
//! What was seen with `PatchBatch::Unlimited` in their place: all counts and captured vertices stay right, the pictures
//! do not. Of the million pixels of a sheet, at factor 1 none was wrong, at factor 16 (5000 patches) all, at factor 8
//! (100 000 patches) half; and a frame took up to 60 times as long.

use crate::common;
use ash::vk;
use ash_subdiv::Scheme;
use ash_subdiv::capture::{Captured, CapturedVertex};
use ash_subdiv::gpu::Blend;
use ash_subdiv::headless::objects::{Domain, tessellated_vertices};
use ash_subdiv::headless::{Headless, Offscreen, OffscreenDesc, Statistics};
use ash_subdiv::renderer::Fragment;
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{
    Construction, ControlMesh, DrawItem, MeshData, ModelOptions, Options, Renderer, Spacing, Style, Target, View,
    grid_torus, replicate, shape, table::CpuSurface,
};
use glam::Vec3;

fn domain(kind: PatchKind) -> Domain {
    if kind == PatchKind::Triangle { Domain::Triangles } else { Domain::Quads }
}

/// Triangles of a patch all of whose factors are `n`.
fn primitives(kind: PatchKind, n: u64) -> u64 {
    // Rings of 6, 18, .. triangles around a point, or of 12, 24, .. around a triangle.
    if kind == PatchKind::Triangle { 3 * n * n / 2 } else { 2 * n * n }
}

fn torus(columns: u32, rows: u32) -> ControlMesh {
    ControlMesh::new(grid_torus(columns, rows)).expect("a torus")
}

/// 1774 patches a copy: regular quads, irregular quads and triangles.
fn herd(copies: u32) -> ControlMesh {
    replicate(&shape("creature-mixed").expect("built in"), [copies, 1, 1], 1.1).expect("small")
}

struct Picture {
    statistics: Statistics,
    pixels: Vec<u8>,
    counts: [u64; 4],
}

/// Draws every patch as it covers pixels: each adds one to the red of the pixels it covers.
fn draw(headless: &Headless, mesh: &ControlMesh, construction: Construction, factor: f32, view: &View) -> Picture {
    let desc = OffscreenDesc { color: vk::Format::R8G8B8A8_UNORM, ..OffscreenDesc::new(SIDE, SIDE) };
    let target = Offscreen::new(headless, &desc).expect("a target");
    let style = Style { fragment: Fragment::Flat, blend: Blend::Add, depth: None, ..Style::default() };
    let options = Options { styles: vec![style], ..Options::default() };
    let render_target = Target::dynamic(desc.color, desc.depth, desc.samples);
    // SAFETY: no handles are given, and every submission is waited for.
    let mut renderer = unsafe { Renderer::new(headless.context(), &render_target, &options) }.expect("a renderer");
    let model_options = ModelOptions { construction, ..ModelOptions::default() };
    let model = renderer.add_model(mesh, &model_options).expect("a model");
    let counts = PatchKind::ALL.map(|kind| renderer.tables(model).unwrap().patch_count(kind).into());
    let item = DrawItem::new(model, factor).color([1.0 / 255.0, 0.0, 0.0, 0.0]);
    // SAFETY: the command buffer is being recorded; rendering is begun and ended in it.
    let statistics = headless.counted(|cmd| unsafe {
        let frame = renderer.begin_frame();
        renderer.cmd_prepare(cmd, frame)?;
        target.cmd_begin(cmd, [0.0; 4]);
        renderer.cmd_draw(cmd, frame, view, &[item])?;
        target.cmd_end(cmd);
        target.cmd_read_back(cmd);
        Ok::<(), ash_subdiv::Error>(())
    });
    let pixels = target.pixels().expect("pixels").chunks_exact(4).map(|pixel| pixel[0]).collect();
    Picture { statistics: statistics.expect("a count"), pixels, counts }
}

fn check_counts(picture: &Picture, factor: u32) {
    let expected = |each: &dyn Fn(PatchKind) -> u64| -> u64 {
        PatchKind::ALL.iter().zip(picture.counts).map(|(&kind, count)| count * each(kind)).sum()
    };
    let vertices = |kind| u64::from(tessellated_vertices(domain(kind), Spacing::Equal, factor as f32, 64));
    let statistics = &picture.statistics;
    assert_eq!(statistics.control_patches, picture.counts.iter().sum::<u64>());
    // A device may evaluate a vertex more than once, lavapipe does not.
    assert_eq!(statistics.evaluation_invocations, expected(&vertices), "factor {factor}");
    assert_eq!(statistics.clipping_invocations, expected(&|kind| primitives(kind, factor.into())), "factor {factor}");
}

/// Pixels of a side of the picture, and those that the sheets keep free along its edges.
const SIDE: u32 = 1024;
const MARGIN: u32 = 12;

/// A flat sheet of quads over the middle 1000 x 1000 pixels, every third of them cut into two triangles if `mixed`.
fn sheet(columns: u32, rows: u32, mixed: bool) -> ControlMesh {
    let at = |i: u32, count: u32| 1000.0 * f64::from(i) / f64::from(count);
    let vertex = |i: u32, j: u32| j * (columns + 1) + i;
    let mut faces = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let quad = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            // A corner of the sheet with two faces would be rounded.
            let corner = (i == 0 || i + 1 == columns) && (j == 0 || j + 1 == rows);
            if mixed && !corner && (i + j) % 3 == 0 {
                faces.extend([vec![quad[0], quad[1], quad[2]], vec![quad[0], quad[2], quad[3]]]);
            } else {
                faces.push(quad.to_vec());
            }
        }
    }
    ControlMesh::new(MeshData {
        positions: (0..(columns + 1) * (rows + 1))
            .map(|v| [at(v % (columns + 1), columns), at(v / (columns + 1), rows), 0.0])
            .collect(),
        face_sizes: faces.iter().map(|f| f.len() as u32).collect(),
        face_vertices: faces.concat(),
        ..MeshData::default()
    })
    .expect("a sheet")
}

/// One unit of the sheet is one pixel.
fn straight_down() -> View {
    let scale = 2.0 / SIDE as f32;
    let shift = MARGIN as f32 * scale - 1.0;
    View {
        view_projection: [[scale, 0.0, 0.0, 0.0], [0.0, scale, 0.0, 0.0], [0.0; 4], [shift, shift, 0.5, 1.0]],
        eye: [0.0, 0.0, 1.0],
        light: [0.0, 0.0, 1.0],
        viewport: [0.0; 2],
        mirrored: false,
        measured_from: None,
    }
}

#[test]
fn every_pixel_is_covered_once() {
    let headless = common::headless();
    for (columns, rows, mixed, factors) in [
        (100, 40, true, &[1, 16, 64][..]),
        (100, 50, false, &[1, 16, 64]),
        (400, 250, false, &[1, 8]),
        (300, 250, true, &[1, 8]),
    ] {
        let mesh = sheet(columns, rows, mixed);
        for &factor in factors {
            let constructions = if factor == 16 { &Construction::ALL[..] } else { &[Construction::TwoStage] };
            for &construction in constructions {
                let picture = draw(&headless, &mesh, construction, factor as f32, &straight_down());
                let inside = |at: u32| (MARGIN..MARGIN + 1000).contains(&at);
                let wrong = (0..SIDE * SIDE)
                    .filter(|i| picture.pixels[*i as usize] != u8::from(inside(i % SIDE) && inside(i / SIDE)))
                    .count();
                assert_eq!(wrong, 0, "pixels of {columns} x {rows} quads (mixed: {mixed}) at factor {factor}");
                check_counts(&picture, factor);
            }
        }
    }
    headless.finish_silent();
}

#[test]
fn every_patch_is_evaluated_with_all_its_vertices() {
    let headless = common::headless();
    for (what, mesh, factors) in [
        ("5000 quads", torus(100, 50), &[1, 16, 64][..]),
        ("5322 quads and triangles", herd(3), &[1, 16]),
        ("100 000 quads", torus(400, 250), &[1, 8]),
        ("101 118 quads and triangles", herd(57), &[1]),
    ] {
        let surface = CpuSurface::new(&mesh, Scheme::Gregory, 0).expect("small");
        let points = surface.control_points(|p| p.as_vec3().as_dvec3());
        let captured = Captured::new(&headless, &mesh, &ModelOptions::default()).expect("a model");
        // The two-stage construction keeps the order of the twin.
        assert_eq!(captured.tables().plan(), surface.plan());
        let patches = surface.plan().patches();
        for &factor in factors {
            let vertices = captured.vertices(factor as f32).expect("a capture");
            check_presence(what, patches.iter().map(|p| p.kind), factor, &vertices);
            // A few units of rounding at the largest coordinate.
            let tolerance = 8.0 * f64::from(f32::EPSILON) * common::largest_coordinate(&mesh);
            for vertex in vertices.iter().step_by(97) {
                let patch = vertex.patch as usize;
                let [u, v, _] = vertex.coordinate.map(f64::from);
                let twin = Scheme::Gregory.evaluate(patches[patch].kind, &points[patch], u, v);
                let error = (Vec3::from(vertex.position).as_dvec3() - twin.position).length();
                assert!(error < tolerance, "{what} at factor {factor}: {vertex:?}, not {}", twin.position);
            }
        }
    }
    headless.finish_silent();
}

/// Each patch has as many different vertices as the tessellator makes, at places that are multiples of the spacing.
fn check_presence(what: &str, kinds: impl Iterator<Item = PatchKind>, factor: u32, vertices: &[CapturedVertex]) {
    let place = |x: f32| (f64::from(x) * 65536.0) as u64;
    let key = |v: &CapturedVertex| u64::from(v.patch) << 34 | place(v.coordinate[0]) << 17 | place(v.coordinate[1]);
    let mut keys: Vec<u64> = vertices.iter().map(key).collect();
    keys.sort_unstable();
    keys.dedup();
    let mut of_patch = keys.chunk_by(|a, b| a >> 34 == b >> 34);
    for (patch, kind) in kinds.enumerate() {
        let keys = of_patch.next().unwrap_or_default();
        let count = tessellated_vertices(domain(kind), Spacing::Equal, factor as f32, 64) as usize;
        let found = keys.first().map(|key| (key >> 34) as usize);
        assert_eq!((found, keys.len()), (Some(patch), count), "{what} at factor {factor}: {kind:?}");
    }
    assert!(of_patch.next().is_none());
}
