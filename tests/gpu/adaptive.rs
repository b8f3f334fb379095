//! Factors from the view, patches that are left out, and displacement by known amounts.
#![cfg(feature = "png")]

use crate::common;
use crate::common::edges::edge_points;
use crate::common::stage::Stage;
use ash_subdiv::capture::{CaptureDraw, Captured, CapturedFactors, CapturedVertex, Which};
use ash_subdiv::headless::{Headless, OffscreenDesc, Texels, Texture};
use ash_subdiv::renderer::{Cull, Evaluation, Factor, ModelTables};
use ash_subdiv::{
    Construction, ControlMesh, DrawItem, Error, Fallback, ModelOptions, Options, Renderer, Scheme, Spacing, Target,
    View, shape,
};
use glam::{DVec3, Mat4, Vec3};
use std::collections::HashMap;

pub const SIDE: u32 = 256;

pub fn view(mesh: &ControlMesh, towards: [f32; 3]) -> View {
    View::framing(mesh.bounds(), towards, 1.0).sized(SIDE, SIDE)
}

/// From near by, with much of the mesh out of the picture.
pub fn close_view(mesh: &ControlMesh) -> View {
    let [low, high] = mesh.bounds().map(|corner| corner.as_vec3());
    let (middle, radius) = ((low + high) / 2.0, (high - low).length() / 2.0);
    let eye = middle + Vec3::new(0.4, 0.3, 1.0) * (2.0 * radius);
    let target = middle + 0.5 * (high - middle);
    View::perspective(eye.into(), target.into(), [0.0, 1.0, 0.0], 0.25, 1.0, [0.1 * radius, 9.0 * radius])
        .sized(SIDE, SIDE)
}

/// The length in pixels of a cubic curve, as finely as can be told.
fn pixels(view: &View, curve: [[f32; 3]; 4], pieces: u32) -> f64 {
    let project = Mat4::from_cols_array_2d(&view.view_projection).as_dmat4();
    let at = |i: u32| {
        let t = f64::from(i) / f64::from(pieces);
        let s = 1.0 - t;
        let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        let point: DVec3 = curve.iter().zip(weights).map(|(p, w)| Vec3::from(*p).as_dvec3() * w).sum();
        let clip = project * point.extend(1.0);
        clip.truncate().truncate() / clip.w * f64::from(SIDE) / 2.0
    };
    (0..pieces).map(|i| at(i).distance(at(i + 1))).sum()
}

#[test]
fn segments_are_as_long_as_asked() {
    const ASKED: f64 = 4.0;
    let headless = common::headless();
    let mesh = shape("creature-mixed").expect("built in");
    let view = view(&mesh, [-0.6, 0.5, 1.0]);
    for construction in Construction::ALL {
        let options = ModelOptions { construction, ..ModelOptions::default() };
        let captured = Captured::new(&headless, &mesh, &options).expect("a model");
        let draw = CaptureDraw { view, ..CaptureDraw::new(Factor::Pixels(ASKED as f32)) };
        let factors = captured.factors(&draw).expect("a capture");
        let points = captured.control_points().expect("a capture");
        for ((patch, points), factors) in captured.tables().plan().patches().iter().zip(&points).zip(&factors) {
            for k in 0..patch.kind.corners() {
                let curve = edge_points(patch.kind, points, k);
                let asked = f64::from(factors.asked[k]) * ASKED;
                // The formula, and what it is meant to be: foreshortened and bent edges are not starved.
                assert!((asked - pixels(&view, curve, 4)).abs() < 2e-3 + 1e-4 * asked, "{asked} pixels");
                let exact = pixels(&view, curve, 200);
                assert!(asked <= exact + 2e-3 && asked > 0.9 * exact - 0.05, "{asked} pixels of {exact}");
            }
            assert!(!factors.culled);
        }
    }
    headless.finish_silent();
}

