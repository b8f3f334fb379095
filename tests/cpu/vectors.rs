//! Control points, evaluation and refinement against reference vectors, which an independent float64 implementation wrote:
//! those of `tests/vectors`, and all of `../shared/reference/vectors` where that is.

use crate::common::vectors;
use ash_subdiv::limit::{LimitSurface, refine};
use ash_subdiv::mesh::{Corner, Crease, CreaseMethod};
use ash_subdiv::patch::{Blend, Scheme};
use ash_subdiv::topology::{PatchKind, Topology};
use ash_subdiv::{ControlMesh, MeshData};
use glam::{DVec3, Vec3};
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn points(value: &Value) -> Vec<DVec3> {
    value.as_array().expect("an array").iter().map(|p| DVec3::from_slice(&numbers(p))).collect()
}

fn mesh(vector: &Value, crease_method: CreaseMethod) -> ControlMesh {
    let rows = |key: &str| vector.get(key).and_then(Value::as_array).into_iter().flatten().map(numbers);
    let faces: Vec<Vec<u32>> = rows("faces").map(|f| f.iter().map(|&v| v as u32).collect()).collect();
    ControlMesh::new(MeshData {
        positions: points(&vector["positions"]).into_iter().map(Into::into).collect(),
        face_sizes: faces.iter().map(|f| f.len() as u32).collect(),
        face_vertices: faces.concat(),
        creases: rows("creases")
            .map(|c| Crease { vertices: [c[0] as u32, c[1] as u32], sharpness: c[2] as f32 })
            .collect(),
        corners: rows("corners").map(|c| Corner { vertex: c[0] as u32, sharpness: c[1] as f32 }).collect(),
        crease_method,
        ..MeshData::default()
    })
    .expect("the vectors are manifold meshes")
}

/// The Gregory points of every face that has some in the vector file, as `T` makes them, for all faces: regular ones too.
fn gregory<T: Blend>(topology: &Topology, face: u32, vertex: impl Fn(u32) -> T) -> Vec<T> {
    let size = topology.mesh().face(face).len();
    let kind = if size == 3 { PatchKind::Triangle } else { PatchKind::IrregularQuad };
    Scheme::Gregory.control_points(topology, face, kind, vertex)
}

fn for_each_gregory(mut visit: impl FnMut(&str, &Topology, u32, &Value)) {
    let mut faces = 0;
    for (name, vector) in vectors() {
        let Some(expected) = vector.get("gregory") else { continue };
        let mesh = mesh(&vector, CreaseMethod::Uniform);
        let topology = Topology::new(&mesh);
        for (face, expected) in expected.as_object().unwrap() {
            visit(&name, &topology, face.parse().unwrap(), expected);
            faces += 1;
        }
    }
    assert!(faces > 30, "the vectors hold {faces} faces");
}

#[test]
fn gregory_points_agree_in_f64() {
    for_each_gregory(|name, topology, face, expected| {
        let ours = gregory(topology, face, |v| topology.mesh().position(v));
        let expected = points(&expected["cp"]);
        assert_eq!(ours.len(), expected.len());
        for (i, (ours, expected)) in ours.iter().zip(expected).enumerate() {
            let error = (*ours - expected).length();
            assert!(error < 1e-12 * topology.mesh().diagonal(), "{name} face {face} point {i}: {ours} not {expected}");
        }
    });
}

#[test]
fn gregory_points_agree_in_f32() {
    for_each_gregory(|name, topology, face, expected| {
        let ours: Vec<Vec3> = gregory(topology, face, |v| topology.mesh().position(v).as_vec3());
        for (i, (ours, expected)) in ours.iter().zip(points(&expected["cp"])).enumerate() {
            let error = (ours.as_dvec3() - expected).length();
            assert!(error < 1e-6 * topology.mesh().diagonal(), "{name} face {face} point {i}: {ours} not {expected}");
        }
    });
}

