//! The deviation of drawn triangles on the screen.
#![cfg(feature = "measure")]

use crate::common;
use ash_subdiv::capture::{CaptureDraw, Captured};
use ash_subdiv::headless::Headless;
use ash_subdiv::measure::{ScreenError, screen_error};
use ash_subdiv::renderer::{Cull, Factor};
use ash_subdiv::{ControlMesh, ModelOptions, Spacing, View, shape};
use glam::{DVec3, Vec3};

fn measure(headless: &Headless, mesh: &ControlMesh, view: View, factors: &[Factor], cull: Cull) -> Vec<ScreenError> {
    let captured = Captured::new(headless, mesh, &ModelOptions::default()).expect("a model");
    let error = |&factor: &Factor| {
        let draw = CaptureDraw { view, cull, ..CaptureDraw::new(factor) };
        screen_error(&captured, mesh, &draw).expect("a measurement")
    };
    factors.iter().map(error).collect()
}

fn view(mesh: &ControlMesh) -> View {
    View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0).sized(512, 512)
}

#[test]
fn flat_sheets_have_no_error() {
    let headless = common::headless();
    let mesh = shape("single-quad").expect("built in");
    for error in measure(&headless, &mesh, view(&mesh), &[Factor::Uniform(3.0), Factor::Pixels(8.0)], Cull::NONE) {
        assert!(error.shift.max < 1e-4 && error.shape.max < 1e-4 && error.facets.max < 1e-4, "{error:?}");
        // All of it is seen.
        assert_eq!(error.samples, 7 * error.triangles);
    }
    headless.finish_silent();
}

#[test]
fn errors_fall_with_the_square_of_the_factor() {
    let headless = common::headless();
    let mesh = shape("torus").expect("built in");
    let factors = [4.0, 8.0, 16.0, 32.0].map(Factor::Uniform);
    let errors = measure(&headless, &mesh, view(&mesh), &factors, Cull::NONE);
    for (coarse, fine) in errors.iter().zip(&errors[1..]) {
        assert_eq!(fine.triangles, 4 * coarse.triangles);
        for of in [|e: &ScreenError| e.shift, |e: &ScreenError| e.shape, |e: &ScreenError| e.facets] {
            let (coarse, fine) = (of(coarse), of(fine));
            for ratio in [coarse.rms / fine.rms, coarse.p99 / fine.p99, coarse.max / fine.max] {
                assert!((ratio - 4.0).abs() < 0.3, "{ratio}: {coarse:?} {fine:?}");
            }
            assert!(fine.rms < fine.p99 && fine.p99 <= fine.max);
        }
    }
    // All faces are regular, so that patches are the surface.
    assert!(errors.iter().all(|e| (e.shift.rms - e.facets.rms).abs() < 1e-4), "{errors:?}");
    // What faces away is not seen: about half.
    let part = |e: &ScreenError| e.samples as f64 / (7 * e.triangles) as f64;
    assert!(errors.iter().all(|e| e.shape.rms < e.shift.rms && (0.4..0.7).contains(&part(e))), "{errors:?}");
    headless.finish_silent();
}

/// From near by, factors that follow the view come as close with fewer triangles.
#[test]
fn adaptive_factors_need_fewer_triangles() {
    let headless = common::headless();
    let mesh = shape("creature").expect("built in");
    let [low, high] = mesh.bounds().map(DVec3::as_vec3);
    let (middle, radius) = ((low + high) / 2.0, (high - low).length() / 2.0);
    let eye = middle + Vec3::new(0.3, 0.2, 1.0).normalize() * (1.2 * radius);
    let view = View::perspective(eye.into(), middle.into(), [0.0, 1.0, 0.0], 0.9, 1.0, [0.01 * radius, 4.0 * radius]);
    let factors = [Factor::Pixels(8.0), Factor::Curvature(0.25), Factor::Uniform(8.0), Factor::Uniform(16.0)];
    let cull = Cull { frustum: true, ..Cull::NONE };
    let errors = measure(&headless, &mesh, view.sized(512, 512), &factors, cull);
    for adaptive in &errors[..2] {
        let uniform = errors[2..].iter().find(|uniform| uniform.facets.p99 <= adaptive.facets.p99);
        let uniform = uniform.expect("16 is fine enough");
        assert!(adaptive.triangles < uniform.triangles, "{errors:?}");
    }
    headless.finish_silent();
}

/// Whatever is drawn, the triangles of a patch cover its domain once.
#[test]
fn triangles_cover_their_patches() {
    let headless = common::headless();
    let mesh = shape("creature-mixed").expect("built in");
    for spacing in [Spacing::Equal, Spacing::FractionalOdd, Spacing::FractionalEven] {
        let options = ModelOptions { spacing, ..ModelOptions::default() };
        let captured = Captured::new(&headless, &mesh, &options).expect("a model");
        for factor in [Factor::Uniform(1.0), Factor::Uniform(6.3), Factor::Pixels(5.0)] {
            let mut areas = vec![0.0; captured.tables().plan().patches().len()];
            let draw = CaptureDraw { view: view(&mesh), ..CaptureDraw::new(factor) };
            let see = |triangles: &[[ash_subdiv::capture::CapturedVertex; 3]]| {
                for triangle in triangles {
                    assert!(triangle.iter().all(|vertex| vertex.patch == triangle[0].patch));
                    let [a, b, c] = triangle.map(|vertex| Vec3::from(vertex.coordinate).truncate().as_dvec2());
                    areas[triangle[0].patch as usize] += (b - a).perp_dot(c - a) / 2.0;
                }
                Ok(())
            };
            captured.triangles(&draw, see).expect("a capture");
            for (patch, area) in captured.tables().plan().patches().iter().zip(areas) {
                let whole: f64 = if patch.kind.is_triangular() { 0.5 } else { 1.0 };
                assert!((area.abs() - whole).abs() < 1e-4, "{:?}: {area} with {factor:?}, {spacing:?}", patch.kind);
            }
        }
    }
    headless.finish_silent();
}

#[test]
fn the_screen_has_a_size() {
    let headless = common::headless();
    let mesh = shape("cube").expect("built in");
    let captured = Captured::new(&headless, &mesh, &ModelOptions::default()).expect("a model");
    let view = View { viewport: [0.0; 2], ..view(&mesh) };
    let error = screen_error(&captured, &mesh, &CaptureDraw { view, ..CaptureDraw::new(1.0) });
    let message = error.expect_err("an error").to_string();
    assert_eq!(message, "deviations on the screen need its size in pixels: set View::viewport");
    headless.finish_silent();
}
