//! What the literature says of the schemes beside Gregory's: how their patches join. No reference data.

use crate::common::edges::{corner_parameters, edge_parameters, shared_edges};
use ash_subdiv::ControlMesh;
use ash_subdiv::patch::{Row, Sample, Scheme};
use ash_subdiv::renderer::ModelTables;
use ash_subdiv::topology::{PatchKind, Topology};
use ash_subdiv::{Construction, MeshData, ModelOptions, shape, shapes};
use glam::DVec3;

/// Closed meshes of quads without creases.
const QUADS: [&str; 4] = ["creature", "cube", "torus", "valences"];
/// Such meshes with triangles.
const MIXED: [&str; 2] = ["creature-mixed", "tetrahedron"];

struct Surface {
    name: String,
    scheme: Scheme,
    topology: Topology,
    patches: Vec<Vec<DVec3>>,
}

impl Surface {
    fn new(name: &str, mesh: &ControlMesh, scheme: Scheme) -> Self {
        let topology = Topology::new(mesh);
        let patch = |f| scheme.control_points(&topology, f, kind(&topology, f), |v| mesh.position(v));
        let patches = (0..mesh.face_count() as u32).map(patch).collect();
        Self { name: format!("{name} {}", scheme.name()), scheme, topology, patches }
    }

    fn kind(&self, face: u32) -> PatchKind {
        kind(&self.topology, face)
    }

    fn at(&self, face: u32, [u, v]: [f64; 2]) -> Sample<DVec3> {
        self.scheme.evaluate(self.kind(face), &self.patches[face as usize], u, v)
    }

    fn faces(&self) -> impl Iterator<Item = u32> {
        0..self.patches.len() as u32
    }

    fn irregular_faces(&self) -> impl Iterator<Item = u32> {
        self.faces().filter(|&face| self.kind(face) != PatchKind::Regular)
    }
}

