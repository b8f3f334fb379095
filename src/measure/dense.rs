//! A surface as a dense mesh of triangles, and its point that is nearest to another.

use super::surfaces::Parameters;
use glam::DVec3;
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};
use std::ops::Range;

/// Triangles of a surface, about.
const TRIANGLES: f64 = 2e6;

/// Cells along the side of a block. A tree of single triangles takes longer to build than it saves in queries.
const BLOCK: usize = 4;

/// Points on a uniform grid over each part of each patch, and a tree of boxes around blocks of its cells. Each cell is two
/// triangles.
pub(super) struct Dense {
    points: Vec<DVec3>,
    tree: RTree<GeomWithData<Rectangle<[f64; 3]>, Block>>,
}

/// Some neighbouring cells of a grid.
struct Block {
    /// Its first point.
    first: usize,
    /// Points in a row of the grid.
    stride: usize,
    columns: usize,
    rows: usize,
}

/// Cells along each side of a part of a patch; those of several have fewer, so that there are about as many in all.
fn cells(parts: &Range<i32>, patches: usize) -> usize {
    let side = ((TRIANGLES / 2.0 / patches as f64).sqrt() as usize).clamp(4, 32);
    if parts.len() > 1 { side.div_ceil(2) } else { side }
}

/// The points of one patch with these parts, among `patches`: part by part, in rows along u.
pub(super) fn grid(parts: &Range<i32>, patches: usize, position: impl Fn(Parameters) -> DVec3) -> Vec<DVec3> {
    let side = cells(parts, patches) as u32;
    let at = |i: u32| f64::from(i) / f64::from(side);
    let row = |sub, j| (0..=side).map(move |i| Parameters { sub, u: at(i), v: at(j) });
    parts.clone().flat_map(|sub| (0..=side).flat_map(move |j| row(sub, j))).map(position).collect()
}

impl Dense {
    /// A surface from the [`grid`] of every patch.
    pub(super) fn new(parts: &[Range<i32>], grids: &[Vec<DVec3>]) -> Self {
        Self::with_patches(parts, grids, parts.len())
    }

    /// As if there were this many patches.
    fn with_patches(parts: &[Range<i32>], grids: &[Vec<DVec3>], patches: usize) -> Self {
        let points = grids.concat();
        let mut blocks = Vec::new();
        let mut start = 0;
        for parts in parts {
            let side = cells(parts, patches);
            let starts = || (0..side).step_by(BLOCK);
            for _ in parts.clone() {
                for (row, column) in starts().flat_map(|row| starts().map(move |column| (row, column))) {
                    let [rows, columns] = [row, column].map(|cell| BLOCK.min(side - cell));
                    let block = Block { first: start + row * (side + 1) + column, stride: side + 1, columns, rows };
                    blocks.push(GeomWithData::new(block.bounds(&points), block));
                }
                start += (side + 1) * (side + 1);
            }
        }
        Self { points, tree: RTree::bulk_load(blocks) }
    }

    /// The distance to the nearest triangle, and its normal. None if there are no triangles.
    pub(super) fn nearest(&self, point: DVec3) -> Option<(f64, DVec3)> {
        let mut best = (f64::INFINITY, [DVec3::ZERO; 3]);
        // Boxes by their distance: one that is farther than a triangle holds none that is nearer.
        for (block, squared) in self.tree.nearest_neighbor_iter_with_distance_2(point.to_array()) {
            if squared >= best.0 {
                break;
            }
            for triangle in block.data.triangles(&self.points) {
                let squared = point.distance_squared(closest(triangle, point));
                if squared < best.0 {
                    best = (squared, triangle);
                }
            }
        }
        let (squared, [a, b, c]) = best;
        squared.is_finite().then(|| (squared.sqrt(), (b - a).cross(c - a).normalize_or_zero()))
    }
}

impl Block {
    fn bounds(&self, points: &[DVec3]) -> Rectangle<[f64; 3]> {
        let rows = (0..=self.rows).map(|j| self.first + j * self.stride);
        let points = rows.flat_map(|row| &points[row..=row + self.columns]);
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = points.fold(none, |(low, high), &p| (low.min(p), high.max(p)));
        Rectangle::from_corners(low.to_array(), high.to_array())
    }

    fn triangles(&self, points: &[DVec3]) -> impl Iterator<Item = [DVec3; 3]> {
        let cells = (0..self.rows).flat_map(|j| (0..self.columns).map(move |i| (i, j)));
        cells.flat_map(|(i, j)| {
            let at = self.first + j * self.stride + i;
            let [a, b, c, d] = [at, at + 1, at + self.stride + 1, at + self.stride].map(|at| points[at]);
            [[a, b, c], [a, c, d]]
        })
    }
}

/// The point of a triangle that is closest to `p` (Ericson, *Real-Time Collision Detection*, 5.1.5).
fn closest([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + d1 / (d1 - d3) * ab;
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + d2 / (d2 - d6) * ac;
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    a + (vb * ab + vc * ac) / (va + vb + vc)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_triangle_is_the_nearest_of_all() {
        // Two bent sheets, one over the other, whose sides are no multiple of a block's.
        let parts = [-1..0, 0..3];
        let sheet = |height: f64| {
            move |at: Parameters| {
                let (u, v) = (at.u + f64::from(at.sub.max(0)), at.v);
                DVec3::new(u, v, height + 0.3 * (3.0 * u).sin() * (2.0 * v).cos())
            }
        };
        let patches = 20_000;
        let grids = [grid(&parts[0], patches, sheet(0.0)), grid(&parts[1], patches, sheet(0.5))];
        let dense = Dense::with_patches(&parts, &grids, patches);
        let blocks: Vec<_> = dense.tree.iter().flat_map(|block| block.data.triangles(&dense.points)).collect();
        let cells = |parts| cells(parts, patches).pow(2);
        assert_eq!((cells(&parts[0]), cells(&parts[1])), (49, 16));
        assert_eq!(blocks.len(), 2 * (49 + 3 * 16));
        for i in 0..200 {
            let [x, y, z] = [0.7548, 0.5698, 0.4302].map(|step| (f64::from(i) * step).fract());
            let point = DVec3::new(3.0 * x, y, 2.0 * z - 0.5);
            let all = blocks.iter().map(|&triangle| point.distance(closest(triangle, point)));
            let (distance, normal) = dense.nearest(point).unwrap();
            assert_eq!(distance, all.fold(f64::MAX, f64::min));
            assert!((normal.length() - 1.0).abs() < 1e-12);
        }
    }
}
