//! Pm-patches of faces with five corners.

use crate::common::edges::{edge_parameters, shared_edges};
use crate::common::{pentagon_vector, pentagons};
use ash_subdiv::patch::Row;
use ash_subdiv::table::{CpuSurface, Notice, TableOptions};
use ash_subdiv::topology::{PatchKind, Topology};
use ash_subdiv::{ControlMesh, Fallback, MeshData, Scheme, shape};
use glam::DVec3;
use std::collections::HashMap;

/// The patches by face and first corner.
struct Pieces {
    surface: CpuSurface,
    points: HashMap<(u32, u32), (PatchKind, Vec<DVec3>)>,
}

impl Pieces {
    fn new(mesh: &ControlMesh) -> Self {
        let surface = CpuSurface::new(mesh, Scheme::Pm, 0).expect("closed, of faces with up to five corners");
        let patches = surface.plan().patches().iter().zip(surface.control_points(|p| p));
        let points = patches.map(|(patch, points)| ((patch.face, patch.first()), (patch.kind, points))).collect();
        Self { surface, points }
    }

    fn is_pentagon(&self, face: u32) -> bool {
        self.surface.prepared().mesh().face(face).len() == 5
    }

    /// Position and normal at barycentric (x, y, z) of a sector of a pentagon.
    fn at(&self, face: u32, sector: u32, [x, y, _]: [f64; 3]) -> [DVec3; 2] {
        let (kind, points) = &self.points[&(face, sector)];
        let sample = Scheme::Pm.evaluate(*kind, points, x, y);
        [sample.position, sample.normal]
    }

    /// At `t` on the way along the edge of a face from corner `k`.
    fn on_edge(&self, face: u32, k: usize, t: f64) -> [DVec3; 2] {
        if self.is_pentagon(face) {
            return self.at(face, k as u32, [1.0 - t, t, 0.0]);
        }
        let (kind, points) = &self.points[&(face, 0)];
        let [u, v] = edge_parameters(*kind, k, t);
        let sample = Scheme::Pm.evaluate(*kind, points, u, v);
        [sample.position, sample.normal]
    }
}

/// The mesh of the vectors, and a dodecahedron pulled out of shape: pentagons beside pentagons.
fn meshes() -> Vec<ControlMesh> {
    vec![pentagons(), dodecahedron()]
}

fn dodecahedron() -> ControlMesh {
    // The faces of `polygons` that have five corners are the vertices of an icosahedron; its dual has one for each triangle.
    let normals: Vec<DVec3> = {
        let mesh = shape("polygons").expect("built in");
        let centre = |f: u32| mesh.face(f).iter().map(|&v| mesh.position(v)).sum::<DVec3>().normalize();
        (0..mesh.face_count() as u32).filter(|&f| mesh.face(f).len() == 5).map(centre).collect::<Vec<_>>()
    };
    // `polygons` has other pentagons than those twelve in no place.
    assert_eq!(normals.len(), 12);
    let near = |a: DVec3, b: DVec3| a.dot(b) > 0.4 && a.dot(b) < 0.9;
    let mut positions = Vec::new();
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); 12];
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(normals[i], normals[j]) && near(normals[j], normals[k]) && near(normals[i], normals[k]) {
                    [i, j, k].iter().for_each(|&f| around[f].push(positions.len() as u32));
                    let p = (normals[i] + normals[j] + normals[k]).normalize();
                    positions.push((p * (1.0 + 0.3 * (5.0 * p.x + 3.0 * p.y * p.z).sin())).to_array());
                }
            }
        }
    }
    let faces = around.into_iter().zip(&normals).map(|(mut face, n)| {
        let u = n.any_orthonormal_vector();
        let v = n.cross(u);
        let angle = |&i: &u32| {
            let p = DVec3::from(positions[i as usize]);
            p.dot(v).atan2(p.dot(u))
        };
        face.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        face
    });
    let face_vertices = faces.flatten().collect();
    ControlMesh::new(MeshData { positions, face_sizes: vec![5; 12], face_vertices, ..MeshData::default() })
        .expect("a dodecahedron")
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

