//! Tessellations against the exact limit surface.

use crate::common::limit::{mesh_and_limit, names};
use crate::limit_surface::everything;
use ash_subdiv::dice::{Depth, DiceOptions, Real, Tessellation};
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::mesh::CreaseMethod;
use ash_subdiv::topology::Topology;
use ash_subdiv::{ControlMesh, shape, shapes};
use glam::DVec3;
use rayon::prelude::*;

/// Greatest errors: of positions over the diagonal, of normals in radians.
#[derive(Debug, Clone, Copy)]
struct Errors {
    position: f64,
    normal: f64,
}

fn wide<T: Real>(p: [T; 3]) -> DVec3 {
    DVec3::from_array(p.map(T::wide))
}

/// A tessellation against the limit surface at all of its vertices.
fn errors<T: Real>(mesh: &ControlMesh, tessellation: &Tessellation<T>) -> Errors {
    let surface = LimitSurface::new(mesh).unwrap();
    let places = tessellation.places();
    let of_vertex = |(i, place): (usize, &ash_subdiv::dice::Place)| {
        let limit = surface.evaluate(place.face, place.sub, place.u.into(), place.v.into());
        let position = (wide(tessellation.positions()[i]) - limit.position).length() / mesh.diagonal();
        let normal = wide(tessellation.normals()[i]);
        // Where there is no tangent plane, the normal of the surface is one of several, and ours is a mean.
        let has_plane = limit.normal != DVec3::ZERO && !is_corner(mesh, place);
        if has_plane {
            assert!((normal.length() - 1.0).abs() < 1e-6, "{place:?}: {normal} is not of length one");
        }
        Errors { position, normal: if has_plane { (normal - limit.normal).length() } else { 0.0 } }
    };
    let most = |a: Errors, b: Errors| Errors { position: a.position.max(b.position), normal: a.normal.max(b.normal) };
    places.par_iter().enumerate().map(of_vertex).reduce(|| Errors { position: 0.0, normal: 0.0 }, most)
}

/// Whether a place is a control vertex.
fn is_corner(mesh: &ControlMesh, place: &ash_subdiv::dice::Place) -> bool {
    let is_end = |t: f32| t == 0.0 || t == 1.0;
    match mesh.face(place.face).len() {
        4 => is_end(place.u) && is_end(place.v),
        _ => place.u == 0.0 && place.v == 0.0,
    }
}

fn check(name: &str, mesh: &ControlMesh) {
    let topology = Topology::new(mesh);
    // Different depths side by side.
    let depths = (0..mesh.corner_count()).map(|facet| [1, 3, 2, 4][facet * 7 % 11 % 4]).collect();
    for depth in [Depth::Fixed(1), Depth::Fixed(4), Depth::Each(depths)] {
        let options = DiceOptions { depth, ..DiceOptions::default() };
        let exact = errors(mesh, &Tessellation::<f64>::new(&topology, &options).unwrap());
        assert!(exact.position < 1e-12 && exact.normal < 1e-6, "{name}: {options:?}: {exact:?}");
        let single = errors(mesh, &Tessellation::<f32>::new(&topology, &options).unwrap());
        assert!(single.position < 2e-7, "{name}: {options:?}: {single:?}");
        println!("{name}: f64 {exact:?}, f32 {single:?}");
    }
}

#[test]
fn tessellations_are_on_the_limit_surface() {
    for info in shapes() {
        check(info.name, &shape(info.name).unwrap());
    }
    for method in [CreaseMethod::Uniform, CreaseMethod::Chaikin] {
        check("everything", &everything(method));
    }
}

/// The samples of records are at 0, 1/8, .. or 0, 1/4, ..: all are vertices.
#[test]
fn tessellations_go_through_reference_samples() {
    for name in names().into_iter().filter(|n| n != "catmark_fan" && n != "catmark_nonman_verts") {
        let (mesh, limit) = mesh_and_limit(&name);
        println!("{name}: {}", limit.side);
        check(&name, &mesh);
    }
}
