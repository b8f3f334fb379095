//! Tessellations against the exact limit surface.

use crate::common::limit::{mesh_and_limit, names};
use crate::limit_surface::everything;
use ash_subdiv::dice::{Depth, DiceOptions, Place, Plan, Real, Tessellation};
use ash_subdiv::limit::{LimitSurface, refine};
use ash_subdiv::mesh::{Corner, CreaseMethod, FaceVaryingRule, SHARPNESS_INFINITE};
use ash_subdiv::topology::{RingKind, Topology};
use ash_subdiv::{ControlMesh, MeshData, shape, shapes};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;
use std::convert::Infallible;

/// Greatest errors: of positions over the diagonal, of normals in radians.
#[derive(Debug, Clone, Copy)]
pub struct Errors {
    pub position: f64,
    pub normal: f64,
}

fn wide<T: Real>(p: [T; 3]) -> DVec3 {
    DVec3::from_array(p.map(T::wide))
}

/// A tessellation against the limit surface at its vertices, or at some thousands of them.
pub fn errors<T: Real>(mesh: &ControlMesh, tessellation: &Tessellation<T>) -> Errors {
    let surface = LimitSurface::new(mesh).unwrap();
    let topology = Topology::new(mesh);
    let places = tessellation.places();
    let of_vertex = |(i, place): (usize, &Place)| {
        let limit = surface.evaluate(place.face, place.sub, place.u.into(), place.v.into());
        let position = (wide(tessellation.positions()[i]) - limit.position).length() / mesh.diagonal();
        let normal = wide(tessellation.normals()[i]);
        // Where there is no tangent plane, the normal of the surface is one of several, and ours is a mean.
        let has_plane = limit.normal != DVec3::ZERO && !is_cone(&topology, place);
        let normal = if has_plane { (normal - limit.normal).length() } else { 0.0 };
        Errors { position, normal }
    };
    let most = |a: Errors, b: Errors| Errors { position: a.position.max(b.position), normal: a.normal.max(b.normal) };
    // A step that no grid has.
    let step = places.len() / 1500 + 1;
    let vertices = places.par_iter().enumerate().filter(|(i, _)| i % (step | 1) == 0);
    vertices.map(of_vertex).reduce(|| Errors { position: 0.0, normal: 0.0 }, most)
}

/// The corner of a facet that a place is at: the facet's corner of the face, and which of its own corners.
fn facet_corner(place: &Place) -> Option<(usize, usize)> {
    match (place.sub, 2.0 * place.u, 2.0 * place.v) {
        (-1, 0.0, 0.0) => Some((0, 0)),
        (-1, 2.0, 0.0) => Some((1, 0)),
        (-1, 2.0, 2.0) => Some((2, 0)),
        (-1, 0.0, 2.0) => Some((3, 0)),
        (-1, 1.0, 0.0) => Some((0, 1)),
        (-1, 2.0, 1.0) => Some((1, 1)),
        (-1, 1.0, 2.0) => Some((2, 1)),
        (-1, 0.0, 1.0) => Some((3, 1)),
        (-1, 1.0, 1.0) => Some((0, 2)),
        (k @ 0.., 0.0, 0.0) => Some((k as usize, 0)),
        (k @ 0.., 2.0, 0.0) => Some((k as usize, 1)),
        (k @ 0.., 2.0, 2.0) => Some((k as usize, 2)),
        (k @ 0.., 0.0, 2.0) => Some((k as usize, 3)),
        _ => None,
    }
}

/// Whether a place is a control vertex where several faces meet in a corner.
fn is_cone(topology: &Topology, place: &Place) -> bool {
    let Some((corner, 0)) = facet_corner(place) else { return false };
    let h = topology.mesh().face_corners(place.face).start + corner;
    let ring = &topology.rings()[topology.place(h as u32).ring as usize];
    ring.kind == RingKind::Corner && ring.faces > 1
}

