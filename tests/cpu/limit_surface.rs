//! The limit surface against refinement and against itself.

use crate::common;
use ash_subdiv::limit::{LimitSample, LimitSurface, refine};
use ash_subdiv::mesh::{BoundaryRule, Corner, Crease, CreaseMethod, ReadOptions, SHARPNESS_INFINITE, read};
use ash_subdiv::patch::{RingValues, Scheme};
use ash_subdiv::topology::{PatchKind, RingKind, Topology};
use ash_subdiv::{ControlMesh, MeshData, MeshError, grid_torus, shape};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Random numbers in 0..1, always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[test]
fn a_regular_mesh_is_its_bicubic_patches() {
    let mesh = ControlMesh::new(grid_torus(7, 5)).unwrap();
    let topology = Topology::new(&mesh);
    let surface = LimitSurface::new(&mesh).unwrap();
    let mut random = Random(1);
    for face in 0..mesh.face_count() as u32 {
        let points = Scheme::Gregory.control_points(&topology, face, PatchKind::Regular, |v| mesh.position(v));
        let (u, v) = (random.next(), random.next());
        let patch = Scheme::Gregory.evaluate(PatchKind::Regular, &points, u, v);
        let limit = surface.evaluate(face, -1, u, v);
        assert!((patch.position - limit.position).length() < 1e-14 * mesh.diagonal());
        assert!((patch.normal - limit.normal).length() < 1e-13);
    }
}

/// Boxes with everything: quads, triangles and a pentagon, boundary, creases and corners of finite and infinite
/// sharpness, a dart.
pub fn everything(method: CreaseMethod) -> ControlMesh {
    let mut random = Random(3);
    let mut data = MeshData { crease_method: method, boundary: BoundaryRule::EdgeOnly, ..MeshData::default() };
    let n = 6;
    for j in 0..=n {
        for i in 0..=n {
            data.positions.push([i as f64, j as f64 + 0.3 * random.next(), 1.5 * random.next()]);
        }
    }
    let at = |i: u32, j: u32| j * (n + 1) + i;
    for j in 0..n {
        for i in 0..n {
            let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            match (i, j) {
                (2, 2) | (4, 1) => {
                    data.face_sizes.extend([3, 3]);
                    data.face_vertices.extend([quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]]);
                }
                // A pentagon and a triangle of two quads.
                (3, 4) => {
                    data.face_sizes.extend([5, 3]);
                    let far = [at(i + 2, j), at(i + 2, j + 1)];
                    data.face_vertices.extend([quad[0], quad[1], far[0], quad[2], quad[3], quad[2], far[0], far[1]]);
                }
                (4, 4) => {}
                _ => {
                    data.face_sizes.push(4);
                    data.face_vertices.extend(quad);
                }
            }
        }
    }
    let mut crease = |a, b, sharpness| data.creases.push(Crease { vertices: [a, b], sharpness });
    crease(at(1, 1), at(1, 2), 10.0);
    crease(at(1, 2), at(1, 3), 10.0);
    crease(at(1, 3), at(1, 4), 1.3);
    crease(at(1, 4), at(2, 4), 2.6);
    crease(at(2, 4), at(2, 5), 0.4);
    crease(at(4, 0), at(4, 1), 3.0);
    // To Chaikin's rule the middle one is sharp, for what is at both of its ends.
    crease(at(2, 1), at(3, 1), 5.0);
    crease(at(3, 1), at(3, 2), 0.8);
    crease(at(3, 2), at(3, 3), 5.0);
    data.corners = vec![
        Corner { vertex: at(5, 2), sharpness: 1.7 },
        Corner { vertex: at(4, 3), sharpness: 10.0 },
        Corner { vertex: at(0, 0), sharpness: 10.0 },
    ];
    ControlMesh::new(data).unwrap()
}

/// Where a face of a refined mesh lies: parameters of its corner 0, steps to its corners 1 and 3.
#[derive(Clone, Copy)]
struct Place {
    face: u32,
    sub: i32,
    origin: DVec2,
    along: DVec2,
    up: DVec2,
}

impl Place {
    fn corner(&self, k: usize) -> DVec2 {
        let Self { origin, along, up, .. } = *self;
        [origin, origin + along, origin + along + up, origin + up][k]
    }

    fn child(&self, k: usize) -> Self {
        let turn = [(self.along, self.up), (self.up, -self.along), (-self.along, -self.up), (-self.up, self.along)];
        Self { origin: self.corner(k), along: 0.5 * turn[k].0, up: 0.5 * turn[k].1, ..*self }
    }

