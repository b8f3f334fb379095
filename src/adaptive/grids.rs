//! The 4 x 4 control points of regular faces.

use crate::mesh::SHARPNESS_INFINITE;
use crate::topology::Topology;

/// In the place of a vertex.
pub(crate) const NONE: u32 = u32::MAX;

/// Number of a control point: index i along u, j along v.
const fn at(i: usize, j: usize) -> usize {
    4 * i + j
}

/// Where the points around each corner stand: the corner itself, the point before it along its plus edge, the point before it
/// along its minus edge, and the point opposite.
const AROUND: [[usize; 4]; 4] = [
    [at(1, 1), at(0, 1), at(1, 0), at(0, 0)],
    [at(2, 1), at(2, 0), at(3, 1), at(3, 0)],
    [at(2, 2), at(3, 2), at(2, 3), at(3, 3)],
    [at(1, 2), at(1, 3), at(0, 2), at(0, 3)],
];

/// Whether the surface ends along an edge, or is infinitely sharp.
pub(crate) fn is_boundary(topology: &Topology, half_edge: u32) -> bool {
    // Boundaries are infinitely sharp.
    topology.sharpness(half_edge) >= SHARPNESS_INFINITE
}

/// The vertices of the grid around a regular face with these half-edges, [`NONE`] beyond its boundaries.
pub(crate) fn grid(topology: &Topology, half_edges: [u32; 4]) -> [u32; 16] {
    let mut grid = [NONE; 16];
    for (h, [corner, before_plus, before_minus, opposite]) in half_edges.into_iter().zip(AROUND) {
        grid[corner] = topology.mesh_vertex(h);
        // The face on the other side of an edge is part of the grid unless the surface ends there.
        let across = |h: u32| if is_boundary(topology, h) { None } else { topology.twin(h) };
        let (beyond_plus, beyond_minus) = (across(h), across(topology.prev(h)));
        if let Some(twin) = beyond_plus {
            grid[before_minus] = topology.mesh_vertex(topology.next(topology.next(twin)));
        }
        if let Some(twin) = beyond_minus {
            // `twin` starts from the corner.
            let spoke = topology.prev(twin);
            grid[before_plus] = topology.mesh_vertex(spoke);
            if beyond_plus.is_some() {
                let far = topology.twin(spoke).map(|spoke| topology.next(topology.next(spoke)));
                grid[opposite] = far.map_or(NONE, |h| topology.mesh_vertex(h));
            }
        }
    }
    grid
}

/// Fills a grid beyond its boundaries (a bit each, as in [`Leaf::boundary`](super::Leaf::boundary)): `ghost(b, i)` is the
/// point `2 b - i`.
pub(crate) fn fill(grid: &mut [u32], boundary: u32, mut ghost: impl FnMut(u32, u32) -> u32) {
    let line = |edge: u32, across: usize, along: usize| match edge {
        0 => at(along, across),
        1 => at(3 - across, along),
        2 => at(along, 3 - across),
        _ => at(across, along),
    };
    // Points beyond two boundaries are ghosts of ghosts: they come the second time.
    for edge in (0..8).map(|i| i % 4).filter(|edge| boundary >> edge & 1 == 1) {
        for along in 0..4 {
            let [outer, on, inner] = [0, 1, 2].map(|across| line(edge, across, along));
            if grid[outer] == NONE && grid[on] != NONE && grid[inner] != NONE {
                grid[outer] = ghost(grid[on], grid[inner]);
            }
        }
    }
}