fn check(name: &str, mesh: &ControlMesh) {
    let topology = Topology::new(mesh);
    // Different depths side by side.
    let depths = (0..mesh.corner_count()).map(|facet| [1, 3, 2, 4][facet * 7 % 11 % 4]).collect();
    let options = DiceOptions { depth: Depth::Each(depths), max_step: 3, ..DiceOptions::default() };
    let exact = errors(mesh, &Tessellation::<f64>::new(&topology, &options).unwrap());
    assert!(exact.position < 1e-12 && exact.normal < 1e-6, "{name}: {exact:?}");
    let single = errors(mesh, &Tessellation::<f32>::new(&topology, &DiceOptions::fixed(3)).unwrap());
    assert!(single.position < 2e-7 && single.normal < 1e-5, "{name}: {single:?}");
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

#[test]
fn tessellations_go_through_reference_samples() {
    for name in names().into_iter().filter(|n| n != "catmark_fan" && n != "catmark_nonman_verts") {
        let (mesh, limit) = mesh_and_limit(&name);
        check(&name, &mesh);
        let tessellation = Tessellation::<f64>::new(&Topology::new(&mesh), &DiceOptions::fixed(4)).unwrap();
        let key = |face: u32, sub: i32, [u, v]: [f64; 2]| (face, sub, (u * 16.0) as u32, (v * 16.0) as u32);
        let places = tessellation.places();
        let vertices: HashMap<_, _> =
            places.iter().zip(0..).map(|(p, i)| (key(p.face, p.sub, [p.u.into(), p.v.into()]), i)).collect();
        let (mut found, last) = (0, limit.side - 1);
        for record in &limit.records {
            for (i, sample) in record.samples.iter().enumerate() {
                let uv = [i % limit.side, i / limit.side].map(|i| i as f64 / last as f64);
                // What is on the edge of a face counts as its neighbour's.
                let Some(&vertex) = vertices.get(&key(record.face, record.sub, uv)) else { continue };
                let vertex: usize = vertex;
                found += 1;
                let error = (wide(tessellation.positions()[vertex]) - sample.position).length() / mesh.diagonal();
                // The references refine around darts to a finite level.
                assert!(error < 1e-5, "{name}: face {} at {uv:?}: {error}", record.face);
            }
        }
        assert!(found >= (last - 1) * (last - 1), "{name}: {found} samples");
    }
}

#[test]
fn texture_coordinates_follow_the_rule() {
    let base = shape("creature-mixed").unwrap();
    for rule in [FaceVaryingRule::All, FaceVaryingRule::CornersOnly, FaceVaryingRule::Boundaries] {
        let mesh = ControlMesh::new(MeshData { face_varying_rule: rule, ..base.data().clone() }).unwrap();
        let tessellation = Tessellation::<f32>::new(&Topology::new(&mesh), &DiceOptions::fixed(1)).unwrap();
        // Refined thrice more, values are close to their limit.
        let mut fine = mesh.clone();
        for _ in 0..5 {
            fine = refine(&Topology::new(&fine)).unwrap().mesh;
        }
        let fine_texcoords = fine.data().texcoords.as_ref().unwrap();
        let places = tessellation.places();
        let texcoords = tessellation.texcoords().unwrap();
        let offsets = mesh.face_offsets();
        let mut checked = 0;
        for (place, texcoord) in places.iter().zip(texcoords) {
            let Some((corner, of_facet)) = facet_corner(place) else { continue };
            let facet = offsets[place.face as usize] as usize + corner;
            // The child at that corner of the facet, its first child, that one's, ..
            let descendant = 4 * ((4 * facet + of_facet) << 6);
            let expected = fine_texcoords.values[fine_texcoords.indices[descendant] as usize];
            let error = (0..2).map(|axis| (texcoord[axis] - expected[axis]).abs()).fold(0.0, f32::max);
            assert!(error < 1e-4, "{rule:?}: {place:?}: {texcoord:?}, not {expected:?}");
            checked += 1;
        }
        assert_eq!(checked, places.len());
    }
}

/// Pieces, put together, are the arrays to the last bit.
#[test]
fn streams_are_the_arrays_in_pieces() {
    for (name, depth) in [("creature-mixed", 2), ("machine-part", 5), ("valences", 6), ("cloth", 3)] {
        let mesh = shape(name).unwrap();
        let topology = Topology::new(&mesh);
        let depths =
            (0..mesh.corner_count()).map(|facet| depth - (facet * 7 % 11 % 3 % depth as usize) as u32).collect();
        let options = DiceOptions { depth: Depth::Each(depths), max_step: 3, ..DiceOptions::default() };
        let whole = Tessellation::<f32>::new(&topology, &options).unwrap();
        let plan = Plan::<f32>::new(&topology, &options).unwrap();
        let stream = plan.stream(&mesh.data().positions).unwrap();
        let [mut positions, mut normals] = [Vec::new(), Vec::new()];
        let (mut texcoords, mut pieces) = (Vec::new(), 0);
        let visited: Result<(), Infallible> = stream.for_each_piece(|piece| {
            positions.extend_from_slice(piece.positions);
            normals.extend_from_slice(piece.normals);
            texcoords.extend_from_slice(piece.texcoords.unwrap_or_default());
            pieces += 1;
            Ok(())
        });
        visited.unwrap();
        assert_eq!((positions.as_slice(), normals.as_slice()), (whole.positions(), whole.normals()), "{name}");
        assert_eq!(texcoords, whole.texcoords().unwrap_or_default(), "{name}");
        assert_eq!(pieces > 2, name == "valences", "{name}: {pieces} of {}", positions.len());
        let (mut quads, mut triangles, mut cut) = (Vec::new(), Vec::new(), Vec::new());
        let visited: Result<(), Infallible> = stream.for_each_quads(|piece| {
            quads.extend_from_slice(piece);
            Ok(())
        });
        visited.unwrap();
        let visited: Result<(), Infallible> = stream.for_each_triangles(|piece| {
            triangles.extend_from_slice(piece);
            Ok(())
        });
        visited.unwrap();
        let visited: Result<(), Infallible> = stream.for_each_cut(|piece| {
            cut.extend_from_slice(piece);
            Ok(())
        });
        visited.unwrap();
        assert_eq!((quads.as_slice(), triangles.as_slice()), (whole.quads(), whole.triangles()), "{name}");
        assert_eq!(cut, whole.all_triangles(), "{name}");
    }
}

/// The tips of cones, where every face has a normal of its own.
#[test]
fn corners_have_the_mean_normal_of_their_faces() {
    let cube = shape("cube").unwrap();
    let corners = (0..8).map(|vertex| Corner { vertex, sharpness: SHARPNESS_INFINITE }).collect();
    let mesh = ControlMesh::new(MeshData { corners, ..cube.into_data() }).unwrap();
    let tessellation = Tessellation::<f64>::new(&Topology::new(&mesh), &DiceOptions::fixed(2)).unwrap();
    let mut found = 0;
    for (position, normal) in tessellation.positions().iter().zip(tessellation.normals()) {
        let (position, normal) = (DVec3::from(*position), DVec3::from(*normal));
        if mesh.data().positions.iter().any(|&p| DVec3::from(p) == position) {
            assert!(normal.distance(position.normalize()) < 1e-12, "{position}: {normal}");
            found += 1;
        }
    }
    assert_eq!(found, 8);
}