#[test]
fn bent_edges_get_more_than_flat_ones() {
    let headless = common::headless();
    let factors = |name: &str, factor: Factor| {
        let mesh = shape(name).expect("built in");
        let captured = Captured::new(&headless, &mesh, &ModelOptions::default()).expect("a model");
        let draw = CaptureDraw { view: view(&mesh, [-0.6, 0.5, 1.0]), ..CaptureDraw::new(factor) };
        captured.factors(&draw).expect("a capture")
    };
    let largest = |factors: &[CapturedFactors]| factors.iter().flat_map(|f| f.asked).fold(0.0, f32::max);
    // A flat sheet needs no segments at all, however large.
    assert!(largest(&factors("single-quad", Factor::Curvature(0.25))) < 1.0);
    let coarse = factors("torus", Factor::Curvature(1.0));
    let fine = factors("torus", Factor::Curvature(0.25));
    for (coarse, fine) in coarse.iter().zip(&fine) {
        for (coarse, fine) in coarse.asked.iter().zip(fine.asked) {
            // A quarter of the error takes twice the segments.
            assert!((fine / coarse - 2.0).abs() < 1e-3, "{coarse} and {fine}");
        }
    }
    headless.finish_silent();
}

/// Both patches at an edge ask for the same, to the bit, whatever is left out.
#[test]
fn edges_have_one_factor() {
    let headless = common::headless();
    let mesh = shape("creature-mixed").expect("built in");
    // Of the stencils of the other schemes, those of regular patches sum in another order.
    let watertight = [Scheme::Gregory, Scheme::GregoryFitted].map(|scheme| Construction::ALL.map(|how| (scheme, how)));
    let others = [Scheme::Acc, Scheme::Pm, Scheme::CPatch];
    let others = others.map(|scheme| [Construction::TwoStage, Construction::Cached].map(|how| (scheme, how)));
    for (scheme, construction) in watertight.as_flattened().iter().chain(others.as_flattened()) {
        have_one_factor(&headless, &mesh, *scheme, *construction);
    }
    headless.finish_silent();
}

fn have_one_factor(headless: &Headless, mesh: &ControlMesh, scheme: Scheme, construction: Construction) {
    let options = ModelOptions {
        edge_factors: true,
        scheme,
        construction,
        fallback: Fallback::Gregory,
        ..ModelOptions::default()
    };
    let captured = Captured::new(headless, mesh, &options).expect("a model");
    let edges = captured.tables().edges().expect("asked for");
    for factor in [Factor::Pixels(3.0), Factor::Curvature(0.3)] {
        for (view, cull) in [(view(mesh, [1.0, 0.2, 0.3]), Cull::NONE), (close_view(mesh), Cull::ALL)] {
            let draw = CaptureDraw { view, cull, ..CaptureDraw::new(factor) };
            let factors = captured.factors(&draw).expect("a capture");
            let mut of_edges: HashMap<u32, f32> = HashMap::new();
            let mut corner = 0;
            for (patch, factors) in captured.tables().plan().patches().iter().zip(&factors) {
                for asked in &factors.asked[..patch.kind.corners()] {
                    let before = *of_edges.entry(edges.of_corners[corner]).or_insert(*asked);
                    assert_eq!(before.to_bits(), asked.to_bits(), "{scheme:?}, {construction:?}");
                    corner += 1;
                }
            }
            let culled = factors.iter().filter(|f| f.culled).count();
            // The back faces of a bicubic patch with other normals, as of ACC, cannot be told.
            let enough = if scheme.is_watertight() { factors.len() / 4 } else { 0 };
            assert_eq!(culled > enough, cull != Cull::NONE, "{scheme:?}: {culled} of {}", factors.len());
        }
    }
}

/// By patch and parameters.
fn by_place(vertices: Vec<CapturedVertex>) -> HashMap<(u32, [u32; 3]), CapturedVertex> {
    vertices.into_iter().map(|v| ((v.patch, v.coordinate.map(f32::to_bits)), v)).collect()
}