    /// The children of a face of the control mesh.
    fn first(size: usize, face: u32, k: usize) -> Self {
        let whole = Self { face, sub: -1, origin: DVec2::ZERO, along: DVec2::X, up: DVec2::Y };
        if size == 4 { whole.child(k) } else { Self { sub: k as i32, ..whole } }
    }
}

#[test]
fn dyadic_points_are_those_of_the_refined_mesh() {
    for method in [CreaseMethod::Uniform, CreaseMethod::Chaikin] {
        let base = everything(method);
        let surface = LimitSurface::new(&base).unwrap();
        let (mut mesh, mut places) = (base.clone(), Vec::new());
        for level in 0..5 {
            let refined = refine(&Topology::new(&mesh)).unwrap().mesh;
            let corners = (0..mesh.face_count() as u32).flat_map(|f| (0..mesh.face(f).len()).map(move |k| (f, k)));
            places = match level {
                0 => corners.map(|(f, k)| Place::first(mesh.face(f).len(), f, k)).collect(),
                _ => corners.map(|(f, k)| places[f as usize].child(k)).collect(),
            };
            mesh = refined;
        }
        assert!(mesh.data().creases.iter().all(|c| c.sharpness >= SHARPNESS_INFINITE));
        let topology = Topology::new(&mesh);
        for (f, place) in places.iter().enumerate() {
            for k in 0..4 {
                let h = (4 * f + k) as u32;
                let ring = &topology.rings()[topology.place(h).ring as usize];
                if ring.kind == RingKind::Smooth && topology.ring_half_edges(ring).any(|h| topology.is_sharp(h)) {
                    // A dart, whose masks the ring does not know.
                    continue;
                }
                let expected = RingValues::new(&topology, ring, |v| mesh.position(v)).frame().p;
                let DVec2 { x, y } = place.corner(k);
                let error = (surface.evaluate(place.face, place.sub, x, y).position - expected).length();
                assert!(error < 1e-14 * base.diagonal(), "face {} at {x} {y}: {error:e}", place.face);
            }
        }
    }
}

/// The point at `t` of the way along the edge from corner k of a face.
fn on_edge(surface: &LimitSurface, mesh: &ControlMesh, face: u32, k: usize, t: f64) -> LimitSample {
    match mesh.face(face).len() {
        4 => {
            let [u, v] = [[t, 0.0], [1.0, t], [1.0 - t, 1.0], [0.0, 1.0 - t]][k];
            surface.evaluate(face, -1, u, v)
        }
        _ if t < 0.5 => surface.evaluate(face, k as i32, 2.0 * t, 0.0),
        size => surface.evaluate(face, ((k + 1) % size) as i32, 0.0, 2.0 - 2.0 * t),
    }
}

#[test]
fn faces_meet_at_any_point_of_their_edges() {
    let mut random = Random(7);
    let meshes = ["creature", "polygons", "valences", "machine-part"].map(|name| shape(name).unwrap());
    for mesh in meshes.into_iter().chain([everything(CreaseMethod::Uniform), everything(CreaseMethod::Chaikin)]) {
        let topology = Topology::new(&mesh);
        let surface = LimitSurface::new(&mesh).unwrap();
        for h in 0..mesh.corner_count() as u32 {
            let Some(twin) = topology.twin(h) else { continue };
            let place = |h: u32| (topology.face(h), h as usize - mesh.face_corners(topology.face(h)).start);
            let ((face, k), (other, l)) = (place(h), place(twin));
            let t = random.next();
            let (a, b) = (on_edge(&surface, &mesh, face, k, t), on_edge(&surface, &mesh, other, l, 1.0 - t));
            assert!((a.position - b.position).length() < 1e-14 * mesh.diagonal(), "faces {face} and {other} at {t}");
            let ends = [topology.mesh_vertex(h), topology.mesh_vertex(topology.next(h))];
            let is_sharp = |c: &Crease| c.sharpness >= 10.0 && c.vertices.iter().all(|v| ends.contains(v));
            if !mesh.data().creases.iter().any(is_sharp) {
                assert!(
                    (a.normal - b.normal).length() < 1e-8,
                    "faces {face} and {other} at {t}: {} {}",
                    a.normal,
                    b.normal
                );
            }
        }
    }
}