#[test]
fn evaluation_agrees() {
    for_each_gregory(|name, topology, face, expected| {
        let points_f64 = gregory(topology, face, |v| topology.mesh().position(v));
        let kind = if points_f64.len() == 15 { PatchKind::Triangle } else { PatchKind::IrregularQuad };
        let positions = points(&expected["pos"]);
        let normals = points(&expected["normal_approx"]);
        for (i, at) in expected["params"].as_array().unwrap().iter().enumerate() {
            let at = numbers(at);
            let sample = Scheme::Gregory.evaluate(kind, &points_f64, at[0], at[1]);
            let position_error = (sample.position - positions[i]).length();
            assert!(position_error < 1e-12 * topology.mesh().diagonal(), "{name} face {face} at {at:?}");
            let angle = sample.normal.angle_between(normals[i]);
            assert!(angle < 1e-7, "{name} face {face} at {at:?}: normal off by {angle}");
        }
    });
}

#[test]
fn regular_faces_are_the_gregory_patch() {
    for_each_gregory(|name, topology, face, _| {
        if topology.patch_kind(face) != Some(PatchKind::Regular) {
            return;
        }
        let vertex = |v| topology.mesh().position(v);
        let gregory = gregory(topology, face, vertex);
        let bicubic = Scheme::Gregory.control_points(topology, face, PatchKind::Regular, vertex);
        for (u, v) in [(0.0, 0.0), (0.3, 0.0), (0.2, 0.7), (1.0, 0.4), (0.9, 1.0)] {
            let a = Scheme::Gregory.evaluate(PatchKind::IrregularQuad, &gregory, u, v);
            let b = Scheme::Gregory.evaluate(PatchKind::Regular, &bicubic, u, v);
            assert!((a.position - b.position).length() < 1e-12, "{name} face {face} at {u} {v}");
            assert!((a.normal - b.normal).length() < 1e-12, "{name} face {face} at {u} {v}");
        }
    });
}

#[test]
fn refinement_agrees() {
    for (name, vector) in vectors() {
        let Some(order) = vector.get("subdiv1") else { continue };
        let edges: Vec<_> = order["edge_vertices"].as_array().unwrap().iter().map(numbers).collect();
        for (method, key) in [(CreaseMethod::Uniform, "uniform"), (CreaseMethod::Chaikin, "chaikin")] {
            let expected = vector.get(format!("subdiv1_{key}")).unwrap_or(&order["positions"]);
            let mesh = mesh(&vector, method);
            check_refined(&name, &mesh, &points(expected), &edges);
            // The vertices of the coarse mesh after a second step, which sees the sharpness the first one left.
            let Some(second) = vector.get(format!("subdiv2_{key}_first")) else { continue };
            let once = refine(&Topology::new(&mesh)).expect("small").mesh;
            let twice = refine(&Topology::new(&once)).expect("small").mesh;
            for (v, expected) in points(second).into_iter().enumerate().take(mesh.vertex_count()) {
                let error = (twice.position(v as u32) - expected).length();
                assert!(error < 1e-7 * mesh.diagonal(), "{name} {key}: vertex {v} after two steps");
            }
        }
    }
}

/// Where finite sharpness has worn off. Sharpness is f32, as in OpenSubdiv; the vectors have it in f64.
#[test]
fn limit_points_of_semi_sharp_meshes_agree() {
    let mut meshes = 0;
    for (name, vector) in vectors() {
        for (method, key) in [(CreaseMethod::Uniform, "uniform"), (CreaseMethod::Chaikin, "chaikin")] {
            let Some(expected) = vector.get(format!("limit_vertices_{key}")) else { continue };
            let mesh = mesh(&vector, method);
            let surface = LimitSurface::new(&mesh).expect("small");
            for (v, expected) in points(expected).into_iter().enumerate() {
                let error = (surface.limit_vertex(v as u32).position - expected).length() / mesh.diagonal();
                assert!(error < 1e-7, "{name} {key}: vertex {v} is off by {error:e}");
            }
            meshes += 1;
        }
    }
    assert!(meshes >= 4, "{meshes}");
}

