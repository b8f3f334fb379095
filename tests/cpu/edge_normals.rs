//! The one normal of an edge, from data of the edge alone, is the normal of both its faces; on the GPU, too.

use crate::common::edges::{SharedEdge, edge_parameters, shared_edges};
use crate::common::random::{random_creased_mesh, random_mesh};
use ash_subdiv::patch::edge::{Edge, edge_normal, edge_position};
use ash_subdiv::patch::{Frame, RingValues, Scheme};
use ash_subdiv::table::prepare;
use ash_subdiv::topology::Topology;
use ash_subdiv::{ControlMesh, shape, shapes};
use glam::DVec3;

const SCHEMES: [Scheme; 2] = [Scheme::Gregory, Scheme::GregoryFitted];

fn meshes() -> Vec<(String, ControlMesh)> {
    let built_in = shapes().iter().map(|info| {
        let mesh = shape(info.name).expect("built in");
        (info.name.to_owned(), prepare(&mesh, 0).expect("small").mesh().clone())
    });
    let random = (0..20).flat_map(|seed| {
        [(format!("random {seed}"), random_mesh(seed)), (format!("random creased {seed}"), random_creased_mesh(seed))]
    });
    built_in.chain(random).collect()
}

/// An edge as its first face's half-edge leads.
fn edge_of(scheme: Scheme, topology: &Topology, shared: &SharedEdge) -> Edge<DVec3> {
    let (face, k) = shared.sides[0];
    let corners = topology.mesh().face_corners(face);
    let h = (corners.start + k) as u32;
    let (start, end) = (topology.place(h), topology.place(topology.next(h)));
    let ring = |ring: u32| {
        let ring = &topology.rings()[ring as usize];
        RingValues::new(topology, ring, |v| topology.mesh().position(v))
    };
    let rings = [ring(start.ring), ring(end.ring)];
    let frames: [Frame<DVec3>; 2] = [scheme.frame(&rings[0]), scheme.frame(&rings[1])];
    // It is the minus edge of the corner at its end.
    let index = [start.index as usize, (end.index as usize + 1) % rings[1].shape.edges()];
    Edge::new(scheme, [&rings[0], &rings[1]], [&frames[0], &frames[1]], index)
}

#[test]
fn edge_normals_are_those_of_both_faces() {
    let mut edges = 0;
    for (name, mesh) in meshes() {
        let topology = Topology::new(&mesh);
        for scheme in SCHEMES {
            let patch = |face| {
                let kind = topology.patch_kind(face).expect("a triangle or quad");
                (kind, scheme.control_points(&topology, face, kind, |v| mesh.position(v)))
            };
            for shared in shared_edges(&topology).iter().filter(|edge| edge.smooth) {
                let edge = edge_of(scheme, &topology, shared);
                for t in [0.0, 0.2, 0.5, 0.9, 1.0] {
                    let normal = edge_normal(&edge, t, DVec3::ZERO);
                    let back = edge_normal(&edge.reversed(), 1.0 - t, DVec3::ZERO);
                    if normal.length() < 0.5 {
                        // Where tangents are parallel neither knows.
                        continue;
                    }
                    assert!(normal.distance(back) < 1e-9, "{name}: {normal} and {back}");
                    for ((face, k), t) in shared.sides.into_iter().zip([t, 1.0 - t]) {
                        let (kind, points) = patch(face);
                        let [u, v] = edge_parameters(kind, k, t);
                        let own = scheme.evaluate(kind, &points, u, v);
                        let scale = 1.0 + own.position.length();
                        assert!(
                            own.normal.distance(normal) < 2e-8,
                            "{name} {scheme:?} {:?}: {own:?} {normal}",
                            shared.sides
                        );
                        let along = if (face, k) == shared.sides[0] { t } else { 1.0 - t };
                        assert!(own.position.distance(edge_position(&edge, along)) < 1e-13 * scale);
                    }
                }
                edges += 1;
            }
        }
    }
    assert!(edges > 10_000, "{edges}");
}

#[cfg(feature = "headless")]
#[test]
fn the_gpu_has_the_same_normals_on_edges() {
    use ash_subdiv::capture::{CaptureDraw, Captured, Which};
    use ash_subdiv::{Construction, ModelOptions};
    use glam::Vec3;
    use std::collections::HashMap;
    let headless = crate::common::headless();
    for name in ["creature-mixed", "machine-part", "cloth"] {
        let mesh = shape(name).expect("built in");
        let topology = Topology::new(&mesh);
        for (scheme, construction) in
            [(Scheme::Gregory, Construction::TwoStage), (Scheme::GregoryFitted, Construction::Stencil)]
        {
            let options = ModelOptions { scheme, construction, shared_normals: true, ..ModelOptions::default() };
            let captured = Captured::new(&headless, &mesh, &options).expect("a model");
            let patches = captured.tables().plan().patches();
            let vertices = captured.vertices_of(&CaptureDraw::new(5.0), Which::OnEdges).expect("a capture");
            let mut of_faces: HashMap<u32, Vec<_>> = HashMap::new();
            for vertex in &vertices {
                of_faces.entry(patches[vertex.patch as usize].face).or_default().push(vertex);
            }
            let mut compared = 0;
            for shared in shared_edges(&topology).iter().filter(|edge| edge.smooth) {
                let edge = edge_of(scheme, &topology, shared);
                let (face, k) = shared.sides[0];
                let kind = topology.patch_kind(face).expect("a triangle or quad");
                for t in [0.2f32, 0.4, 0.6, 0.8] {
                    let at = edge_parameters(kind, k, t.into()).map(|x| x as f32);
                    let close = |v: &&&ash_subdiv::capture::CapturedVertex| {
                        (v.coordinate[0] - at[0]).abs().max((v.coordinate[1] - at[1]).abs()) < 1e-4
                    };
                    let vertex = of_faces[&face].iter().find(close).expect("a vertex there");
                    let twin = edge_normal(&edge, t.into(), DVec3::ZERO);
                    let gap = Vec3::from(vertex.normal).as_dvec3().distance(twin);
                    assert!(gap < 1e-3, "{name} {scheme:?} {:?}: {vertex:?} {twin}", shared.sides);
                    compared += 1;
                }
            }
            assert!(compared > 200, "{compared}");
        }
    }
    headless.finish_silent();
}
