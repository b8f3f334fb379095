//! The creature: a young dragon, grown out of a trunk by extrusion, one half, then mirrored.

use super::sculpt::{Patch, Ring, Sculpt, Tube};
use super::with_atlas;
use crate::mesh::{ControlMesh, FaceVarying, MeshData, MeshError};
use glam::{DVec3, dvec3};

/// Columns of half the trunk, and rows of its ends.
const WIDE: usize = 4;
const DEEP: usize = 4;
/// Cells of the trunk's wall, from the front middle round to the back middle.
const BACK: usize = 2 * WIDE + DEEP - 1;

pub(super) fn creature() -> Result<ControlMesh, MeshError> {
    let (positions, face_vertices) = build();
    let face_sizes = vec![4; face_vertices.len() / 4];
    with_atlas(MeshData { positions, face_sizes, face_vertices, ..MeshData::default() })
}

/// The same with a third of the quads split along their shorter diagonals.
pub(super) fn mixed(quads: &MeshData) -> MeshData {
    let at = |vertex: u32| DVec3::from(quads.positions[vertex as usize]);
    let mut face_sizes = Vec::new();
    let mut corners = Vec::new();
    for face in 0..quads.face_sizes.len() {
        let corner = |k: usize| 4 * face + k % 4;
        // Hashed, so that the triangles are scattered, and the same in every run.
        if (face as u32).wrapping_mul(0x9E37_79B9).rotate_left(13).wrapping_mul(0x85EB_CA6B) >> 16 >= 0x1_0000 / 3 {
            face_sizes.push(4);
            corners.extend((0..4).map(corner));
            continue;
        }
        let diagonal = |k: usize| at(quads.face_vertices[corner(k)]).distance(at(quads.face_vertices[corner(k + 2)]));
        let k = usize::from(diagonal(1) < diagonal(0));
        face_sizes.extend([3, 3]);
        corners.extend([k, k + 1, k + 2, k, k + 2, k + 3].map(corner));
    }
    let texcoords = quads.texcoords.as_ref().map(|attribute| FaceVarying {
        values: attribute.values.clone(),
        indices: corners.iter().map(|&corner| attribute.indices[corner]).collect(),
    });
    let face_vertices = corners.iter().map(|&corner| quads.face_vertices[corner]).collect();
    MeshData { positions: quads.positions.clone(), face_sizes, face_vertices, texcoords, ..MeshData::default() }
}

fn build() -> (Vec<[f64; 3]>, Vec<u32>) {
    let mut s = Sculpt::default();
    let (bottom, trunk) = trunk(&mut s);
    jaws(&mut s, &trunk.wall);
    face(&mut s, &trunk);
    arm(&mut s, &trunk.wall);
    wing(&mut s, &trunk.wall);
    leg(&mut s, &bottom);
    tail(&mut s, &trunk.wall);
    spines(&mut s, &trunk.wall);
    s.relax_half(0.12);
    s.mirrored().finish()
}

/// From the seat to the crown of the head: `[y, z, half width, half depth]`.
const TRUNK: [[f64; 4]; 12] = [
    [-0.80, 0.00, 0.50, 0.46],
    [-0.62, 0.00, 0.66, 0.60],
    [-0.34, 0.04, 0.72, 0.68],
    [-0.06, 0.03, 0.58, 0.58],
    [0.16, 0.00, 0.45, 0.44],
    [0.34, 0.00, 0.36, 0.36],
    [0.46, 0.06, 0.42, 0.40],
    [0.60, 0.10, 0.66, 0.56],
    [0.80, 0.10, 0.78, 0.64],
    [1.02, 0.08, 0.80, 0.66],
    [1.26, 0.04, 0.72, 0.60],
    [1.46, 0.00, 0.48, 0.40],
];