fn points(value: &serde_json::Value) -> Vec<DVec3> {
    let rows: Vec<[f64; 3]> = serde_json::from_value(value.clone()).expect("points");
    rows.into_iter().map(DVec3::from).collect()
}

#[test]
fn points_and_samples_agree_with_the_reference() {
    let (vector, mesh) = (pentagon_vector(), pentagons());
    let pieces = Pieces::new(&mesh);
    let parameters = points(&vector["parameters"]);
    let mut sectors = 0;
    for (face, expected) in vector["patches"].as_object().expect("by face") {
        let face: u32 = face.parse().expect("a number");
        let ours = &pieces.points[&(face, 0)].1;
        for (i, (a, b)) in ours.iter().zip(points(&expected["points"])).enumerate() {
            assert!(a.distance(b) < 1e-12, "face {face}, point {i}: {a}, not {b}");
        }
        if !pieces.is_pentagon(face) {
            continue;
        }
        for (sector, samples) in (0..).zip(expected["samples"].as_array().expect("samples")) {
            let (positions, normals) = (points(&samples["position"]), points(&samples["normal"]));
            for ((at, position), normal) in parameters.iter().zip(positions).zip(normals) {
                let [p, n] = pieces.at(face, sector, at.to_array());
                assert!(p.distance(position) < 1e-12, "face {face}, sector {sector}, {at}: {p}, not {position}");
                assert!(angle(n, normal) < 1e-9, "face {face}, sector {sector}, {at}: {n}, not {normal}");
            }
            sectors += 1;
        }
    }
    assert_eq!(sectors, 10);
}

/// One surface with one tangent plane: across the edges of pentagons to whatever face. Measured: 6e-16
/// and 6e-15 rad.
#[test]
fn pentagons_join_their_neighbours() {
    for mesh in meshes() {
        let pieces = Pieces::new(&mesh);
        for edge in shared_edges(&Topology::new(&mesh)) {
            for t in [0.0, 0.01, 0.2, 0.5, 0.9, 1.0] {
                let [(f, k), (g, l)] = edge.sides;
                let ([p, m], [q, n]) = (pieces.on_edge(f, k, t), pieces.on_edge(g, l, 1.0 - t));
                assert!(p.distance(q) < 1e-13, "faces {f} and {g} at {t}: {:e} apart", p.distance(q));
                assert!(angle(m, n) < 1e-9, "faces {f} and {g} at {t}: {:e} rad", angle(m, n));
            }
        }
    }
}

/// C1 across the spokes: equal derivatives in a regular pentagon, from positions alone; and with them the normals.
#[test]
fn sectors_of_a_pentagon_join() {
    let cos = (std::f64::consts::TAU / 5.0).cos();
    for mesh in meshes() {
        let pieces = Pieces::new(&mesh);
        for face in (0..mesh.face_count() as u32).filter(|&face| pieces.is_pentagon(face)) {
            for k in 0..5 {
                let before = (k + 4) % 5;
                for t in [0.0, 0.1, 0.4, 0.7, 1.0] {
                    // From corner k to the centre, seen from both sides; and the way from corner k - 1 to corner k + 1.
                    let here = ([1.0 - t, 0.0, t], [-2.0 * cos, 2.0, -2.0 * (1.0 - cos)]);
                    let there = ([0.0, 1.0 - t, t], [-2.0, 2.0 * cos, 2.0 * (1.0 - cos)]);
                    let [p, m] = pieces.at(face, k, here.0);
                    let [q, n] = pieces.at(face, before, there.0);
                    assert!(p.distance(q) < 1e-13, "face {face}, spoke {k} at {t}: {:e} apart", p.distance(q));
                    assert!(angle(m, n) < 1e-9, "face {face}, spoke {k} at {t}: {:e} rad", angle(m, n));
                    // A quartic's derivative from five of its points.
                    let derivative = |sector: u32, (from, step): ([f64; 3], [f64; 3])| -> DVec3 {
                        let weights = [-25.0, 48.0, -36.0, 16.0, -3.0].map(|w| w / 12.0 / 0.01);
                        let at = |i: usize| [0, 1, 2].map(|a| from[a] + 0.01 * i as f64 * step[a]);
                        (0..5).map(|i| weights[i] * pieces.at(face, sector, at(i))[0]).sum()
                    };
                    let [a, b] = [derivative(k, here), derivative(before, there)];
                    assert!(a.distance(b) < 1e-9 * a.length(), "face {face}, spoke {k} at {t}: {a} and {b}");
                }
            }
        }
    }
}