fn check_refined(name: &str, mesh: &ControlMesh, positions: &[DVec3], edges: &[Vec<f64>]) {
    let topology = Topology::new(mesh);
    let refined = refine(&topology).expect("small").mesh;
    let vertices = mesh.vertex_count();
    // Sharpness is f32, as in OpenSubdiv; the vectors have it in f64.
    let tolerance = if mesh.data().creases.is_empty() { 1e-12 } else { 1e-7 };
    let close = |ours: DVec3, index: usize, what: &str| {
        let error = (ours - positions[index]).length();
        assert!(error < tolerance * mesh.diagonal(), "{name}: {what} {index} is off by {error:e}");
    };
    // The children of corner h: its vertex, its edge, its face.
    for h in 0..mesh.corner_count() as u32 {
        let child = refined.face(h);
        let ends = [topology.mesh_vertex(h), topology.mesh_vertex(topology.next(h))];
        let edge = edges.iter().position(|e| [e[0] as u32, e[1] as u32] == ends || [e[1] as u32, e[0] as u32] == ends);
        close(refined.position(child[0]), ends[0] as usize, "vertex");
        close(refined.position(child[1]), vertices + edge.expect("an edge"), "edge");
        close(refined.position(child[2]), vertices + edges.len() + topology.face(h) as usize, "face");
    }
}

#[test]
fn acc_points_agree() {
    let mut faces = 0;
    for (name, vector) in vectors() {
        let Some(expected) = vector.get("acc") else { continue };
        let mesh = mesh(&vector, CreaseMethod::Uniform);
        let topology = Topology::new(&mesh);
        for (face, expected) in expected.as_object().unwrap() {
            faces += 1;
            let net = |key: &str| -> Vec<Vec<DVec3>> { expected[key].as_array().unwrap().iter().map(points).collect() };
            let (b, du, dv) = (net("b"), net("U"), net("V"));
            let face = face.parse().unwrap();
            let vertex = |v| mesh.position(v);
            let ours = Scheme::Acc.control_points(&topology, face, PatchKind::IrregularQuad, vertex);
            let close = |ours: DVec3, expected: DVec3, what: String| {
                let error = (ours - expected).length();
                assert!(error < 1e-12 * mesh.diagonal(), "{name} face {face} {what}: {ours}, not {expected}");
            };
            for i in 0..16 {
                close(ours[i], b[i / 4][i % 4], format!("b {i}"));
            }
            let [t, x] = [16, 18].map(|at| move |k: usize, side: usize| at + 4 * k + side);
            // Where the corners' vectors stand in the nets: (i, j) of U, or of V, and the sign.
            for (slot, [i, j], sign) in [
                (t(0, 0), [0, 0], 1.0),
                (t(1, 1), [2, 0], -1.0),
                (t(2, 0), [2, 3], -1.0),
                (t(3, 1), [0, 3], 1.0),
                (x(0, 1), [0, 1], 1.0),
                (x(3, 0), [0, 2], 1.0),
                (x(1, 0), [2, 1], -1.0),
                (x(2, 1), [2, 2], -1.0),
            ] {
                close(sign * ours[slot], du[i][j], format!("U {i} {j}"));
            }
            for (slot, [i, j], sign) in [
                (t(0, 1), [0, 0], 1.0),
                (t(1, 0), [3, 0], 1.0),
                (t(2, 1), [3, 2], -1.0),
                (t(3, 0), [0, 2], -1.0),
                (x(0, 0), [1, 0], 1.0),
                (x(1, 1), [2, 0], 1.0),
                (x(2, 0), [2, 2], -1.0),
                (x(3, 1), [1, 2], -1.0),
            ] {
                close(sign * ours[slot], dv[i][j], format!("V {i} {j}"));
            }
            check_acc_samples(&name, &mesh, &ours, expected);
        }
    }
    assert!(faces >= 14, "the vectors hold {faces} faces");
}