fn kind(topology: &Topology, face: u32) -> PatchKind {
    topology.patch_kind(face).expect("a triangle or quad")
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// Every built-in mesh of the list, a few units large, with every one of these schemes.
fn each(shapes: &[&str], schemes: &[Scheme], mut visit: impl FnMut(&Surface)) {
    for name in shapes {
        let mesh = shape(name).expect("built in");
        for &scheme in schemes {
            visit(&Surface::new(name, &mesh, scheme));
        }
    }
}

/// The largest distance and angle between the patches of smooth edges, and how many edges there are with no, one and two
/// regular faces.
fn joins(surface: &Surface) -> (f64, f64, [usize; 3]) {
    let (mut distance, mut normal, mut edges) = (0.0, 0.0, [0; 3]);
    for edge in shared_edges(&surface.topology) {
        let regular = edge.sides.iter().filter(|side| surface.kind(side.0) == PatchKind::Regular).count();
        edges[regular] += 1;
        for t in [0.0, 0.01, 0.1, 0.25, 0.5, 0.8, 1.0] {
            let [a, b] = [(edge.sides[0], t), (edge.sides[1], 1.0 - t)]
                .map(|((face, k), t)| surface.at(face, edge_parameters(surface.kind(face), k, t)));
            distance = f64::max(distance, (a.position - b.position).length());
            if edge.smooth {
                normal = f64::max(normal, angle(a.normal, b.normal));
            }
        }
    }
    (distance, normal, edges)
}

/// ACC: one position and one shading normal on both sides of every edge, boundaries and creases of the mesh included.
/// Pm: one tangent plane, also between Pm-patches and bicubic ones. Measured: 2.4e-15 and 4.9e-13 rad.
#[test]
fn patches_join() {
    let mut edges = [0; 3];
    let mut check = |surface: &Surface| {
        let (distance, normal, count) = joins(surface);
        assert!(distance < 1e-13, "{}: {distance:e} between two patches at an edge", surface.name);
        assert!(normal < 1e-9, "{}: {normal:e} rad between two patches at an edge", surface.name);
        edges = [0, 1, 2].map(|i| edges[i] + count[i]);
    };
    each(&QUADS, &[Scheme::Acc, Scheme::Pm, Scheme::CPatch], &mut check);
    each(&MIXED, &[Scheme::Pm], &mut check);
    each(&["cloth", "strip", "machine-part"], &[Scheme::Acc], &mut check);
    assert!(edges.iter().all(|&count| count > 1000), "{edges:?} edges of no, one and two regular faces");
}

/// So the normal is the one of the limit surface. Measured: equal positions, 4.4e-14 rad (ACC).
#[test]
fn some_have_the_corners_of_gregory() {
    let (mut distance, mut normal) = (0.0, 0.0);
    let mut check = |surface: &Surface| {
        let gregory = Surface::new("", surface.topology.mesh(), Scheme::Gregory);
        for face in surface.faces() {
            for &corner in corner_parameters(surface.kind(face)) {
                let (a, b) = (surface.at(face, corner), gregory.at(face, corner));
                distance = f64::max(distance, (a.position - b.position).length());
                normal = f64::max(normal, angle(a.normal, b.normal));
            }
        }
        assert!(distance < 1e-13 && normal < 1e-9, "{}: {distance:e}, {normal:e} rad", surface.name);
    };
    let quads = [&QUADS[..], &["cloth", "strip", "machine-part"]].concat();
    each(&quads, &[Scheme::Acc, Scheme::GregoryFitted], &mut check);
    each(&MIXED, &[Scheme::GregoryFitted], &mut check);
}

/// The construction for irregular faces, used on regular ones: the B-spline patch and its normal, so that patches of
/// both kinds are one family. Measured: 6.8e-16 and 4.5e-14 rad.
#[test]
fn acc_of_a_regular_face_is_exact() {
    let (mut distance, mut normal, mut faces) = (0.0, 0.0, 0);
    for name in QUADS {
        let mesh = shape(name).expect("built in");
        let topology = Topology::new(&mesh);
        for face in (0..mesh.face_count() as u32).filter(|&face| kind(&topology, face) == PatchKind::Regular) {
            let [a, b] = [PatchKind::IrregularQuad, PatchKind::Regular]
                .map(|kind| (kind, Scheme::Acc.control_points(&topology, face, kind, |v| mesh.position(v))));
            for (u, v) in [(0.0, 0.0), (0.3, 0.2), (0.5, 0.5), (1.0, 0.7), (0.9, 0.1)] {
                let [a, b] = [&a, &b].map(|(kind, points)| Scheme::Acc.evaluate(*kind, points, u, v));
                distance = f64::max(distance, (a.position - b.position).length());
                normal = f64::max(normal, angle(a.normal, b.normal));
            }
            faces += 1;
        }
    }
    assert!(distance < 1e-13 && normal < 1e-9, "{distance:e}, {normal:e} rad");
    assert!(faces > 500, "{faces} faces");
}

/// The derivative at `from` on the way to `from + 4 step`, of a curve that is a quartic there.
fn derivative(surface: &Surface, face: u32, from: [f64; 2], step: [f64; 2]) -> DVec3 {
    let at = |i: usize| surface.at(face, [0, 1].map(|k| from[k] + i as f64 * step[k])).position;
    let weights = [-25.0, 48.0, -36.0, 16.0, -3.0];
    (0..5).map(|i| at(i) * (weights[i] / 12.0)).sum()
}

/// C1 across the spokes, and the normal is that of the surface: both from positions alone. Measured: 2.5e-11 and
/// 4.7e-11 rad at the small triangles of creature-mixed, 7.9e-12 elsewhere.
#[test]
fn pm_is_smooth_inside_a_face() {
    let (mut jump, mut tilt) = (0.0, 0.0);
    let mut check = |surface: &Surface| {
        for face in surface.irregular_faces() {
            let corners = corner_parameters(surface.kind(face));
            let n = corners.len();
            let centre = [0, 1].map(|i| corners.iter().map(|c| c[i]).sum::<f64>() / n as f64);
            for k in 0..n {
                // Parallel to the line between the neighbours of the corner: across the spoke, and into both sectors.
                let (next, before) = (corners[(k + 1) % n], corners[(k + n - 1) % n]);
                for t in [0.2, 0.5, 0.8] {
                    let from = [0, 1].map(|i| (1.0 - t) * corners[k][i] + t * centre[i]);
                    let [step, back] = [0.02, -0.02].map(|by| [0, 1].map(|i| by * (next[i] - before[i])));
                    let along = [0, 1].map(|i| 0.02 * (centre[i] - corners[k][i]));
                    let [ahead, behind, along] = [step, back, along].map(|step| derivative(surface, face, from, step));
                    jump = f64::max(jump, (ahead + behind).length() / ahead.length());
                    let normal = ahead.cross(along).normalize();
                    tilt = f64::max(tilt, angle(surface.at(face, from).normal, normal));
                }
            }
        }
        assert!(jump < 1e-9, "{}: derivatives across a spoke differ by {jump:e}", surface.name);
        assert!(tilt < 1e-9, "{}: the normal is off by {tilt:e} rad", surface.name);
    };
    each(&QUADS, &[Scheme::Pm, Scheme::CPatch], &mut check);
    each(&MIXED, &[Scheme::Pm], &mut check);
}

#[test]
fn c_patches_are_the_pm_patches_of_quads() {
    for name in QUADS {
        let mesh = shape(name).expect("built in");
        let [pm, c_patch] = [Scheme::Pm, Scheme::CPatch].map(|scheme| Surface::new(name, &mesh, scheme));
        assert!(pm.patches == c_patch.patches, "{name}");
        for face in pm.faces() {
            for at in [[0.0, 0.0], [0.3, 0.2], [0.5, 0.5], [0.6, 0.9]] {
                assert_eq!(pm.at(face, at), c_patch.at(face, at), "{name}: face {face}");
            }
        }
    }
}

/// The mesh in a mirror, each face begun at the same corner.
fn mirrored(mesh: &ControlMesh) -> ControlMesh {
    let mut data = MeshData { texcoords: None, normals: None, ..mesh.data().clone() };
    data.positions.iter_mut().for_each(|p| p[0] = -p[0]);
    data.face_vertices = (0..mesh.face_count() as u32)
        .flat_map(|f| [&mesh.face(f)[..1], &reversed(&mesh.face(f)[1..])].concat())
        .collect();
    ControlMesh::new(data).expect("the same faces")
}

fn reversed(vertices: &[u32]) -> Vec<u32> {
    vertices.iter().rev().copied().collect()
}

/// No rule prefers one side of a face. Measured: 1.4e-15 and 3.0e-13 rad.
#[test]
fn surfaces_of_mirrored_meshes_are_mirrored() {
    let mirror = |p: DVec3| DVec3::new(-p.x, p.y, p.z);
    let check = |surface: &Surface| {
        let mesh = mirrored(surface.topology.mesh());
        let other = Surface::new("", &mesh, surface.scheme);
        let (mut distance, mut normal) = (0.0, 0.0);
        for face in surface.faces() {
            for [u, v] in [[0.0, 0.0], [0.3, 0.2], [0.1, 0.6], [0.5, 0.25], [0.2, 0.4]] {
                let at = if surface.kind(face) == PatchKind::Triangle { [u, 1.0 - u - v] } else { [v, u] };
                let (a, b) = (surface.at(face, [u, v]), other.at(face, at));
                distance = f64::max(distance, (mirror(a.position) - b.position).length());
                // Outwards in both.
                normal = f64::max(normal, angle(mirror(a.normal), b.normal));
            }
        }
        assert!(distance < 1e-13 && normal < 1e-9, "{}: {distance:e}, {normal:e} rad", surface.name);
    };
    each(&QUADS, &Scheme::ALL, check);
    each(&MIXED, &[Scheme::Gregory, Scheme::GregoryFitted, Scheme::Pm], check);
}

/// Rows of points sum to one, those of ACC's vectors to nothing.
#[test]
fn weights_are_affine() {
    for info in shapes() {
        let mesh = shape(info.name).expect("built in");
        for scheme in Scheme::ALL {
            if ModelTables::new(&mesh, &ModelOptions { scheme, ..ModelOptions::default() }).is_err() {
                continue;
            }
            let prepared = ash_subdiv::table::prepare(&mesh, 0).expect("small");
            let topology = Topology::new(prepared.mesh());
            for face in 0..prepared.mesh().face_count() as u32 {
                let kind = kind(&topology, face);
                let rows = scheme.control_points(&topology, face, kind, Row::unit);
                for (i, row) in rows.iter().enumerate() {
                    let vector = scheme == Scheme::Acc && kind != PatchKind::Regular && i >= 16;
                    let sum: f64 = row.weights().iter().map(|w| w.1).sum();
                    let expected = if vector { 0.0 } else { 1.0 };
                    assert!((sum - expected).abs() < 1e-13, "{} {scheme:?}: row {i} of face {face}: {sum}", info.name);
                }
            }
        }
    }
}

/// What the message of a scheme says of a shape, if it has no patches for all of it: which face is the first, and why.
fn lack(shape: &str, scheme: Scheme) -> Option<(u32, &'static str)> {
    let (triangles, boundary) = ("triangles", "irregular faces at a boundary, crease or corner");
    match (shape, scheme) {
        (_, Scheme::Gregory | Scheme::GregoryFitted) => None,
        ("creature-mixed" | "tetrahedron" | "fan", Scheme::Acc | Scheme::CPatch) => Some((0, triangles)),
        ("polygons", Scheme::Pm) => Some((12, "faces of six or more corners")),
        ("fan", Scheme::Pm) => Some((0, boundary)),
        ("machine-part", Scheme::Pm | Scheme::CPatch) => Some((2, boundary)),
        ("cloth", Scheme::Pm | Scheme::CPatch) => Some((6, boundary)),
        _ => None,
    }
}

#[test]
fn every_scheme_makes_every_shape_or_says_where_not() {
    for info in shapes() {
        let mesh = shape(info.name).expect("built in");
        for scheme in Scheme::ALL {
            let expected = lack(info.name, scheme).map(|(face, what)| {
                let name = scheme.name();
                format!(
                    "face {face}: the scheme {name} has no patches for {what}: choose the scheme gregory, which has, or name it as fallback"
                )
            });
            for construction in Construction::ALL {
                let options = ModelOptions { scheme, construction, ..ModelOptions::default() };
                let error = ModelTables::new(&mesh, &options).err().map(|error| error.to_string());
                assert_eq!(error, expected, "{} {scheme:?} {construction:?}", info.name);
            }
        }
    }
    let mesh = shape("tetrahedron").expect("built in");
    let options = ModelOptions { scheme: Scheme::Acc, ..ModelOptions::default() };
    let error = ModelTables::new(&mesh, &options).expect_err("triangles").to_string();
    assert!(error.starts_with("face 0: the scheme acc has no patches for triangles: "), "{error}");
}

/// A vertex between two quads, back to back.
#[test]
fn pm_needs_three_faces_at_a_vertex() {
    let data = MeshData {
        positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.2], [0.0, 1.0, 0.0]],
        face_sizes: vec![4, 4],
        face_vertices: vec![0, 1, 2, 3, 3, 2, 1, 0],
        ..MeshData::default()
    };
    let mesh = ControlMesh::new(data).expect("a pillow");
    let options = ModelOptions { scheme: Scheme::Pm, ..ModelOptions::default() };
    let error = ModelTables::new(&mesh, &options).expect_err("two faces").to_string();
    let expected = "face 0: the scheme pm has no patches for faces at a vertex with two faces: ";
    assert!(error.starts_with(expected), "{error}");
}
