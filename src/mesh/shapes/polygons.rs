//! Shapes with faces of many sizes, and the shape that comes of splitting such faces into quads.

use crate::mesh::MeshData;
use glam::{DVec3, dvec3};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// A mesh as a list of faces.
type Faces = Vec<Vec<u32>>;

fn data(positions: Vec<DVec3>, faces: &Faces) -> MeshData {
    MeshData {
        positions: positions.iter().map(DVec3::to_array).collect(),
        face_sizes: faces.iter().map(|face| face.len() as u32).collect(),
        face_vertices: faces.concat(),
        ..MeshData::default()
    }
}

/// The faces of a football drawn apart: its pentagons and hexagons, quads for its edges, triangles for its vertices.
pub(super) fn polygons() -> MeshData {
    let (positions, faces) = truncated_icosahedron();
    let (mut positions, faces) = expanded(&positions, &faces);
    for position in &mut positions {
        *position = position.normalize() * 1.3;
    }
    data(positions, &faces)
}

fn truncated_icosahedron() -> (Vec<DVec3>, Faces) {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let mut corners = Vec::new();
    for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        corners.extend([dvec3(0.0, a, b), dvec3(a, b, 0.0), dvec3(b, 0.0, a)]);
    }
    // The edges of the icosahedron have length 2; cutting at thirds makes every edge 2/3 long.
    let near = |a: DVec3, b: DVec3, length: f64| (a.distance(b) - length).abs() < 1e-6;
    let mut positions = Vec::new();
    for &from in &corners {
        positions.extend(corners.iter().filter(|&&to| near(from, to, 2.0)).map(|&to| from.lerp(to, 1.0 / 3.0)));
    }
    let mut normals = corners.clone();
    for (i, &a) in corners.iter().enumerate() {
        for (j, &b) in corners.iter().enumerate().skip(i + 1) {
            let third = corners.iter().skip(j + 1).filter(|&&c| near(a, b, 2.0) && near(b, c, 2.0) && near(a, c, 2.0));
            normals.extend(third.map(|&c| a + b + c));
        }
    }
    // A face: the vertices farthest along its normal, in order around it.
    let face = |normal: &DVec3| {
        let far = positions.iter().map(|p| p.dot(*normal)).fold(0.0, f64::max);
        let mut face: Vec<_> =
            (0..positions.len() as u32).filter(|&v| positions[v as usize].dot(*normal) > far - 1e-6).collect();
        let u = normal.normalize().any_orthonormal_vector();
        let v = normal.normalize().cross(u);
        let angle = |&i: &u32| positions[i as usize].dot(v).atan2(positions[i as usize].dot(u));
        face.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        face
    };
    let faces = normals.iter().map(face).collect();
    (positions, faces)
}

/// Conway's operator "expand" for closed meshes: faces shrink in place, and faces for edges and vertices fill the gaps.
fn expanded(positions: &[DVec3], faces: &Faces) -> (Vec<DVec3>, Faces) {
    let mut new_positions = Vec::new();
    let mut new_faces = Faces::new();
    // The new vertex at the start of each half-edge, by the half-edge's vertices; and the vertex before it.
    let mut starts = HashMap::new();
    for face in faces {
        let centre = face.iter().map(|&v| positions[v as usize]).sum::<DVec3>() / face.len() as f64;
        let first = new_positions.len() as u32;
        let count = face.len() as u32;
        for (k, &vertex) in face.iter().enumerate() {
            let (next, before) = (face[(k + 1) % face.len()], face[(k + face.len() - 1) % face.len()]);
            let k = k as u32;
            new_positions.push(positions[vertex as usize].lerp(centre, 0.35));
            starts.insert((vertex, next), (first + k, first + (k + 1) % count, before));
        }
        new_faces.push((first..first + count).collect());
    }
    for face in faces {
        for (k, &from) in face.iter().enumerate() {
            let to = face[(k + 1) % face.len()];
            if from < to {
                let (a, b, _) = starts[&(from, to)];
                let (c, d, _) = starts[&(to, from)];
                new_faces.push(vec![b, a, d, c]);
            }
        }
    }
    let mut done = vec![false; positions.len()];
    for face in faces {
        for (k, &vertex) in face.iter().enumerate() {
            if std::mem::replace(&mut done[vertex as usize], true) {
                continue;
            }
            let first = face[(k + 1) % face.len()];
            let mut around = Vec::new();
            let mut to = first;
            loop {
                let (start, _, before) = starts[&(vertex, to)];
                around.push(start);
                to = before;
                if to == first {
                    break;
                }
            }
            new_faces.push(around);
        }
    }
    (new_positions, new_faces)
}