fn check_acc_samples(name: &str, mesh: &ControlMesh, ours: &[DVec3], expected: &Value) {
    let Some(parameters) = expected.get("params") else { return };
    let normals = expected.get("normal").map(points);
    for (i, at) in parameters.as_array().unwrap().iter().enumerate() {
        let at = numbers(at);
        let sample = Scheme::Acc.evaluate(PatchKind::IrregularQuad, ours, at[0], at[1]);
        let error = (sample.position - points(&expected["pos"])[i]).length();
        assert!(error < 1e-12 * mesh.diagonal(), "{name} at {at:?}: position off by {error}");
        if let Some(normals) = &normals {
            assert!(sample.normal.angle_between(normals[i]) < 1e-7, "{name} at {at:?}: normal");
        }
    }
}

#[test]
fn pm_points_agree() {
    let mut faces = 0;
    for (name, vector) in vectors() {
        let Some(expected) = vector.get("pm") else { continue };
        let mesh = mesh(&vector, CreaseMethod::Uniform);
        let topology = Topology::new(&mesh);
        for (face, expected) in expected.as_object().unwrap() {
            let face = face.parse().unwrap();
            let m = mesh.face(face).len();
            if m > 4 {
                continue;
            }
            faces += 1;
            let kind = if m == 3 { PatchKind::Triangle } else { PatchKind::IrregularQuad };
            let ours = Scheme::Pm.control_points(&topology, face, kind, |v| mesh.position(v));
            let coefficients = |key: &str| points(&expected["coef"][key]);
            let (tp, tm) = (coefficients("tp"), coefficients("tm"));
            let edges = tp.into_iter().zip(tm).flat_map(|(plus, minus)| [plus, minus]);
            let inner = ["b211", "b121", "b112"].map(coefficients).concat();
            let theirs: Vec<_> = coefficients("v").into_iter().chain(edges).chain(inner).collect();
            assert_eq!(ours.len(), theirs.len());
            // patch_maths D has the t- of corner i - 1 in b112 of a triangle, which a mirrored mesh mirrors; the file has
            // that of corner i + 1, which it does not. Their mean, the centre, is the same.
            let exact = if m == 3 { 5 * m } else { 6 * m };
            for (i, (ours, theirs)) in ours.iter().zip(&theirs).enumerate().take(exact) {
                let error = (*ours - *theirs).length();
                assert!(error < 1e-12 * mesh.diagonal(), "{name} face {face} point {i}: {ours}, not {theirs}");
            }
            let centre = |points: &[DVec3]| points[5 * m..].iter().sum::<DVec3>() / m as f64;
            assert!((centre(&ours) - centre(&theirs)).length() < 1e-12 * mesh.diagonal(), "{name} face {face}");
            check_pm_samples(&name, &mesh, &ours, expected);
        }
    }
    assert!(faces >= 14, "the vectors hold {faces} faces");
}

/// The vector files go through the sectors, each at the same barycentric parameters.
fn check_pm_samples(name: &str, mesh: &ControlMesh, ours: &[DVec3], expected: &Value) {
    let parameters = points(&expected["sector_params"]);
    let samples: Vec<_> = expected["pos_normal"].as_array().unwrap().iter().map(points).collect();
    if ours.len() != 24 {
        return;
    }
    for (sector, samples) in samples.chunks(parameters.len()).enumerate() {
        for (at, sample) in parameters.iter().zip(samples) {
            let [along, inwards] = [at.y + at.z / 2.0, at.z / 2.0];
            let (u, v) =
                [(along, inwards), (1.0 - inwards, along), (1.0 - along, 1.0 - inwards), (inwards, 1.0 - along)]
                    [sector];
            let evaluated = Scheme::Pm.evaluate(PatchKind::IrregularQuad, ours, u, v);
            let error = (evaluated.position - sample[0]).length();
            assert!(error < 1e-12 * mesh.diagonal(), "{name} sector {sector} at {at}: off by {error}");
            let angle = evaluated.normal.angle_between(sample[1]);
            assert!(angle < 1e-7, "{name} sector {sector} at {at}: normal off by {angle}");
        }
    }
}
