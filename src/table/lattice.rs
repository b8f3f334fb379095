//! Triangles of a patch that is evaluated on a lattice: vertices in the order of [`grid_parameters`](super::grid_parameters).

use crate::topology::PatchKind;
use std::cmp::Ordering;

/// The most segments along a side: what the arithmetic of `glsl/lib/lattice.glsl` is right for.
pub(crate) const MAX_SEGMENTS: u32 = 1024;

/// How many vertices a patch has with `n` segments along each side.
pub(crate) fn lattice_vertices(kind: PatchKind, n: u32) -> u64 {
    let n = u64::from(n);
    if kind.is_triangular() { (n + 1) * (n + 2) / 2 } else { (n + 1) * (n + 1) }
}

/// How many triangles.
pub(crate) fn lattice_triangles(kind: PatchKind, n: u32) -> u64 {
    let n = u64::from(n);
    if kind.is_triangular() { n * n } else { 2 * n * n }
}

/// Vertices that an invocation of the geometry shader emits, at most. GLSL twin: `TILE_VERTICES` in
/// `glsl/evaluate/strips.geom`.
pub(crate) const TILE_VERTICES: u32 = 64;

/// Columns and rows of the cells that an invocation of the geometry shader emits, of a patch with `n` segments along each side.
/// A row of `c` cells takes up to `2 c + 6` vertices.
fn tile_size(n: u32) -> [u32; 2] {
    let most = (TILE_VERTICES - 6) / 2;
    let columns = n.div_ceil(n.div_ceil(most));
    [columns, (TILE_VERTICES / (2 * columns + 6)).min(n)]
}

/// How many of them cover a patch; of a triangle, some are empty.
pub(crate) fn lattice_tiles(n: u32) -> u32 {
    tile_size(n).into_iter().map(|side| n.div_ceil(side)).product()
}

/// Whether the diagonal of a cell of a quad goes along u = v. As the tessellators that follow Direct3D's have it, Mesa's
/// among them: from the corners of the patch to its middle, and between the halves as in the half where its ring begins.
fn rises(n: u32, column: u32, row: u32) -> bool {
    let half = |i: u32| (2 * i + 1).cmp(&n);
    match (half(column), half(row)) {
        (_, Ordering::Equal) => false,
        (Ordering::Equal, _) => true,
        (column, row) => column == row,
    }
}

/// Three vertices for each triangle, counter-clockwise where (u, v) is.
pub(crate) fn lattice_indices(kind: PatchKind, n: u32) -> Vec<u32> {
    let mut indices = Vec::with_capacity(3 * lattice_triangles(kind, n) as usize);
    for row in 0..n {
        if kind.is_triangular() {
            let (above, below) = (row * (row + 1) / 2, (row + 1) * (row + 2) / 2);
            for k in 0..=row {
                indices.extend([above + k, below + k, below + k + 1]);
                if k < row {
                    indices.extend([above + k, below + k + 1, above + k + 1]);
                }
            }
        } else {
            let (above, below) = (row * (n + 1), (row + 1) * (n + 1));
            for k in 0..n {
                let [a, b, c, d] = [above + k, above + k + 1, below + k + 1, below + k];
                indices.extend(if rises(n, k, row) { [a, b, c, a, c, d] } else { [a, b, d, b, c, d] });
            }
        }
    }
    indices
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::grid_parameters;

    #[test]
    fn lattices_cover_their_patch() {
        for kind in PatchKind::ALL {
            for n in [1, 2, 5] {
                let parameters = grid_parameters(kind, n + 1);
                let indices = lattice_indices(kind, n);
                assert_eq!(parameters.len() as u64, lattice_vertices(kind, n));
                assert_eq!(indices.len() as u64, 3 * lattice_triangles(kind, n));
                let area = indices.chunks(3).map(|t| {
                    let [a, b, c] = [t[0], t[1], t[2]].map(|i| glam::DVec2::from(parameters[i as usize]));
                    (b - a).perp_dot(c - a) / 2.0
                });
                let areas: Vec<f64> = area.collect();
                // All turned the same way.
                assert!(areas.iter().all(|&area| area > 0.0));
                let whole = if kind.is_triangular() { 0.5 } else { 1.0 };
                assert!((areas.iter().sum::<f64>() - whole).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn tiles_fit_the_geometry_shader() {
        for n in 1..=1024 {
            let [columns, rows] = tile_size(n);
            assert!(rows * (2 * columns + 6) <= TILE_VERTICES && rows >= 1, "{n}");
            assert!(lattice_tiles(n) * columns * rows >= n * n);
        }
        assert_eq!([1, 4, 8, 16, 1024].map(lattice_tiles), [1, 1, 4, 16, 36 * 1024]);
    }
}
