//! Faces are as close to the limit surface as was asked for.

use ash_subdiv::dice::{Depth, DiceOptions, Place, Tessellation};
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::topology::Topology;
use ash_subdiv::{ControlMesh, shape};
use glam::{DMat2, DVec2, DVec3};
use rayon::prelude::*;
use std::collections::HashSet;

/// The distance from a point to the surface over one face or part of it, by Newton's method from a place there.
fn distance(surface: &LimitSurface, point: DVec3, start: &Place) -> f64 {
    let mut at = DVec2::new(start.u.into(), start.v.into()).clamp(DVec2::splat(1e-3), DVec2::splat(1.0 - 1e-3));
    let mut least = f64::INFINITY;
    for _ in 0..12 {
        let sample = surface.evaluate(start.face, start.sub, at.x, at.y);
        let rest = point - sample.position;
        least = least.min(rest.length());
        let (du, dv) = (sample.du, sample.dv);
        let normal_matrix = DMat2::from_cols_array(&[du.dot(du), du.dot(dv), du.dot(dv), dv.dot(dv)]);
        let step = normal_matrix.inverse() * DVec2::new(du.dot(rest), dv.dot(rest));
        if !step.is_finite() || step.length() < 1e-9 {
            break;
        }
        at = (at + step).clamp(DVec2::ZERO, DVec2::ONE);
    }
    least
}

/// The greatest distance from points in some of the faces to the limit surface.
pub fn measure(mesh: &ControlMesh, tessellation: &Tessellation<f64>) -> f64 {
    let surface = LimitSurface::new(mesh).unwrap();
    // Where facets are few, no vertex around need have its place on the face that is nearest.
    let dense = match mesh.face_count() < 20 {
        true => Tessellation::new(&Topology::new(mesh), &DiceOptions::fixed(7)).unwrap().positions().to_vec(),
        false => Vec::new(),
    };
    let places = tessellation.places();
    let faces = tessellation.all_triangles();
    // Vertices have places on one of their faces, so those around are looked at, too.
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); places.len()];
    let main = |vertex: u32| tessellation.plan().position_of(vertex);
    for face in &faces {
        face.iter().for_each(|&vertex| around[main(vertex) as usize].extend(face));
    }
    let of_face = |face: &[u32; 3]| {
        let corners = face.map(|vertex| DVec3::from(tessellation.positions()[vertex as usize]));
        let starts: HashSet<u32> = face.iter().flat_map(|&vertex| &around[main(vertex) as usize]).copied().collect();
        let points = [[1.0, 1.0, 1.0], [0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]];
        let of_point = |weights: [f64; 3]| {
            let sum: f64 = weights.iter().sum();
            let point = (0..3).map(|i| weights[i] / sum * corners[i]).sum::<DVec3>();
            let from = |&vertex: &u32| distance(&surface, point, &places[vertex as usize]);
            let near = starts.iter().map(from).fold(f64::INFINITY, f64::min);
            dense.iter().map(|&p| point.distance(p.into())).fold(near, f64::min)
        };
        points.map(of_point).into_iter().fold(0.0, f64::max)
    };
    let step = faces.len() / 400 + 1;
    faces.par_iter().step_by(step).map(of_face).reduce(|| 0.0, f64::max)
}

#[test]
fn faces_are_within_the_tolerance() {
    for (name, part) in
        [("creature", 1e-4), ("machine-part", 3e-4), ("valences", 4e-4), ("polygons", 1e-3), ("cube", 1e-5)]
    {
        let mesh = shape(name).unwrap();
        let tolerance = part * mesh.diagonal();
        let topology = Topology::new(&mesh);
        let options = DiceOptions { depth: Depth::Tolerance(tolerance), max_depth: 9, ..DiceOptions::default() };
        let tessellation = Tessellation::new(&topology, &options).unwrap();
        let bound = tessellation.plan().error_bound().unwrap();
        let histogram = tessellation.plan().depth_histogram();
        let found = measure(&mesh, &tessellation);
        println!("{name}: {found:e} <= {bound:e} <= {tolerance:e}, {histogram:?}");
        assert!(found <= bound && bound <= tolerance, "{name}: {found} <= {bound} <= {tolerance}: {histogram:?}");
        // No better by far than was asked for.
        assert!(found > tolerance / 16.0, "{name}: {found} of {tolerance}");
    }
}

#[test]
fn bounds_hold_at_every_depth() {
    for name in ["creature-mixed", "cloth", "tetrahedron", "fan"] {
        let mesh = shape(name).unwrap();
        for depth in 1..=4 {
            let tessellation = Tessellation::new(&Topology::new(&mesh), &DiceOptions::fixed(depth)).unwrap();
            let bound = tessellation.plan().error_bound().unwrap();
            let found = measure(&mesh, &tessellation);
            println!("{name}: depth {depth}: {found:e} <= {bound:e}");
            assert!(found <= bound, "{name}: depth {depth}: {found} <= {bound}");
        }
    }
}