/// Knobs in a row of plates.
const KNOB_COLUMNS: usize = 5;
const KNOB_ROWS: usize = 2;

/// A slab with ten knobs of 3 to 12 sides, every face split into quads around its middle: the middle of a face with k
/// sides becomes a vertex of valence k.
pub(super) fn valences() -> MeshData {
    let (mut positions, mut faces) = slab();
    // The cells of the slab's top come first.
    for (cell, sides) in (3..=12).enumerate() {
        let plate = faces[cell].clone();
        faces[cell] = knob(&mut positions, &mut faces, &plate, sides);
    }
    let (positions, faces) = split(positions, &faces);
    data(positions, &faces)
}

/// A flat box, its cells along the top first.
fn slab() -> (Vec<DVec3>, Faces) {
    let (width, depth) = (KNOB_COLUMNS + 1, KNOB_ROWS + 1);
    let at = |level: usize, i: usize, j: usize| ((level * depth + j) * width + i) as u32;
    let mut positions = Vec::new();
    for y in [-0.1, -0.5] {
        for j in 0..depth {
            positions.extend((0..width).map(|i| dvec3(0.8 * (i as f64 - 2.5), y, 0.8 * (1.0 - j as f64))));
        }
    }
    let cells = || (0..KNOB_ROWS).flat_map(|j| (0..KNOB_COLUMNS).map(move |i| (i, j)));
    let top = cells().map(|(i, j)| vec![at(0, i, j), at(0, i + 1, j), at(0, i + 1, j + 1), at(0, i, j + 1)]);
    let bottom = cells().map(|(i, j)| vec![at(1, i, j), at(1, i, j + 1), at(1, i + 1, j + 1), at(1, i + 1, j)]);
    let mut faces: Faces = top.chain(bottom).collect();
    let side =
        |a: (usize, usize), b: (usize, usize)| vec![at(0, a.0, a.1), at(1, a.0, a.1), at(1, b.0, b.1), at(0, b.0, b.1)];
    for i in 0..KNOB_COLUMNS {
        faces.push(side((i, 0), (i + 1, 0)));
        faces.push(side((i + 1, KNOB_ROWS), (i, KNOB_ROWS)));
    }
    for j in 0..KNOB_ROWS {
        faces.push(side((0, j + 1), (0, j)));
        faces.push(side((KNOB_COLUMNS, j), (KNOB_COLUMNS, j + 1)));
    }
    (positions, faces)
}

/// Raises a column with `sides` sides on a plate of four corners; gives its top face.
fn knob(positions: &mut Vec<DVec3>, faces: &mut Faces, plate: &[u32], sides: usize) -> Vec<u32> {
    let centre = plate.iter().map(|&v| positions[v as usize]).sum::<DVec3>() / 4.0;
    let mut ring = |radius: f64, height: f64| -> Vec<u32> {
        let first = positions.len() as u32;
        positions.extend((0..sides).map(|k| {
            // From the direction of the plate's first corner, counter-clockwise seen from above.
            let (sin, cos) = (TAU * (k as f64 / sides as f64 + 0.625)).sin_cos();
            centre + dvec3(radius * cos, height, -radius * sin)
        }));
        (first..first + sides as u32).collect()
    };
    let (foot, top) = (ring(0.27, 0.04), ring(0.25, 0.55));
    for k in 0..sides {
        let next = (k + 1) % sides;
        faces.push(vec![foot[k], foot[next], top[next], top[k]]);
    }
    // One face from each side of the plate to the sides of the column that face it.
    for corner in 0..4 {
        let (from, to) = (corner * sides / 4, (corner + 1) * sides / 4);
        let mut face = vec![plate[corner], plate[(corner + 1) % 4]];
        face.extend((from..=to).rev().map(|k| foot[k % sides]));
        faces.push(face);
    }
    top
}

/// Every face split into quads: its corners, the middles of its edges, its middle.
fn split(mut positions: Vec<DVec3>, faces: &Faces) -> (Vec<DVec3>, Faces) {
    let mut middles = HashMap::new();
    let mut quads = Faces::new();
    for face in faces {
        let centre = face.iter().map(|&v| positions[v as usize]).sum::<DVec3>() / face.len() as f64;
        let middle = positions.len() as u32;
        positions.push(centre);
        let mut edge = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push(positions[a as usize].midpoint(positions[b as usize]));
                positions.len() as u32 - 1
            })
        };
        for (k, &vertex) in face.iter().enumerate() {
            let before = edge(face[(k + face.len() - 1) % face.len()], vertex);
            let after = edge(vertex, face[(k + 1) % face.len()]);
            quads.push(vec![vertex, after, middle, before]);
        }
    }
    (positions, quads)
}
