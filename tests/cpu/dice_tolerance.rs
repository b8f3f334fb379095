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
    let dense = match mesh.face_count() {
        0..20 => Some(7),
        20..200 => Some(4),
        _ => None,
    };
    let dense = dense.map(|depth| Tessellation::<f64>::new(&Topology::new(mesh), &DiceOptions::fixed(depth)).unwrap());
    let dense: Vec<(DVec3, Place)> =
        dense.iter().flat_map(|d| d.positions().iter().map(|&p| p.into()).zip(d.places())).collect();
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
            let nearest = dense.iter().min_by(|(a, _), (b, _)| a.distance(point).total_cmp(&b.distance(point)));
            nearest.map_or(near, |(there, start)| near.min(there.distance(point)).min(distance(&surface, point, start)))
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
        let facets = mesh.corner_count();
        // Edges that are halved more often than the facet, too.
        let uneven = |most: u32| Depth::Each((0..facets as u32).map(|h| 1 + (h * h + h / 3) % most).collect());
        let depths = (1..=4).map(Depth::Fixed).chain([uneven(2), uneven(3), uneven(5)]);
        for depth in depths {
            let options = DiceOptions { depth, max_step: 8, ..DiceOptions::default() };
            let tessellation = Tessellation::new(&Topology::new(&mesh), &options).unwrap();
            let bound = tessellation.plan().error_bound().unwrap();
            let found = measure(&mesh, &tessellation);
            let histogram = tessellation.plan().depth_histogram();
            println!("{name}: {histogram:?}: {found:e} <= {bound:e}");
            assert!(found <= bound, "{name}: {histogram:?}: {found} <= {bound}");
        }
    }
}

/// The point of a facet, the corner of a face, with these parameters.
fn on_facet(face: u32, corners: u32, corner: u32, [u, v]: [f64; 2]) -> Place {
    let [a, b] = [u / 2.0, v / 2.0];
    let (sub, [u, v]) = match (corners, corner) {
        (4, 0) => (-1, [a, b]),
        (4, 1) => (-1, [1.0 - b, a]),
        (4, 2) => (-1, [1.0 - a, 1.0 - b]),
        (4, _) => (-1, [b, 1.0 - a]),
        _ => (corner as i32, [u, v]),
    };
    Place { face, sub, u: u as f32, v: v as f32 }
}

/// The limit surface around a face, as points of faces that touch it.
fn around(mesh: &ControlMesh, surface: &LimitSurface, face: u32, steps: u32) -> Vec<(DVec3, Place)> {
    let touches = |other: &u32| mesh.face(*other).iter().any(|vertex| mesh.face(face).contains(vertex));
    let others = (0..mesh.face_count() as u32).filter(|&other| other != face).filter(touches);
    let parts = others.flat_map(|other| surface.subs(other).map(move |sub| (other, sub)));
    let places = parts.flat_map(|(face, sub)| {
        (0..(steps + 1).pow(2)).map(move |i| {
            let [u, v] = [i % (steps + 1), i / (steps + 1)].map(|i| i as f32 / steps as f32);
            Place { face, sub, u, v }
        })
    });
    places.map(|p| (surface.evaluate(p.face, p.sub, p.u.into(), p.v.into()).position, p)).collect()
}

/// The greatest distance from points in the triangles of a facet that is halved so often to the limit surface.
fn distance_of_facet(mesh: &ControlMesh, surface: &LimitSurface, half_edge: usize, halvings: u32) -> f64 {
    let face = mesh.face_offsets().partition_point(|&first| first as usize <= half_edge) as u32 - 1;
    let (corners, corner) = (mesh.face(face).len() as u32, (half_edge - mesh.face_corners(face).start) as u32);
    let segments = 1u32 << halvings;
    let around = around(mesh, surface, face, 2 * segments);
    let at = |i: u32, j: u32| {
        let place = [i, j].map(|i| f64::from(i) / f64::from(segments));
        let on_face = on_facet(face, corners, corner, place);
        (surface.evaluate(face, on_face.sub, on_face.u.into(), on_face.v.into()).position, place)
    };
    let of_triangle = |points: [(DVec3, [f64; 2]); 3]| {
        let middle = points.iter().map(|(point, _)| *point).sum::<DVec3>() / 3.0;
        // Beyond the edges of the face, too.
        let mut beside: Vec<(f64, Place)> = around.iter().map(|(point, p)| (point.distance(middle), *p)).collect();
        beside.sort_by(|a, b| a.0.total_cmp(&b.0));
        let of_point = |weights: [f64; 3]| {
            let sum: f64 = weights.iter().sum();
            let point = (0..3).map(|i| weights[i] / sum * points[i].0).sum::<DVec3>();
            let place = [0, 1].map(|axis| (0..3).map(|i| weights[i] / sum * points[i].1[axis]).sum::<f64>());
            let starts = std::iter::once(on_facet(face, corners, corner, place));
            let starts = starts.chain(beside.iter().take(6).map(|(_, start)| *start));
            starts.map(|start| distance(surface, point, &start)).fold(f64::INFINITY, f64::min)
        };
        [[1.0, 1.0, 1.0], [0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]]
            .map(of_point)
            .into_iter()
            .fold(0.0, f64::max)
    };
    let of_cell = |cell: u32| {
        let (i, j) = (cell % segments, cell / segments);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        let halves = match a.0.distance(c.0) <= b.0.distance(d.0) {
            true => [[a, b, c], [a, c, d]],
            false => [[a, b, d], [b, c, d]],
        };
        halves.map(of_triangle).into_iter().fold(0.0, f64::max)
    };
    (0..segments * segments).map(of_cell).fold(0.0, f64::max)
}

/// Not many more faces than the least depth of each facet makes that keeps the tolerance, as far as points in its triangles tell.
#[test]
fn faces_are_hardly_more_than_they_must_be() {
    for (name, part, most) in [
        ("creature", 1e-4, 1.8),
        ("creature-mixed", 1e-3, 3.3),
        ("machine-part", 3e-4, 1.3),
        ("polygons", 1e-3, 1.2),
        ("torus", 1e-3, 1.05),
    ] {
        let mesh = shape(name).unwrap();
        let surface = LimitSurface::new(&mesh).unwrap();
        let tolerance = part * mesh.diagonal();
        let options = DiceOptions { depth: Depth::Tolerance(tolerance), max_depth: 8, max_step: 8 };
        let depths = Tessellation::<f64>::new(&Topology::new(&mesh), &options).unwrap().plan().depths();
        let faces = |depth: u32| 1u64 << (2 * depth);
        let of_facet = |half_edge: usize| {
            let is_kept = |&depth: &u32| distance_of_facet(&mesh, &surface, half_edge, depth - 1) <= tolerance;
            let best = (1..depths[half_edge]).find(is_kept).unwrap_or(depths[half_edge]);
            [faces(depths[half_edge]), faces(best)]
        };
        let some = (0..depths.len()).into_par_iter().step_by(depths.len() / 400 + 1);
        let [made, best] = some.map(of_facet).reduce(|| [0; 2], |[a, b], [c, d]| [a + c, b + d]);
        let ratio = made as f64 / best as f64;
        println!("{name}: {ratio} times the faces of the best depths");
        assert!(ratio <= most && best > 1000, "{name}: {made} faces, at best {best}");
    }
}
