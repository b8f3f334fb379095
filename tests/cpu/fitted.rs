//! The scheme gregory-fitted: where its numbers come from, and what they are worth on meshes that they were not fitted to.
#![cfg(feature = "measure")]

#[allow(dead_code, reason = "its `main` prints")]
#[allow(clippy::duplicate_mod, reason = "an example stands alone: it has its own copy of what tests have in common")]
#[path = "../../examples/fit_gregory.rs"]
mod fit_gregory;

use crate::common;
use ash_subdiv::measure::{ErrorOptions, FaceErrors, surface_errors};
use ash_subdiv::mesh::{ReadOptions, read};
use ash_subdiv::patch::fitted::Fit;
use ash_subdiv::{ControlMesh, Scheme, shape};

#[test]
fn the_fit_can_be_repeated() {
    let found = fit_gregory::fit(&fit_gregory::training_set().unwrap());
    let numbers = |fit: Fit| [&fit.tangent[..], &fit.lift, &[fit.triangle]].concat();
    for (found, ours) in numbers(found).into_iter().zip(numbers(Fit::GREGORY)) {
        assert!((found - ours).abs() < 1e-3, "{found:?} was found: run the example and copy what it prints");
    }
}

/// Of the schemes that have patches for the mesh, over all faces.
fn errors(mesh: &ControlMesh, schemes: &[Scheme], options: &ErrorOptions) -> Vec<(Scheme, FaceErrors)> {
    let report = surface_errors(mesh, schemes, options).unwrap();
    report.schemes.into_iter().filter_map(|(scheme, result)| Some((scheme, result.ok()?.all))).collect()
}

/// Fails unless normals are closer than this many times Gregory's, root mean square, and than those of any other scheme.
fn check_normals(name: &str, mesh: &ControlMesh, most: f64) {
    let errors = errors(mesh, &Scheme::ALL, &ErrorOptions { samples: 9, nearest: 0, ..ErrorOptions::default() });
    let rms = |wanted| errors.iter().find(|(scheme, _)| *scheme == wanted).expect("defined everywhere").1.normal.rms;
    let (gregory, fitted) = (rms(Scheme::Gregory), rms(Scheme::GregoryFitted));
    assert!(fitted < most * gregory, "{name}: {fitted}, Gregory's {gregory}");
    for (scheme, other) in errors.iter().filter(|(scheme, _)| *scheme != Scheme::GregoryFitted) {
        assert!(fitted < other.normal.rms, "{name}: {fitted}, {scheme:?} {}", other.normal.rms);
    }
}

/// Fails unless the surface is closer than this many times Gregory's, root mean square.
fn check_distance(name: &str, mesh: &ControlMesh, most: f64) {
    let options = ErrorOptions { samples: 2, nearest: 5000, ..ErrorOptions::default() };
    let errors = errors(mesh, &[Scheme::Gregory, Scheme::GregoryFitted], &options);
    let [gregory, fitted] = [0, 1].map(|i| errors[i].1.nearest.expect("measured").rms);
    assert!(fitted < most * gregory, "{name}: {fitted}, Gregory's {gregory}");
}

#[test]
fn built_in_shapes_are_closer() {
    for (name, most) in [("creature", 0.84), ("creature-mixed", 0.81), ("valences", 0.88)] {
        check_normals(name, &shape(name).unwrap(), most);
    }
    check_distance("creature", &shape("creature").unwrap(), 0.88);
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn meshes_from_elsewhere_are_closer() {
    for (name, normal, distance) in [("monsterfrog", 0.84, 0.99), ("bigguy", 0.87, 0.92), ("car", 0.89, 0.97)] {
        let path = common::shared().join("meshes").join(name).with_extension("obj");
        let mesh = read(&path, &ReadOptions::default()).unwrap();
        check_normals(name, &mesh, normal);
        check_distance(name, &mesh, distance);
    }
}
