//! Refinement of texture coordinates by OpenSubdiv's six rules.

use FaceVaryingRule::{All, Boundaries, CornersOnly, CornersPlus1, CornersPlus2, None};
use ash_subdiv::limit::refine;
use ash_subdiv::mesh::{BoundaryRule, Corner, Crease, CreaseMethod, FaceVarying, FaceVaryingRule};
use ash_subdiv::topology::Topology;
use ash_subdiv::{ControlMesh, MeshData};

const SIDE: u32 = 4;
/// The vertex in the middle of [`grid`], and the faces around it, counter-clockwise.
const MIDDLE: u32 = 12;
const AROUND: [u32; 4] = [5, 6, 10, 9];

/// 4 x 4 quads, unevenly spaced.
fn grid() -> MeshData {
    let n = SIDE + 1;
    let at = |i: u32, j: u32| j * n + i;
    let quads = (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (i, j)));
    let position = |v: u32| [f64::from(v % n), f64::from(v / n)].map(|x| x + 0.1 * x * x * x);
    MeshData {
        positions: (0..n * n).map(|v| [position(v)[0], position(v)[1], 0.25 * f64::from(v % 3)]).collect(),
        face_sizes: vec![4; (SIDE * SIDE) as usize],
        face_vertices: quads.flat_map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]).collect(),
        ..MeshData::default()
    }
}

/// Texture coordinates x and y, with a value of its own at every vertex for each region.
fn with_regions(mut data: MeshData, region: impl Fn(u32, u32) -> u32) -> MeshData {
    let count = data.positions.len();
    let values = |_| data.positions.iter().map(|p| [p[0] as f32, p[1] as f32]);
    let index = |(h, &vertex): (usize, &u32)| region(h as u32 / 4, vertex) * count as u32 + vertex;
    data.texcoords = Some(FaceVarying {
        values: (0..4).flat_map(values).collect(),
        indices: data.face_vertices.iter().enumerate().map(index).collect(),
    });
    data
}

fn refined(data: MeshData, levels: u32) -> ControlMesh {
    let mut mesh = ControlMesh::new(data).unwrap();
    for _ in 0..levels {
        mesh = refine(&Topology::new(&mesh)).unwrap().mesh;
    }
    mesh
}

fn texcoord(mesh: &ControlMesh, corner: usize) -> [f32; 2] {
    let texcoords = mesh.data().texcoords.as_ref().unwrap();
    texcoords.values[texcoords.indices[corner] as usize]
}

#[test]
fn without_seams_they_move_as_positions_do() {
    for method in [CreaseMethod::Uniform, CreaseMethod::Chaikin] {
        for (boundary, rule) in [
            (BoundaryRule::EdgeOnly, None),
            (BoundaryRule::EdgeAndCorner, None),
            (BoundaryRule::EdgeAndCorner, CornersOnly),
            (BoundaryRule::EdgeAndCorner, CornersPlus1),
            (BoundaryRule::EdgeAndCorner, CornersPlus2),
        ] {
            let crease = |a, b, sharpness| Crease { vertices: [a, b], sharpness };
            let data = MeshData {
                boundary,
                face_varying_rule: rule,
                crease_method: method,
                creases: vec![crease(6, 7, 10.0), crease(7, 12, 1.6), crease(12, 17, 0.7), crease(10, 11, 2.2)],
                corners: vec![Corner { vertex: 18, sharpness: 1.3 }],
                ..with_regions(grid(), |_, _| 0)
            };
            let mesh = refined(data, 3);
            for (h, &vertex) in mesh.data().face_vertices.iter().enumerate() {
                let ([u, v], p) = (texcoord(&mesh, h), mesh.position(vertex));
                assert!((f64::from(u) - p.x).abs().max((f64::from(v) - p.y).abs()) < 1e-5, "{rule:?}: {u} {v} not {p}");
            }
            // Vertices and values are shared in the same way, so that the next step is right too.
            let values = &mesh.data().texcoords.as_ref().unwrap().values;
            assert_eq!(values.len(), mesh.vertex_count());
        }
    }
}

