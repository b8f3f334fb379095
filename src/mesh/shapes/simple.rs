//! Small shapes and sheets: a few faces each, or plain grids.

use crate::mesh::{FaceVarying, MeshData};
use std::f64::consts::TAU;

pub(super) fn cube() -> MeshData {
    MeshData {
        positions: (0..8).map(|i| [0, 1, 2].map(|k| if i >> k & 1 == 1 { 1.0 } else { -1.0 })).collect(),
        face_sizes: vec![4; 6],
        face_vertices: vec![0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6],
        ..MeshData::default()
    }
}

pub(super) fn tetrahedron() -> MeshData {
    MeshData {
        positions: vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
        face_sizes: vec![3; 4],
        face_vertices: vec![0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2],
        ..MeshData::default()
    }
}

/// A torus of `u` x `v` quads, all regular, without texture coordinates; made for large counts.
///
/// `u` faces run around the y axis and `v` around the tube; both must be at least 3. It is 2.8 wide and 0.8 high.
pub fn grid_torus(u: u32, v: u32) -> MeshData {
    let (rows, columns) = (u as usize, v as usize);
    let tube: Vec<_> = (0..v).map(|j| (TAU * f64::from(j) / f64::from(v)).sin_cos()).collect();
    let mut positions = Vec::with_capacity(rows * columns);
    let mut face_vertices = Vec::with_capacity(4 * rows * columns);
    for i in 0..u {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(u)).sin_cos();
        let next = if i + 1 == u { 0 } else { i + 1 };
        for j in 0..v {
            let (height, out) = tube[j as usize];
            let radius = 1.0 + 0.4 * out;
            positions.push([radius * cos, 0.4 * height, radius * sin]);
            let beside = if j + 1 == v { 0 } else { j + 1 };
            face_vertices.extend([i * v + j, i * v + beside, next * v + beside, next * v + j]);
        }
    }
    MeshData { positions, face_sizes: vec![4; rows * columns], face_vertices, ..MeshData::default() }
}

pub(super) fn torus() -> MeshData {
    let (u, v) = (16, 8);
    let coordinate = |i: u32, count: u32| i as f32 / count as f32;
    let values = (0..=u).flat_map(|i| (0..=v).map(move |j| [coordinate(i, u), coordinate(j, v)])).collect();
    // The seams are where the grid closes: there the indices do not wrap round as the vertices do.
    let cell = |i, j| [[i, j], [i, j + 1], [i + 1, j + 1], [i + 1, j]];
    let cells = (0..u).flat_map(|i| (0..v).map(move |j| (i, j)));
    let indices = cells.flat_map(|(i, j)| cell(i, j).map(|[i, j]| i * (v + 1) + j)).collect();
    MeshData { texcoords: Some(FaceVarying { values, indices }), ..grid_torus(u, v) }
}

pub(super) fn single_quad() -> MeshData {
    sheet(&["#"], |u, v| [2.0 * u - 1.0, 0.0, 1.0 - 2.0 * v])
}

pub(super) fn strip() -> MeshData {
    sheet(&["########"], |u, v| {
        let (sin, cos) = (TAU * (u - 0.5) * 0.6).sin_cos();
        [1.4 * sin, 1.4 * cos - 0.5, 0.5 - v]
    })
}

/// Triangles around a pole, like a low tent.
pub(super) fn fan() -> MeshData {
    let count = 9;
    let rim = |i: u32| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(count)).sin_cos();
        [1.2 * sin, 0.12 * (3.0 * TAU * f64::from(i) / f64::from(count)).cos(), 1.2 * cos]
    };
    MeshData {
        positions: std::iter::once([0.0, 0.6, 0.0]).chain((0..count).map(rim)).collect(),
        face_sizes: vec![3; count as usize],
        face_vertices: (0..count).flat_map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect(),
        ..MeshData::default()
    }
}

/// A sheet with a notch, a hole and a tongue, hanging in waves.
pub(super) fn cloth() -> MeshData {
    let cells = [
        "....######....",
        "....######....",
        "##############",
        "##############",
        "##############",
        "####..########",
        "####..########",
        "##############",
        "##############",
        "######..######",
        "######..######",
        "#####....#####",
    ];
    sheet(&cells, |u, v| {
        let (x, z) = (3.2 * (u - 0.5), 2.8 * (0.5 - v));
        let hang = -0.35 * (x * x * 0.55 + z * z * 0.35);
        let waves = 0.16 * (2.6 * x + 0.8 * z).sin() * (0.4 + 0.5 * z * z).min(1.2) + 0.08 * (3.1 * z - x).cos();
        [x, 0.45 + hang + waves, z]
    })
}

/// The cells marked `#` of a grid, first line topmost; `place` maps texture coordinates to the surface.
fn sheet(cells: &[&str], place: impl Fn(f64, f64) -> [f64; 3]) -> MeshData {
    let (rows, columns) = (cells.len(), cells[0].len());
    let mut numbers = vec![u32::MAX; (rows + 1) * (columns + 1)];
    let mut data = MeshData::default();
    let mut values = Vec::new();
    for (line, text) in cells.iter().enumerate() {
        let row = rows - 1 - line;
        for (column, _) in text.bytes().enumerate().filter(|&(_, cell)| cell == b'#') {
            for (i, j) in [(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)] {
                let number = &mut numbers[j * (columns + 1) + i];
                if *number == u32::MAX {
                    *number = data.positions.len() as u32;
                    let (u, v) = (i as f64 / columns as f64, j as f64 / rows as f64);
                    data.positions.push(place(u, v));
                    values.push([u as f32, v as f32]);
                }
                data.face_vertices.push(*number);
            }
            data.face_sizes.push(4);
        }
    }
    data.texcoords = Some(FaceVarying { values, indices: data.face_vertices.clone() });
    data
}