#[test]
fn maps_move_vertices_as_far_as_they_say() {
    let headless = common::headless();
    let mesh = shape("creature").expect("built in");
    let plain = Captured::new(&headless, &mesh, &ModelOptions { shared_normals: true, ..ModelOptions::default() });
    let plain = by_place(plain.expect("a model").vertices(5.0).expect("a capture"));
    let flat = |values: &[f32]| Texels { width: 1, height: 1, channels: values.len() as u32, values: values.to_vec() };
    for (texels, vector) in [(flat(&[0.5]), None), (flat(&[0.1, -0.2, 0.3, 0.0]), Some(Vec3::new(0.1, -0.2, 0.3)))] {
        let texture = Texture::new(&headless, "flat", &texels).expect("a texture");
        // SAFETY: the texture outlives what is captured.
        let captured = unsafe { Captured::displaced(&headless, &mesh, &ModelOptions::default(), (&texture).into()) };
        let draw = CaptureDraw { displacement: [0.2, 0.01], ..CaptureDraw::new(5.0) };
        let moved = by_place(captured.expect("a model").vertices_of(&draw, Which::All).expect("a capture"));
        assert_eq!(moved.len(), plain.len());
        for (place, moved) in moved {
            let plain = plain[&place];
            assert_eq!(plain.normal, moved.normal);
            let way = match vector {
                None => Vec3::from(plain.normal) * (0.2 * 0.5 + 0.01),
                Some(vector) => 0.2 * vector + 0.01,
            };
            let expected = Vec3::from(plain.position) + way;
            assert!(expected.distance(moved.position.into()) < 1e-6, "{plain:?} {moved:?}");
        }
    }
    headless.finish_silent();
}

#[test]
fn wrong_use_is_told() {
    let headless = common::headless();
    let cube = shape("cube").expect("built in");
    let texture = Texture::new(&headless, "flat", &Texels { width: 1, height: 1, channels: 1, values: vec![0.5] });
    let texture = texture.expect("a texture");
    // SAFETY: the texture outlives what is captured.
    let displaced = |mesh, options: &ModelOptions| unsafe {
        Captured::displaced(&headless, mesh, options, (&texture).into()).err().expect("an error").to_string()
    };
    assert_eq!(
        displaced(&cube, &ModelOptions::default()),
        "the mesh has no texture coordinates, which displacement looks up: give it some (vt in OBJ, TEXCOORD_0 in glTF)"
    );
    let acc = ModelOptions { scheme: ash_subdiv::Scheme::Acc, shared_normals: true, ..ModelOptions::default() };
    assert_eq!(
        Captured::new(&headless, &cube, &acc).err().expect("an error").to_string(),
        "the scheme acc has no edges that both patches evaluate alike: for shared normals and displacement choose gregory"
    );
    let options = ModelOptions { edge_factors: true, spacing: Spacing::FractionalOdd, ..ModelOptions::default() };
    let captured = Captured::new(&headless, &cube, &options).expect("a model");
    let error = |draw: CaptureDraw| captured.factors(&draw).expect_err("an error").to_string();
    for viewport in [[0.0; 2], [5.0, -5.0], [f32::NAN, 5.0], [5.0, f32::INFINITY]] {
        let unsized_view = View { viewport, ..view(&cube, [0.0, 0.0, 1.0]) };
        assert_eq!(
            error(CaptureDraw { view: unsized_view, ..CaptureDraw::new(Factor::Pixels(2.0)) }),
            "model 0: factors in pixels and leaving out small patches need the size of the viewport: set View::viewport"
        );
    }
    assert_eq!(
        error(CaptureDraw { edge_factors: vec![1.0; 3], ..CaptureDraw::new(Factor::Edges(1.0)) }),
        "model 0: 3 factors are given, but its patches have 12 edges"
    );
    let mut factors = vec![1.0; 12];
    factors[7] = f32::NAN;
    assert_eq!(
        error(CaptureDraw { edge_factors: factors, ..CaptureDraw::new(Factor::Edges(1.0)) }),
        "model 0: edge 7: the factor NaN is no number"
    );
    let plain = Captured::new(&headless, &cube, &ModelOptions::default()).expect("a model");
    assert_eq!(
        plain.factors(&CaptureDraw::new(Factor::Edges(1.0))).expect_err("an error").to_string(),
        "model 0: its edges have no factors: set ModelOptions::edge_factors when you add it, or draw with another Factor"
    );
    assert_eq!(
        error(CaptureDraw { displacement: [f32::INFINITY, 0.0], ..CaptureDraw::new(1.0) }),
        "model 0: displacement by inf and 0 is not by finite numbers"
    );
    drop(texture);
    headless.finish_silent();
}