#[test]
fn a_seam_is_a_curve_of_its_own() {
    let at = |rule| {
        let data = with_regions(grid(), |face, _| u32::from(face % SIDE >= 2));
        let mesh = refined(MeshData { face_varying_rule: rule, ..data }, 1);
        // The child of the corner of face 5 at the middle vertex.
        let child = 4 * (4 * AROUND[0] as usize + 2);
        assert_eq!(mesh.data().face_vertices[child], MIDDLE);
        texcoord(&mesh, child)
    };
    let y = |j: f32| j + 0.1 * j * j * j;
    let smooth = [y(2.0), (y(1.0) + 6.0 * y(2.0) + y(3.0)) / 8.0];
    for (rule, expected) in [
        (None, smooth),
        (CornersOnly, smooth),
        (CornersPlus1, smooth),
        (CornersPlus2, smooth),
        (Boundaries, [y(2.0); 2]),
        (All, [y(2.0); 2]),
    ] {
        let found = at(rule);
        assert!((found[0] - expected[0]).abs() + (found[1] - expected[1]).abs() < 1e-6, "{rule:?}: {found:?}");
    }
}

/// For each rule, whether the values at the middle vertex stay where they are, in the order of [`AROUND`].
fn stay(data: &MeshData) -> [(FaceVaryingRule, [bool; 4]); 5] {
    [None, CornersOnly, CornersPlus1, CornersPlus2, Boundaries].map(|rule| {
        let coarse = ControlMesh::new(data.clone()).unwrap();
        let levels = 2;
        let mesh = refined(MeshData { face_varying_rule: rule, ..data.clone() }, levels);
        let stays = AROUND.map(|face| {
            let corner = coarse.face_corners(face).find(|&h| data.face_vertices[h] == MIDDLE).unwrap();
            // The first child's first child.
            let child = corner * 4usize.pow(levels);
            assert_eq!(mesh.data().face_vertices[child], MIDDLE);
            let ([u, v], [x, y]) = (texcoord(&mesh, child), texcoord(&coarse, corner));
            (u - x).abs() + (v - y).abs() < 1e-6
        });
        (rule, stays)
    })
}

#[test]
fn three_values_at_a_vertex_are_a_junction() {
    // The left half, and two quarters.
    let data = with_regions(grid(), |face, _| if face % SIDE < 2 { 0 } else { 1 + face / 8 });
    assert_eq!(
        stay(&data),
        [
            (None, [false; 4]),
            (CornersOnly, [false, true, true, false]),
            (CornersPlus1, [true; 4]),
            (CornersPlus2, [true; 4]),
            (Boundaries, [true; 4]),
        ]
    );
}

#[test]
fn a_value_of_one_face_makes_the_other_a_concave_corner() {
    let data = with_regions(grid(), |face, _| u32::from(face % SIDE >= 2 && face >= 8));
    assert_eq!(
        stay(&data),
        [
            (None, [false; 4]),
            (CornersOnly, [false, false, true, false]),
            (CornersPlus1, [false, false, true, false]),
            (CornersPlus2, [true; 4]),
            (Boundaries, [true; 4]),
        ]
    );
}

#[test]
fn where_a_seam_ends_is_a_dart() {
    // From the middle of the lower boundary up to the middle vertex, where all faces have the same value.
    let data =
        with_regions(grid(), |face, vertex| u32::from(face % SIDE >= 2 && face < 8 && vertex % 5 == 2 && vertex < 10));
    assert_eq!(
        stay(&data),
        [
            (None, [false; 4]),
            (CornersOnly, [false; 4]),
            (CornersPlus1, [false; 4]),
            (CornersPlus2, [true; 4]),
            (Boundaries, [true; 4]),
        ]
    );
}

#[test]
fn a_value_in_two_places_stays() {
    // The middle vertex has one value, and seams on all sides.
    let quarter = |face: u32| u32::from(face % SIDE >= 2) + 2 * (face / 8);
    let data = with_regions(grid(), |face, vertex| if vertex == MIDDLE { 0 } else { quarter(face) });
    for (rule, stays) in stay(&data) {
        assert_eq!(stays, [true; 4], "{rule:?}");
    }
}