/// All five pieces are one patch, whose points each counts from its own corner on; and rows of points sum to one.
#[test]
fn pieces_have_the_points_of_the_face() {
    let mesh = dodecahedron();
    let topology = Topology::new(&mesh);
    let pieces = Pieces::new(&mesh);
    assert_eq!(pieces.points.len(), 60);
    for k in 0..5 {
        let (first, piece) = (&pieces.points[&(3, 0)].1, &pieces.points[&(3, k)].1);
        let slots = |k: usize| Scheme::Pm.corner_slots(PatchKind::Pentagon, k % 5);
        for corner in 0..5 {
            for (a, b) in slots(corner).into_iter().zip(slots(corner + k as usize)) {
                assert!(piece[a].distance(first[b]) < 1e-14, "piece {k}, corner {corner}");
            }
        }
    }
    for row in Scheme::Pm.control_points(&topology, 3, PatchKind::Pentagon, Row::unit) {
        let sum: f64 = row.weights().iter().map(|w| w.1).sum();
        assert!((sum - 1.0).abs() < 1e-13, "{sum}");
    }
    let origins = pieces.surface.origins();
    let pieces: Vec<_> = origins[..5].iter().map(|origin| (origin.face, origin.path().collect::<Vec<_>>())).collect();
    assert_eq!(pieces, [0, 1, 2, 3, 4].map(|first| (0, vec![first])));
}

/// Whole where Pm is defined; where not, refused, or refined so that Gregory patches can stand in.
#[test]
fn pentagons_are_refined_only_where_they_must_be() {
    let mesh = pentagons();
    let surface = CpuSurface::new(&mesh, Scheme::Pm, 0).expect("defined");
    assert_eq!(surface.plan().count(PatchKind::Pentagon), 10);
    assert!(surface.notices().is_empty(), "{:?}", surface.notices());
    // Where end caps are, faces are cut in wedges.
    let cut = CpuSurface::new(&mesh, Scheme::Gregory, 0).expect("wedges");
    assert!(cut.plan().patches().iter().all(|patch| patch.refined) && cut.notices().is_empty());
    for scheme in [Scheme::Acc, Scheme::CPatch] {
        let refined = CpuSurface::new(&mesh, scheme, 0).expect("quads only");
        assert_eq!(refined.plan().patches().len(), mesh.corner_count(), "{scheme:?}");
    }
    // Without the first pentagon there is a boundary.
    let open = ControlMesh::new(MeshData {
        face_sizes: mesh.data().face_sizes[1..].to_vec(),
        face_vertices: mesh.data().face_vertices[5..].to_vec(),
        ..mesh.data().clone()
    })
    .expect("manifold");
    let error = CpuSurface::new(&open, Scheme::Pm, 0).expect_err("a boundary").to_string();
    assert!(error.starts_with("face 2: the scheme pm has no patches for irregular faces at a boundary"), "{error}");
    let hexagons = shape("polygons").expect("built in");
    for mesh in [open, hexagons] {
        let mixed = CpuSurface::with_options(
            &mesh,
            &TableOptions { scheme: Scheme::Pm, fallback: Fallback::Gregory, ..TableOptions::default() },
        )
        .expect("refined");
        assert!(matches!(mixed.notices()[0], Notice::RefinedPolygons { .. }));
        assert_eq!(mixed.plan().patches().len(), mesh.corner_count());
        assert_eq!(mixed.plan().count(PatchKind::Pentagon), 0);
    }
}