fn trunk(s: &mut Sculpt) -> (Patch, Tube) {
    let at = |i: usize, j: usize| {
        let [y, z, width, depth] = TRUNK[0];
        let (a, b) = (i as f64 / WIDE as f64, 2.0 * j as f64 / DEEP as f64 - 1.0);
        dvec3(a * width * 0.8, y - 0.05 * (1.0 - b * b), z + b * depth * 0.8)
    };
    let bottom = Patch::new(WIDE, DEEP, |i, j| s.add_vertex(at(i, j))).halved();
    s.add_faces(&bottom);
    // The same rim seen from above. No faces: `tube` replaces them.
    let top = Patch::new(WIDE, DEEP, |i, j| bottom.vertex(i, DEEP - j)).halved();
    let keep = s.faces.clone();
    let ring = |&[y, z, width, depth]: &[f64; 4]| Ring { dome: 0.08, ..Ring::new([0.0, y, z], [width, depth]) };
    let rings: Vec<_> = TRUNK[1..].iter().map(ring).collect();
    let tube = s.tube(&top, &rings);
    s.faces.extend(keep);
    (bottom, tube)
}

fn jaws(s: &mut Sculpt, trunk: &Patch) {
    // Grown one after the other, so that the mouth is open between them.
    let upper = s.tube(
        &trunk.sub(0, 8, 3, 1).halved(),
        &[
            Ring::new([0.0, 0.97, 0.84], [0.48, 0.14]),
            Ring::new([0.0, 0.94, 1.02], [0.42, 0.14]),
            Ring::new([0.0, 0.93, 1.17], [0.33, 0.12]),
        ],
    );
    s.tube(
        &trunk.sub(0, 7, 3, 1).halved(),
        &[
            Ring::new([0.0, 0.65, 0.82], [0.44, 0.11]),
            Ring::new([0.0, 0.645, 0.97], [0.36, 0.09]),
            Ring::new([0.0, 0.67, 1.10], [0.27, 0.07]),
        ],
    );
    // Nostrils, and a tooth that shows.
    let nostril = upper.wall.cell(5, 2);
    s.bump(&nostril, dvec3(0.2, 1.0, 0.4), &[(0.035, 0.055), (-0.03, 0.04)]);
    let tooth = upper.wall.cell(2, 1);
    s.spike(&tooth, dvec3(0.09, -0.12, 0.02), DVec3::ZERO, &[[0.045, 0.045], [0.015, 0.015]]);
}

fn face(s: &mut Sculpt, trunk: &Tube) {
    let eye = trunk.wall.sub(2, 9, 2, 2);
    s.bump(&eye, dvec3(0.50, 0.30, 1.0), &[(0.12, 0.22), (0.11, 0.195), (0.07, 0.185), (0.13, 0.18), (0.19, 0.11)]);
    let ear = trunk.wall.sub(5, 9, 2, 1);
    s.spike(
        &ear,
        dvec3(0.62, 0.22, -0.28),
        dvec3(0.0, -0.3, 0.0),
        &[[0.12, 0.09], [0.20, 0.09], [0.17, 0.07], [0.05, 0.03]],
    );
    let horn = trunk.cap.cell(2, 2);
    s.spike(
        &horn,
        dvec3(0.22, 0.62, -0.30),
        dvec3(0.45, 0.2, -0.5),
        &[[0.13, 0.13], [0.12, 0.12], [0.10, 0.10], [0.075, 0.075], [0.045, 0.045], [0.015, 0.015]],
    );
    let cheek = trunk.wall.cell(6, 7);
    s.spike(&cheek, dvec3(0.26, -0.08, -0.12), DVec3::ZERO, &[[0.08, 0.08], [0.05, 0.05], [0.015, 0.015]]);
}

fn arm(s: &mut Sculpt, trunk: &Patch) {
    let arm = s.tube(
        &trunk.sub(4, 4, 3, 1),
        &[
            Ring::new([0.60, 0.20, 0.02], [0.20, 0.14]),
            Ring::new([0.78, 0.07, 0.08], [0.16, 0.14]),
            Ring::new([0.90, -0.09, 0.22], [0.15, 0.14]),
            Ring::new([0.92, -0.22, 0.42], [0.13, 0.12]),
            Ring::new([0.92, -0.24, 0.56], [0.17, 0.11]),
            Ring::new([0.92, -0.24, 0.68], [0.18, 0.09]),
        ],
    );
    for finger in 0..3 {
        let side = finger as f64 - 1.0;
        let reach = dvec3(0.12 * side, -0.08, 0.26);
        s.spike(&arm.cap.cell(finger, 0), reach, dvec3(0.0, 0.16, 0.0), &[[0.06, 0.06], [0.055, 0.055], [0.02, 0.02]]);
    }
}