/// Near enough an edge asks for more segments than there are; it gets what there is.
#[test]
fn factors_are_kept_within_limits() {
    let headless = common::headless();
    let mesh = shape("cube").expect("built in");
    let captured = Captured::new(&headless, &mesh, &ModelOptions::default()).expect("a model");
    let draw = CaptureDraw { view: view(&mesh, [0.3, 0.4, 1.0]), ..CaptureDraw::new(Factor::Pixels(0.25)) };
    let factors = captured.factors(&draw).expect("a capture");
    let max = headless.properties().max_tessellation_level as f32;
    assert!(factors.iter().any(|f| f.asked.iter().any(|&asked| asked > max)));
    assert!(factors.iter().all(|f| f.inner.iter().all(|&inner| inner <= max)));
    // The eye inside: what is behind it makes no factor that is no number.
    let inside = View::perspective([0.1, 0.0, 0.0], [1.0, 0.2, 0.0], [0.0, 1.0, 0.0], 1.0, 1.0, [0.01, 10.0]);
    let draw = CaptureDraw { view: inside.sized(SIDE, SIDE), ..draw };
    for factors in captured.factors(&draw).expect("a capture") {
        assert!(factors.asked.iter().all(|asked| asked.is_finite() && *asked >= 0.0), "{factors:?}");
    }
    headless.finish_silent();
}

// Longer than a screen: a list of cases.
#[test]
fn wrong_displacement_is_told() {
    let headless = common::headless();
    let heights = |channels: u32| Texels { width: 1, height: 1, channels, values: vec![0.0; channels as usize] };
    let error = Texture::new(&headless, "pairs", &heights(2)).map(drop).unwrap_err().to_string();
    assert_eq!(error, "pairs: 2 numbers a texel: 1 or 4 are possible");
    assert_eq!(heights(0).range(), [f32::INFINITY, f32::NEG_INFINITY]);
    let few = Texels { width: 2, height: 3, channels: 1, values: vec![0.0; 5] };
    let error = Texture::new(&headless, "few", &few).map(drop).unwrap_err().to_string();
    assert_eq!(error, "few: 5 values are given, but its texels have 6");
    let huge = Texels { width: 1 << 30, ..few };
    let error = Texture::new(&headless, "huge", &huge).map(drop).unwrap_err().to_string();
    assert!(error.starts_with("huge: 1073741824 x 3 texels: the device has images of 1 to "), "{error}");

    let texture = Texture::new(&headless, "flat", &heights(1)).expect("a texture");
    let desc = OffscreenDesc::new(4, 4);
    let target = Target::dynamic(desc.color, desc.depth, desc.samples);
    let options =
        Options { evaluations: vec![Evaluation::GeometryTwoPass, Evaluation::Geometry], ..Options::default() };
    // SAFETY: nothing is drawn with either.
    let renderers = [(); 2].map(|()| unsafe { Renderer::new(headless.context(), &target, &options) });
    let [mut first, mut second] = renderers.map(|renderer| renderer.expect("a renderer"));
    // SAFETY: the texture outlives the renderer.
    let map = unsafe { first.add_displacement((&texture).into()) };
    let displacement = Some(map);
    let mesh = shape("creature").expect("built in");
    let error = second.add_model(&mesh, &ModelOptions { displacement, ..ModelOptions::default() }).unwrap_err();
    assert_eq!(
        error.to_string(),
        "displacement map 0: this renderer does not know it, or was told to forget it: call add_displacement first"
    );
    for (evaluation, construction, what) in [
        (Evaluation::GeometryTwoPass, Construction::Cached, "displacement"),
        (Evaluation::Geometry, Construction::Stencil, "displacement of Construction::Stencil"),
    ] {
        let options = ModelOptions { displacement, evaluation, construction, ..ModelOptions::default() };
        let told = format!(
            "model 0: Evaluation::{evaluation:?} does not go with {what}: do without, or choose Evaluation::Tessellation"
        );
        assert_eq!(first.add_model(&mesh, &options).unwrap_err().to_string(), told);
    }
    let plain = ModelOptions::default();
    for (option, other) in [
        ("displacement", ModelOptions { displacement, ..plain.clone() }),
        ("shared_normals", ModelOptions { shared_normals: true, ..plain.clone() }),
        ("edge_factors", ModelOptions { edge_factors: true, ..plain.clone() }),
    ] {
        for (built, asked, how) in [(&other, &plain, "with"), (&plain, &other, "without")] {
            let tables = ModelTables::new(&mesh, built).expect("tables");
            let told = format!(
                "model 0: its tables were built {how} ModelOptions::{option}, unlike its options: build them with the same \
                 options"
            );
            let error = first.add_tables(tables, &mesh.positions_f32(), asked).unwrap_err();
            assert_eq!(error.to_string(), told);
        }
    }
    // Of a mesh of which nothing is drawn.
    let mut data = mesh.data().clone();
    data.holes = (0..mesh.face_count() as u32).collect();
    let nothing = ControlMesh::new(data).expect("a mesh");
    let displaced = ModelOptions { displacement, ..ModelOptions::default() };
    let model = first.add_model(&nothing, &displaced).expect("a model without patches");
    // Maps are forgotten when no model uses them.
    let error = first.remove_displacement(map).unwrap_err();
    assert!(matches!(error, Error::DisplacementInUse { id, model: by } if (id, by) == (map, model)));
    assert_eq!(error.to_string(), "displacement map 0: model 0 uses it: remove that first");
    first.remove_model(model).expect("there is one");
    first.remove_displacement(map).expect("no model uses it");
    for error in [first.remove_displacement(map).unwrap_err(), first.add_model(&mesh, &displaced).unwrap_err()] {
        assert!(matches!(error, Error::NoSuchDisplacement { id } if id == map), "{error}");
    }
    // SAFETY: the texture outlives the renderer.
    let again = unsafe { first.add_displacement((&texture).into()) };
    assert_ne!(again, map);
    let displacement = Some(again);
    // Displacement shares normals, whether that is asked for or not.
    let [quiet, asked] =
        [false, true].map(|shared_normals| ModelOptions { displacement, shared_normals, ..plain.clone() });
    let tables = ModelTables::new(&mesh, &quiet).expect("tables");
    first.add_tables(tables, &mesh.positions_f32(), &asked).expect("a model");
    drop((first, second, texture));
    headless.finish_silent();
}

