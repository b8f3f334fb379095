//! Triangles of a patch that is evaluated on a uniform grid: vertices in the order of [`grid_parameters`](super::grid_parameters).

use crate::topology::PatchKind;
use std::cmp::Ordering;

/// The most segments along a side: what the arithmetic of `glsl/lib/evaluate/uniform_grid.glsl` is right for.
pub(crate) const MAX_SEGMENTS: u32 = 1024;

/// How many vertices a patch has with `n` segments along each side.
pub(crate) fn uniform_grid_vertices(kind: PatchKind, n: u32) -> u64 {
    let n = u64::from(n);
    if kind.is_triangular() { (n + 1) * (n + 2) / 2 } else { (n + 1) * (n + 1) }
}

/// How many triangles.
fn uniform_grid_triangles(kind: PatchKind, n: u32) -> u64 {
    let n = u64::from(n);
    if kind.is_triangular() { n * n } else { 2 * n * n }
}

pub(crate) use crate::constants::TILE_VERTICES;

/// Columns and rows of the cells that an invocation of the geometry shader emits, of a patch with `n` segments along each side.
/// A row of `c` cells takes up to `2 c + 6` vertices.
fn tile_size(n: u32) -> [u32; 2] {
    let most = (TILE_VERTICES - 6) / 2;
    let columns = n.div_ceil(n.div_ceil(most));
    [columns, (TILE_VERTICES / (2 * columns + 6)).min(n)]
}

/// How many of them cover a patch; of a triangle, some are empty.
pub(crate) fn uniform_grid_tiles(n: u32) -> u32 {
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

/// What the indices of a uniform grid are of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum UniformGridIndices {
    List,
    Strip,
}

impl UniformGridIndices {
    /// A strip where the list of a patch of any of these kinds has more than so many indices.
    pub(crate) fn new(kinds: impl IntoIterator<Item = PatchKind>, n: u32, at_once: u32) -> Self {
        let long = kinds.into_iter().any(|kind| 3 * uniform_grid_triangles(kind, n) > at_once.into());
        if long { Self::Strip } else { Self::List }
    }

    /// Those of a patch.
    pub(crate) fn of(self, kind: PatchKind, n: u32) -> Vec<u32> {
        match self {
            Self::List => uniform_grid_list(kind, n),
            Self::Strip => uniform_grid_strip(kind, n),
        }
    }

    /// How many more join a patch that has so many to the same of another. In a strip, triangles with a vertex twice: as many as it
    /// takes for the next not to be turned around.
    pub(crate) fn joint(self, indices: u32) -> u32 {
        match self {
            Self::List => 0,
            Self::Strip => 2 + indices % 2,
        }
    }

    /// Appends those of a patch, whose vertices start at `first`, to those of others.
    pub(crate) fn append(self, all: &mut Vec<u32>, of_patch: &[u32], first: u32) {
        if let (Self::Strip, Some(&last), Some(&next)) = (self, all.last(), of_patch.first()) {
            let joint = self.joint(all.len() as u32);
            all.extend((1..joint).map(|_| last));
            all.push(first + next);
        }
        all.extend(of_patch.iter().map(|i| first + i));
    }
}

