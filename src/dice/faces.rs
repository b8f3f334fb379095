//! Quads and triangles of a facet.

use super::layout::Facet;
use rustc_hash::FxHashMap;

/// Makes faces; remembers how cells beside finer edges are cut.
#[derive(Default)]
pub(super) struct FaceWriter {
    /// The vertices of a facet's grid, row by row.
    grid: Vec<u32>,
    side: usize,
    patterns: FxHashMap<[u32; 4], Vec<[u32; 3]>>,
    /// The vertices around a cell.
    around: Vec<u32>,
}

impl FaceWriter {
    /// Writes the faces of a facet, all counter-clockwise, in as many places as they need.
    pub(super) fn write(&mut self, facet: &Facet, quads: &mut [[u32; 4]], triangles: &mut [[u32; 3]]) {
        self.fill_grid(facet);
        let segments = self.side - 1;
        let (mut quads, mut triangles) = (quads.iter_mut(), triangles.iter_mut());
        for j in 0..segments {
            for i in 0..segments {
                let corner = j * self.side + i;
                let vertices = [corner, corner + 1, corner + self.side + 1, corner + self.side].map(|at| self.grid[at]);
                let Some(halvings) = facet.cell(i, j) else { continue };
                if halvings == [0; 4] {
                    *quads.next().expect("as many as were counted") = vertices;
                    continue;
                }
                // How far along each edge the cell begins.
                let along = [i, j, segments - 1 - i, segments - 1 - j];
                self.around.clear();
                for k in 0..4 {
                    self.around.push(vertices[k]);
                    let start = (along[k] as u32) << halvings[k];
                    self.around.extend((1..1 << halvings[k]).map(|point| facet.on_edge(k, start + point)));
                }
                for corners in self.patterns.entry(halvings).or_insert_with(|| pattern(halvings)) {
                    *triangles.next().expect("as many as were counted") = corners.map(|at| self.around[at as usize]);
                }
            }
        }
    }

    fn fill_grid(&mut self, facet: &Facet) {
        let segments = 1usize << facet.depth;
        let side = segments + 1;
        self.side = side;
        self.grid.resize(side * side, 0);
        for t in 0..=segments {
            let on_edge = |k: usize| facet.on_edge(k, (t as u32) << (facet.edges[k] - facet.depth));
            self.grid[t] = on_edge(0);
            self.grid[t * side + segments] = on_edge(1);
            self.grid[segments * side + segments - t] = on_edge(2);
            self.grid[(segments - t) * side] = on_edge(3);
        }
        let mut inside = facet.inside;
        for j in 1..segments {
            for i in 1..segments {
                self.grid[j * side + i] = inside;
                inside += 1;
            }
        }
    }
}

/// Triangles of a square whose sides are halved so often. Points count around the square from its first corner.
///
/// The ear whose least angle is greatest is cut off first, so that no triangle is thinner than it must be.
fn pattern(halvings: [u32; 4]) -> Vec<[u32; 3]> {
    let starts = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let directions = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let mut points: Vec<[f64; 2]> = Vec::new();
    for k in 0..4 {
        let segments = 1u32 << halvings[k];
        points.extend((0..segments).map(|i| {
            let t = f64::from(i) / f64::from(segments);
            [0, 1].map(|axis| starts[k][axis] + t * directions[k][axis])
        }));
    }
    let mut left: Vec<u32> = (0..points.len() as u32).collect();
    let mut triangles = Vec::with_capacity(points.len() - 2);
    while left.len() > 3 {
        let ear = |at: usize| {
            let n = left.len();
            [left[(at + n - 1) % n], left[at], left[(at + 1) % n]]
        };
        let best = (0..left.len())
            .filter(|&at| !leaves_line(&points, &left, at))
            .max_by(|&a, &b| least_angle(&points, ear(a)).total_cmp(&least_angle(&points, ear(b))))
            .expect("a square has ears");
        triangles.push(ear(best));
        left.remove(best);
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles
}

fn twice_area(points: &[[f64; 2]], [a, b, c]: [u32; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|i| points[i as usize]);
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether nothing but a line is left without a point.
fn leaves_line(points: &[[f64; 2]], left: &[u32], without: usize) -> bool {
    let rest: Vec<u32> = left.iter().enumerate().filter(|(at, _)| *at != without).map(|(_, &i)| i).collect();
    (2..rest.len()).all(|i| twice_area(points, [rest[0], rest[i - 1], rest[i]]).abs() < 1e-12)
}

/// The sine of the least angle of a triangle.
fn least_angle(points: &[[f64; 2]], corners: [u32; 3]) -> f64 {
    let area = twice_area(points, corners);
    let length = |i: usize| {
        let [a, b] = [corners[i], corners[(i + 1) % 3]].map(|i| points[i as usize]);
        ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt()
    };
    let mut lengths = [length(0), length(1), length(2)];
    lengths.sort_by(f64::total_cmp);
    // Opposite the shortest side, between the two others.
    area / (lengths[1] * lengths[2])
}
