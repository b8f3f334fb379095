//! Creases of every sharpness on the GPU, against the limit surface.

use crate::common;
use ash_subdiv::adaptive::AdaptiveOptions;
use ash_subdiv::capture::Captured;
use ash_subdiv::headless::Headless;
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::mesh::{Crease, ReadOptions, read};
use ash_subdiv::table::grid_parameters;
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{Construction, ControlMesh, MeshData, ModelOptions, shape};
use glam::Vec3;
use rayon::prelude::*;

const DEPTH: u32 = 5;

/// From 0 to 8, in quarters.
fn sweep() -> impl Iterator<Item = f32> {
    (0..=32).map(|quarters| 0.25 * quarters as f32)
}

/// The mesh with all its creases as sharp as this.
fn sharpened(data: &MeshData, sharpness: f32) -> ControlMesh {
    let mut data = data.clone();
    data.creases.iter_mut().for_each(|crease| crease.sharpness = sharpness);
    data.creases.retain(|crease| crease.sharpness > 0.0);
    ControlMesh::new(data).expect("tags only")
}

/// The largest distances from the limit surface away from end caps: of positions as parts of the diagonal, and of normals. `side`
/// samples along each side of a face.
fn distance(headless: &Headless, mesh: &ControlMesh, construction: Construction, side: u32) -> [f64; 2] {
    let adaptive = Some(AdaptiveOptions { depth: DEPTH, ..AdaptiveOptions::default() });
    let options = ModelOptions { adaptive, construction, ..ModelOptions::default() };
    let limit = LimitSurface::new(mesh).expect("a surface");
    let captured = Captured::new(headless, mesh, &options).expect("a model");
    let samples = captured.grid(side).expect("a capture");
    let [low, high] = mesh.bounds();
    // End caps are cells of the last level in the corners of faces.
    let in_cap = |[u, v]: [f64; 2]| [u, v].into_iter().all(|t| t.min(1.0 - t) <= 1.0 / f64::from(1 << DEPTH));
    let refined = captured.tables().plan().patches().par_iter().zip(&samples);
    let refined = refined.filter(|(patch, _)| patch.kind == PatchKind::IrregularQuad);
    let of_patch = refined.flat_map_iter(|(patch, samples)| {
        let places = grid_parameters(PatchKind::Regular, side).into_iter().zip(samples);
        places.filter(|&(at, _)| !in_cap(at)).map(|([u, v], sample)| {
            let truth = limit.evaluate(patch.face, -1, u, v);
            let away = Vec3::from(sample.position).as_dvec3() - truth.position;
            let normal = Vec3::from(sample.normal).as_dvec3().normalize_or_zero();
            [away.length() / low.distance(high), (normal - truth.normal).length()]
        })
    });
    of_patch.reduce(|| [0.0; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])])
}

/// Sweeps the sharpness of all creases. Positions are the limit surface's but for rounding of `f32`, and normals to within `angle`.
fn sweeps(name: &str, data: &MeshData, side: u32, angle: f64) {
    let headless = common::headless();
    for (sharpness, construction) in sweep().zip(Construction::ALL.into_iter().cycle()) {
        let [position, normal] = distance(&headless, &sharpened(data, sharpness), construction, side);
        let construction = construction.name();
        println!("{name} {sharpness:5.2} {construction}: {position:8.1e} normals {normal:8.1e}");
        assert!(
            position < 1e-6 && normal < angle,
            "{name} {sharpness} {construction}: {position:e}, normals {normal:e}"
        );
    }
    headless.finish_silent();
}

#[test]
fn every_sharpness_on_a_cube() {
    let mut data = shape("cube").expect("built in").into_data();
    let top = data.face_vertices[..4].to_vec();
    data.creases = (0..4).map(|k| Crease { vertices: [top[k], top[(k + 1) % 4]], sharpness: 0.0 }).collect();
    sweeps("cube", &data, 42, 1e-5);
}

/// A bent sheet of quads, with a crease from end to end along its middle.
fn sheet() -> MeshData {
    let (columns, rows) = (7, 5);
    let mut data = MeshData::default();
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let [x, y] = [f64::from(i), f64::from(j)];
        data.positions.push([x, 2.0 - 0.5 * (x - 3.0).abs() + 0.3 * (y + 0.7 * x).sin(), y]);
    }
    for (j, i) in (1..rows).flat_map(|j| (1..columns).map(move |i| (j, i))) {
        let vertex = |i: u32, j: u32| j * columns + i;
        data.face_sizes.push(4);
        data.face_vertices.extend([vertex(i - 1, j - 1), vertex(i - 1, j), vertex(i, j), vertex(i, j - 1)]);
    }
    let vertex = |j: u32| j * columns + columns / 2;
    data.creases = (1..rows).map(|j| Crease { vertices: [vertex(j - 1), vertex(j)], sharpness: 0.0 }).collect();
    data
}

#[test]
fn every_sharpness_on_a_sheet() {
    sweeps("sheet", &sheet(), 24, 1e-5);
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn every_sharpness_on_the_car() {
    let car = read(common::shared().join("meshes/car.obj"), &ReadOptions::default()).expect("a mesh");
    // Its shortest edges are less than a thousandth of its diagonal: rounding turns them more.
    sweeps("car", car.data(), 6, 1e-4);
}