/// Three vertices for each triangle, counter-clockwise where (u, v) is.
fn uniform_grid_list(kind: PatchKind, n: u32) -> Vec<u32> {
    let mut indices = Vec::with_capacity(3 * uniform_grid_triangles(kind, n) as usize);
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

/// The vertices of a row of triangles as a strip, from left to right, and whether the first of them is seen turned around. Where
/// diagonals change their direction, a vertex comes twice.
fn strip_row(kind: PatchKind, n: u32, row: u32) -> (Vec<u32>, bool) {
    if kind.is_triangular() {
        let (above, below) = (row * (row + 1) / 2, (row + 1) * (row + 2) / 2);
        let pairs = (0..=row).flat_map(|k| [below + k, above + k]);
        return (pairs.chain([below + row + 1]).collect(), true);
    }
    // From the second of a pair to the first of the next goes a diagonal.
    let pair = |k: u32, rises: bool| {
        let [above, below] = [row, row + 1].map(|row| row * (n + 1) + k);
        if rises { [below, above] } else { [above, below] }
    };
    let mut rising = rises(n, 0, row);
    let (mut vertices, turned) = (Vec::from(pair(0, rising)), !rising);
    for k in 0..n {
        if rises(n, k, row) != rising {
            vertices.push(pair(k, rising)[0]);
            rising = !rising;
        }
        vertices.extend(pair(k + 1, rising));
    }
    (vertices, turned)
}

/// The triangles of [`uniform_grid_list`] as one strip, from row to row and back. In between are triangles that have a vertex twice;
/// their sides are those of others.
fn uniform_grid_strip(kind: PatchKind, n: u32) -> Vec<u32> {
    let mut strip: Vec<u32> = Vec::new();
    for row in 0..n {
        let (mut vertices, mut turned) = strip_row(kind, n, row);
        if row % 2 == 1 {
            vertices.reverse();
            turned ^= vertices.len() % 2 == 1;
        }
        // The row before ends with the side of which this is the lower vertex.
        let common = vertices[0].min(vertices[1]);
        while row > 0 && !strip.ends_with(&[common; 2]) {
            strip.push(common);
        }
        let rest = if row > 0 && vertices[0] == common { &vertices[1..] } else { &vertices };
        let first = strip.len() + rest.len() - vertices.len();
        // Every other triangle of a strip is turned around.
        if (first % 2 == 1) != turned {
            strip.push(common);
        }
        strip.extend(rest);
    }
    strip
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::grid_parameters;

    #[test]
    fn uniform_grids_cover_their_patch() {
        for kind in PatchKind::ALL {
            for n in [1, 2, 5] {
                let parameters = grid_parameters(kind, n + 1);
                let indices = uniform_grid_list(kind, n);
                assert_eq!(parameters.len() as u64, uniform_grid_vertices(kind, n));
                assert_eq!(indices.len() as u64, 3 * uniform_grid_triangles(kind, n));
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
    fn strips_have_the_same_triangles() {
        for (kind, n) in PatchKind::ALL.into_iter().flat_map(|kind| (1..20).map(move |n| (kind, n))) {
            let sorted = |triangles: Vec<[u32; 3]>| {
                let turned = |t: [u32; 3]| (0..3).map(|i| [t[i], t[(i + 1) % 3], t[(i + 2) % 3]]).min().unwrap();
                let mut all: Vec<_> = triangles.into_iter().map(turned).collect();
                all.sort();
                all
            };
            let sides = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|[a, b]| [a.min(b), a.max(b)]);
            let list = sorted(uniform_grid_list(kind, n).chunks(3).map(|t| [t[0], t[1], t[2]]).collect());
            let strip = uniform_grid_strip(kind, n);
            let of_strip = strip.windows(3).enumerate();
            let of_strip = of_strip.map(|(i, t)| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] });
            let (empty, real): (Vec<_>, Vec<_>) = of_strip.partition(|t| sides(t).iter().any(|[a, b]| a == b));
            assert_eq!(sorted(real), list, "{kind:?}, {n}");
            // Nothing new where edges are drawn.
            let drawn: Vec<_> = list.iter().flat_map(sides).collect();
            let mut more = empty.iter().flat_map(sides).filter(|[a, b]| a != b);
            assert!(more.all(|side| drawn.contains(&side)), "{kind:?}, {n}");
            assert!(strip.len() <= (2 * n * (n + 3) + 4) as usize, "{kind:?}, {n}: {}", strip.len());
        }
    }

    #[test]
    fn tiles_fit_the_geometry_shader() {
        for n in 1..=1024 {
            let [columns, rows] = tile_size(n);
            assert!(rows * (2 * columns + 6) <= TILE_VERTICES && rows >= 1, "{n}");
            assert!(uniform_grid_tiles(n) * columns * rows >= n * n);
        }
        assert_eq!([1, 4, 8, 16, 1024].map(uniform_grid_tiles), [1, 1, 4, 16, 36 * 1024]);
    }
}
