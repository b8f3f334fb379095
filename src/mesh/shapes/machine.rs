//! The machine part: a hub with a bore, a flange with bolt bosses, and ribs; sharp and semi-sharp edges.

use super::sculpt::{Patch, Sculpt};
use crate::mesh::{ControlMesh, Corner, Crease, MeshData, MeshError, NO_TWIN, SHARPNESS_INFINITE};
use glam::{DVec3, dvec3};
use std::f64::consts::TAU;

/// The section that is turned about the y axis, counter-clockwise: `[radius, height]`.
const PROFILE: [[f64; 2]; 17] = [
    [0.36, -0.30],
    [0.72, -0.30],
    [1.02, -0.30],
    [1.28, -0.30],
    [1.54, -0.30],
    [1.68, -0.30],
    [1.68, -0.05],
    [1.54, -0.05],
    [1.28, -0.05],
    [1.02, -0.05],
    [0.90, -0.05],
    [0.74, -0.05],
    [0.71, 0.15],
    [0.68, 0.36],
    [0.64, FACE],
    [0.36, FACE],
    [0.36, 0.15],
];
/// The height of the hub's face, and of the bosses' faces.
const FACE: f64 = 0.65;
const BOSS: f64 = 0.08;
/// Where the profile has the flange's bolt circle, below and above, and the ribs.
const BOLTS_BELOW: usize = 2;
const BOLTS_ABOVE: usize = 7;
const RIBS: usize = 9;

/// Bosses, and ribs between them.
const PERIODS: usize = 5;
/// Sectors of the turned body: three a boss, three from boss to boss with the rib in the middle.
const SECTORS: usize = 6 * PERIODS;

/// Edges between faces that meet at more than this angle are creases.
const CREASE_ANGLE: f64 = 0.95;

pub(super) fn build() -> Result<MeshData, MeshError> {
    let mut s = Sculpt::default();
    let body = turned_body(&mut s);
    for period in 0..PERIODS {
        boss(&mut s, &body, 6 * period);
        rib(&mut s, &body, 6 * period + 4);
    }
    let (positions, face_vertices) = s.finish();
    let face_sizes = vec![4; face_vertices.len() / 4];
    let mesh = ControlMesh::new(MeshData { positions, face_sizes, face_vertices, ..MeshData::default() })?;
    let creases = creases(&mesh);
    // The outer tips of the ribs.
    let tip = |v: u32| mesh.position(v).abs_diff_eq(rib_end(mesh.position(v)), 1e-9);
    let corners = (0..mesh.vertex_count() as u32).filter(|&v| tip(v));
    let corners = corners.map(|vertex| Corner { vertex, sharpness: SHARPNESS_INFINITE }).collect();
    Ok(MeshData { creases, corners, ..mesh.into_data() })
}

fn turned_body(s: &mut Sculpt) -> Patch {
    for sector in 0..SECTORS {
        let (sin, cos) = (TAU * sector as f64 / SECTORS as f64).sin_cos();
        for [radius, height] in PROFILE {
            s.add_vertex(dvec3(radius * cos, height, radius * sin));
        }
    }
    let number = |i: usize, j: usize| (j % SECTORS * PROFILE.len() + i % PROFILE.len()) as u32;
    let body = Patch::new(PROFILE.len(), SECTORS, number);
    s.add_faces(&body);
    body
}

/// A boss on the flange with a hole through both.
fn boss(s: &mut Sculpt, body: &Patch, sector: usize) {
    let (top, bottom) = (body.sub(BOLTS_ABOVE, sector, 2, 3), body.sub(BOLTS_BELOW, sector, 2, 3));
    let height = BOSS - PROFILE[BOLTS_ABOVE][1];
    let top = s.bump(&top, DVec3::Y, &[(0.0, 0.215), (height, 0.195), (height, 0.115)]).cap;
    let bottom = s.bump(&bottom, DVec3::NEG_Y, &[(0.0, 0.115)]).cap;
    s.remove_faces(&top);
    s.remove_faces(&bottom);
    // Columns run inward above and outward below.
    let rim = top.rim();
    let hole = Patch::new(rim.len() - 1, 1, |i, j| {
        let (column, row) = rim[i];
        if j == 0 { top.vertex(column, row) } else { bottom.vertex(2 - column, row) }
    });
    s.add_faces(&hole);
}

/// Half the thickness of a rib, and its edge's ends: `[radius, height]`.
const RIB_HALF: f64 = 0.055;
const RIB_LOW: [f64; 2] = [1.02, 0.05];
const RIB_HIGH: [f64; 2] = [0.76, 0.42];

/// A rib in the corner between flange and hub, one sector wide.
fn rib(s: &mut Sculpt, body: &Patch, sector: usize) {
    let base = body.sub(RIBS, sector, 4, 1);
    let out = s.centre(&base).with_y(0.0).normalize();
    let along = dvec3(-out.z, 0.0, out.x);
    s.extrude(&base, |i, j| {
        let k = i as f64 / 4.0;
        let [radius, height] = [0, 1].map(|c| RIB_LOW[c] + (RIB_HIGH[c] - RIB_LOW[c]) * k);
        out * radius + DVec3::Y * height + along * (RIB_HALF * (2.0 * j as f64 - 1.0))
    });
}

/// Where a vertex would be if it were the lower end of a rib's edge; itself then, elsewhere if not.
fn rib_end(position: DVec3) -> DVec3 {
    let [radius, height] = RIB_LOW;
    position.with_y(0.0).normalize() * radius.hypot(RIB_HALF) + DVec3::Y * height
}

/// Creases where faces meet at an angle: infinitely sharp, but for the hub's and the bosses' faces.
fn creases(mesh: &ControlMesh) -> Vec<Crease> {
    let normal = |half_edge: u32| {
        let p = |k: usize| mesh.position(mesh.face(half_edge / 4)[k]);
        (p(2) - p(0)).cross(p(3) - p(1))
    };
    let at = |position: DVec3, height: f64| (position.y - height).abs() < 1e-9;
    let mut creases = Vec::new();
    for face in 0..mesh.face_count() as u32 {
        for (k, half_edge) in mesh.face_corners(face).enumerate() {
            let twin = mesh.twins()[half_edge];
            if twin == NO_TWIN
                || twin < half_edge as u32
                || normal(half_edge as u32).angle_between(normal(twin)) < CREASE_ANGLE
            {
                continue;
            }
            let vertices = [mesh.face(face)[k], mesh.face(face)[(k + 1) % 4]];
            let both = |test: &dyn Fn(DVec3) -> bool| vertices.iter().all(|&v| test(mesh.position(v)));
            let sharpness = if both(&|p| at(p, FACE)) {
                2.0
            } else if both(&|p| at(p, BOSS)) {
                1.5
            } else {
                SHARPNESS_INFINITE
            };
            creases.push(Crease { vertices, sharpness });
        }
    }
    creases
}