#[test]
fn derivatives_are_those_of_the_positions() {
    let mut random = Random(11);
    let mesh = everything(CreaseMethod::Chaikin);
    let surface = LimitSurface::new(&mesh).unwrap();
    for face in 0..mesh.face_count() as u32 {
        for sub in surface.subs(face) {
            let (u, v) = (0.01 + 0.98 * random.next(), 0.01 + 0.98 * random.next());
            let at = |u, v| surface.evaluate(face, sub, u, v).position;
            let h = 1e-6;
            let sample = surface.evaluate(face, sub, u, v);
            let du = (at(u + h, v) - at(u - h, v)) / (2.0 * h);
            let dv = (at(u, v + h) - at(u, v - h)) / (2.0 * h);
            let error = (du - sample.du).length().max((dv - sample.dv).length());
            assert!(error < 1e-4, "face {face} at {u} {v}: {error:e}");
        }
    }
}

#[test]
fn close_to_a_vertex_the_surface_is_close_to_its_limit() {
    let mesh = shape("creature").unwrap();
    let surface = LimitSurface::new(&mesh).unwrap();
    for face in (0..mesh.face_count() as u32).step_by(7) {
        for sub in surface.subs(face) {
            let at = |distance: f64| surface.evaluate(face, sub, 0.7 * distance, 0.4 * distance);
            let vertex = at(0.0);
            // As far away as the eigenvalue of the vertex says, 0.41 around three faces to 0.63 around twelve.
            let [far, near] = [29, 30].map(|e| (at(f64::from(-e).exp2()).position - vertex.position).length());
            assert!((0.4..0.7).contains(&(near / far)), "face {face}: {near:e} of {far:e}");
            for exponent in [20, 40, 60, 80, 1000] {
                let close = at(f64::from(-exponent).exp2());
                // The normal converges with the ratio of eigenvalues: 0.82 around eight faces.
                let tolerance = 1e-12 + 2.0 * 0.87f64.powi(exponent);
                assert!((close.position - vertex.position).length() < tolerance * mesh.diagonal());
                let error = (close.normal - vertex.normal).length();
                assert!(error < tolerance, "face {face} at 2^-{exponent}: {error:e}");
            }
        }
    }
}

#[test]
fn where_fans_touch_the_surface_meets_the_vertex() {
    // Two pairs of quads with vertex 0 in common.
    let mesh = ControlMesh::new(MeshData {
        positions: (0..11).map(|i| [f64::from(i), f64::from(i * i), 0.0]).collect(),
        face_sizes: vec![4; 4],
        face_vertices: vec![0, 1, 2, 3, 0, 3, 4, 5, 0, 6, 7, 8, 0, 8, 9, 10],
        boundary: BoundaryRule::EdgeOnly,
        ..MeshData::default()
    })
    .unwrap();
    let at_vertex = |mesh: &ControlMesh, corner: (u32, f64, f64)| {
        LimitSurface::new(mesh).unwrap().evaluate(corner.0, -1, corner.1, corner.2).position
    };
    // After refinement the fans are apart, and stay where they are.
    let refined = refine(&Topology::new(&mesh)).unwrap().mesh;
    for corner in [(0, 0.0, 0.0), (1, 0.0, 0.0), (2, 0.0, 0.0), (3, 0.0, 0.0)] {
        assert_eq!(at_vertex(&mesh, corner), DVec3::ZERO);
        assert_eq!(at_vertex(&refined, (4 * corner.0, 0.0, 0.0)), DVec3::ZERO);
    }
}

#[test]
fn coordinates_too_large_are_refused() {
    let mut data = shape("cube").unwrap().into_data();
    data.positions[3] = [0.0, -2e38, 0.0];
    let mesh = ControlMesh::new(data).unwrap();
    assert!(matches!(LimitSurface::new(&mesh), Err(MeshError::TooFar { vertex: 3, .. })));
}

/// Prints how long random samples take; that they are made at all is all that is checked.
#[test]
fn a_hundred_thousand_samples() {
    let frog = common::shared().join("meshes/monsterfrog.obj");
    let mesh = if cfg!(shared) { read(frog, &ReadOptions::default()) } else { shape("creature") }.unwrap();
    let surface = LimitSurface::new(&mesh).unwrap();
    let mut random = Random(5);
    let samples: Vec<_> = (0..100_000)
        .map(|_| ((random.next() * mesh.face_count() as f64) as u32, random.next(), random.next()))
        .collect();
    for turn in ["first", "again"] {
        let start = std::time::Instant::now();
        let sum: DVec3 = samples
            .par_iter()
            .map(|&(face, u, v)| {
                let sub = surface.subs(face).start;
                surface.evaluate(face, sub, u, v).normal
            })
            .sum();
        println!("100 000 samples, {turn}: {:?}", start.elapsed());
        assert!(sum.is_finite());
    }
}