/// A map and its image may go when every frame was prepared after.
#[test]
fn maps_go_while_others_are_drawn() {
    let stage = Stage::new();
    let mesh = shape("creature").expect("built in");
    let texels = Texels { width: 2, height: 2, channels: 1, values: vec![0.0, 1.0, 1.0, 0.0] };
    let mut renderer = stage.renderer(&Options { frames_in_flight: 2, ..Options::default() });
    let plain = renderer.add_model(&mesh, &ModelOptions::default()).expect("a model");
    let before = {
        let frame = stage.frame(&mut renderer);
        stage.draw(&mut renderer, frame, &[DrawItem::new(plain, 3.0)]).expect("a picture")
    };
    for _ in 0..2 {
        let texture = Texture::new(&stage.headless, "map", &texels).expect("a texture");
        // SAFETY: the texture lives until as many frames began as there are in flight.
        let map = unsafe { renderer.add_displacement((&texture).into()) };
        let options = ModelOptions { displacement: Some(map), ..ModelOptions::default() };
        let model = renderer.add_model(&mesh, &options).expect("a model");
        let item = DrawItem { displacement: [0.05, 0.0], ..DrawItem::new(model, 3.0) };
        for _ in 0..2 {
            let frame = stage.frame(&mut renderer);
            let displaced = stage.draw(&mut renderer, frame, &[item]).expect("a picture");
            assert_ne!(displaced, before);
        }
        renderer.remove_model(model).expect("there is one");
        renderer.remove_displacement(map).expect("no model uses it");
        (0..2).for_each(|_| _ = stage.frame(&mut renderer));
        drop(texture);
        for _ in 0..2 {
            let frame = stage.frame(&mut renderer);
            assert_eq!(stage.draw(&mut renderer, frame, &[DrawItem::new(plain, 3.0)]).expect("a picture"), before);
        }
    }
    drop(renderer);
    stage.finish();
}