fn wing(s: &mut Sculpt, trunk: &Patch) {
    let wing = s.tube(
        &trunk.sub(8, 2, 1, 3),
        &[
            Ring::new([0.52, 0.22, -0.56], [0.06, 0.16]),
            Ring::new([0.76, 0.46, -0.78], [0.05, 0.20]),
            Ring::new([1.06, 0.66, -0.94], [0.05, 0.42]),
            Ring::new([1.42, 0.74, -1.04], [0.05, 0.62]),
        ],
    );
    for finger in 0..3 {
        let side = finger as f64 - 1.0;
        s.spike(
            &wing.cap.cell(0, finger),
            dvec3(0.34, 0.08 + 0.16 * side, -0.06),
            DVec3::ZERO,
            &[[0.04, 0.15], [0.02, 0.04]],
        );
    }
}

fn leg(s: &mut Sculpt, bottom: &Patch) {
    let leg = s.tube(
        &bottom.sub(1, 1, 3, 2),
        &[
            Ring::new([0.42, -0.98, 0.04], [0.30, 0.30]),
            Ring::new([0.46, -1.16, 0.06], [0.25, 0.26]),
            Ring::new([0.48, -1.30, 0.04], [0.25, 0.25]),
            Ring::new([0.48, -1.46, 0.06], [0.23, 0.22]),
        ],
    );
    let foot = s.tube(&leg.wall.sub(5, 3, 3, 1), &[Ring::new([0.50, -1.38, 0.48], [0.27, 0.11])]);
    for toe in 0..3 {
        let side = 1.0 - toe as f64;
        s.spike(
            &foot.cap.cell(toe, 0),
            dvec3(0.10 * side, -0.04, 0.26),
            dvec3(0.0, 0.16, 0.0),
            &[[0.08, 0.08], [0.08, 0.08], [0.025, 0.025]],
        );
    }
}

fn tail(s: &mut Sculpt, trunk: &Patch) {
    let tail = s.tube(
        &trunk.sub(BACK - 1, 0, 2, 2).turned().halved(),
        &[
            Ring::new([0.0, -0.56, -0.80], [0.34, 0.32]),
            Ring::new([0.0, -0.66, -1.04], [0.27, 0.25]),
            Ring::new([0.0, -0.70, -1.28], [0.21, 0.20]),
            Ring::new([0.0, -0.64, -1.52], [0.17, 0.16]),
            Ring::new([0.0, -0.50, -1.72], [0.13, 0.13]),
            Ring::new([0.0, -0.30, -1.84], [0.10, 0.10]),
            Ring::new([0.0, -0.12, -1.88], [0.09, 0.08]),
            Ring::new([0.0, 0.00, -1.88], [0.26, 0.07]),
            Ring::new([0.0, 0.16, -1.86], [0.14, 0.05]),
            Ring::new([0.0, 0.30, -1.82], [0.03, 0.03]),
        ],
    );
    for row in [1, 3] {
        spine(s, &tail.wall.cell(0, row).halved(), dvec3(0.0, 0.22, -0.06), 0.09);
    }
}

fn spines(s: &mut Sculpt, trunk: &Patch) {
    for (row, size) in [(2, 0.10), (4, 0.10), (8, 0.11), (10, 0.11)] {
        spine(s, &trunk.cell(BACK, row).turned().halved(), dvec3(0.0, 0.10, -0.26), size);
    }
}

fn spine(s: &mut Sculpt, base: &Patch, reach: DVec3, size: f64) {
    s.spike(base, reach, DVec3::ZERO, &[[size, size], [0.6 * size, 0.6 * size], [0.15 * size, 0.15 * size]]);
}
