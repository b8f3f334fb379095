//! A texture atlas for any all-quad mesh: every face becomes a square of a grid, neighbours stay neighbours as far
//! as the grid allows, and the pieces are packed into the unit square.

use crate::mesh::{ControlMesh, FaceVarying, NO_TWIN};
use std::collections::{HashMap, VecDeque};

/// A piece of the atlas is at most this many faces wide and high: small pieces pack well.
const MAX_SIDE: i32 = 10;
/// The gap around each piece, as a part of a face's side: room for texture filtering.
const GAP: f32 = 0.25;

/// Faces in squares of one grid.
#[derive(Default)]
struct Chart {
    /// Each face, its square's lower left grid point, and which of its corners lies there.
    faces: Vec<(u32, [i32; 2], usize)>,
    /// The vertex at each grid point in use.
    points: HashMap<[i32; 2], u32>,
    low: [i32; 2],
    high: [i32; 2],
}

impl Chart {
    /// The grid points of a square's corners, from the face's corner 0 on.
    fn corners(square: [i32; 2], first: usize) -> [[i32; 2]; 4] {
        let [x, y] = square;
        let mut corners = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
        corners.rotate_right(first);
        corners
    }

    /// Whether the face fits: no grid point would get two vertices, and the chart stays small.
    fn fits(&self, mesh: &ControlMesh, face: u32, square: [i32; 2], first: usize) -> bool {
        let small = (0..2).all(|k| {
            let (low, high) = (self.low[k].min(square[k]), self.high[k].max(square[k] + 1));
            high - low <= MAX_SIDE
        });
        let free = !self.faces.iter().any(|&(_, taken, _)| taken == square);
        let corners = Self::corners(square, first);
        let agrees =
            mesh.face(face).iter().zip(corners).all(|(vertex, at)| self.points.get(&at).is_none_or(|v| v == vertex));
        small && free && agrees
    }

    fn add(&mut self, mesh: &ControlMesh, face: u32, square: [i32; 2], first: usize) {
        self.faces.push((face, square, first));
        self.points.extend(Self::corners(square, first).into_iter().zip(mesh.face(face).iter().copied()));
        self.low = [0, 1].map(|k| self.low[k].min(square[k]));
        self.high = [0, 1].map(|k| self.high[k].max(square[k] + 1));
    }

    fn size(&self) -> [f32; 2] {
        [0, 1].map(|k| (self.high[k] - self.low[k]) as f32 + GAP)
    }
}

/// Texture coordinates without overlaps, in the unit square. Every face of the mesh must be a quad.
pub(super) fn unwrap_quads(mesh: &ControlMesh) -> FaceVarying<[f32; 2]> {
    let mut charts = charts(mesh);
    charts.sort_by_key(|chart| std::cmp::Reverse((chart.high[1] - chart.low[1], chart.faces.len())));
    let (places, side) = pack(&charts.iter().map(Chart::size).collect::<Vec<_>>());

    let mut values = Vec::new();
    let mut indices = vec![0; mesh.corner_count()];
    for (chart, place) in charts.iter().zip(places) {
        let mut numbers = HashMap::new();
        for &(face, square, first) in &chart.faces {
            for (corner, at) in mesh.face_corners(face).zip(Chart::corners(square, first)) {
                indices[corner] = *numbers.entry(at).or_insert_with(|| {
                    values.push([0, 1].map(|k| (place[k] + GAP / 2.0 + (at[k] - chart.low[k]) as f32) / side));
                    values.len() as u32 - 1
                });
            }
        }
    }
    FaceVarying { values, indices }
}

/// Grows charts from the first face that has none, breadth first.
fn charts(mesh: &ControlMesh) -> Vec<Chart> {
    let mut done = vec![false; mesh.face_count()];
    let mut charts = Vec::new();
    for seed in 0..mesh.face_count() as u32 {
        if done[seed as usize] {
            continue;
        }
        let mut chart = Chart { high: [1, 1], ..Chart::default() };
        let mut queue = VecDeque::from([(seed, [0, 0], 0)]);
        while let Some((face, square, first)) = queue.pop_front() {
            if done[face as usize] || !chart.fits(mesh, face, square, first) {
                continue;
            }
            chart.add(mesh, face, square, first);
            done[face as usize] = true;
            for (k, half_edge) in mesh.face_corners(face).enumerate() {
                let twin = mesh.twins()[half_edge];
                if twin == NO_TWIN {
                    continue;
                }
                // Which side of the square the edge is: bottom, right, top, left.
                let side = (k + 4 - first) % 4;
                let [x, y] = square;
                let next = [[x, y - 1], [x + 1, y], [x, y + 1], [x - 1, y]][side];
                let neighbour = twin / 4;
                // The twin lies on the opposite side of the neighbour's square.
                let next_first = (twin as usize % 4 + 6 - side) % 4;
                queue.push_back((neighbour, next, next_first));
            }
        }
        charts.push(chart);
    }
    charts
}

/// Lower left corners of rectangles, highest first, in rows in a square; and the side of the square.
fn pack(sizes: &[[f32; 2]]) -> (Vec<[f32; 2]>, f32) {
    let area: f32 = sizes.iter().map(|[w, h]| w * h).sum();
    let mut width = area.sqrt().max(sizes.iter().map(|s| s[0]).fold(0.0, f32::max));
    loop {
        let mut places = Vec::with_capacity(sizes.len());
        let (mut x, mut y, mut row) = (0.0, 0.0, 0.0);
        for &[w, h] in sizes {
            if x + w > width {
                (x, y, row) = (0.0, y + row, 0.0);
            }
            places.push([x, y]);
            x += w;
            row = h.max(row);
        }
        if y + row <= width {
            return (places, width);
        }
        width *= 1.01;
    }
}
