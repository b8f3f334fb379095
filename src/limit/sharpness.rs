//! How sharp edges and vertices lose their sharpness, and what it does to the points meanwhile (patch_maths A; DeRose, Kass,
//! Truong 1998).

use crate::mesh::{CreaseMethod, SHARPNESS_INFINITE};
use crate::topology::SHARP_FROM;

/// Levels of refinement that an [`EdgeProfile`] follows.
pub(crate) const LEVELS: usize = 3;

/// Sharpness after one uniform step.
pub(super) fn decrement(sharpness: f32) -> f32 {
    if sharpness >= SHARPNESS_INFINITE { sharpness } else { (sharpness - 1.0).max(0.0) }
}

pub(crate) fn is_semi_sharp(sharpness: f32) -> bool {
    sharpness > 0.0 && sharpness < SHARPNESS_INFINITE
}

/// Sharpness that the edges around a vertex leave their children there.
pub(super) fn children(method: CreaseMethod, edges: &[f32]) -> Vec<f32> {
    let semi: Vec<f32> = edges.iter().copied().filter(|&s| is_semi_sharp(s)).collect();
    if method == CreaseMethod::Uniform || semi.len() < 2 {
        return edges.iter().map(|&s| decrement(s)).collect();
    }
    // Chaikin's rule: each semi-sharp edge's child takes a quarter from the mean of the others.
    let sum: f32 = semi.iter().sum();
    let child = |s: f32| match is_semi_sharp(s) {
        true => (0.75 * s + 0.25 * ((sum - s) / (semi.len() - 1) as f32) - 1.0).max(0.0),
        false => s,
    };
    edges.iter().map(|&s| child(s)).collect()
}

/// How much of the sharp edge point there is in that of an edge, whose children at both ends are these.
pub(super) fn edge_weight(method: CreaseMethod, sharpness: f32, children: [f32; 2]) -> f32 {
    // Chaikin's exception: an edge whose two children stay sharp is fully sharp.
    let stays = method == CreaseMethod::Chaikin && sharpness > 0.0 && children.iter().all(|&child| child > 0.0);
    if stays { 1.0 } else { sharpness.min(1.0) }
}

/// How much of the parent's rule there is in a vertex point where the child's is another: by the mean of the sharpness that
/// is used up in this step. `edges` are the sharp ones at the vertex, each with its child.
pub(super) fn parent_weight(method: CreaseMethod, edges: &[(f32, f32)], vertex: f32) -> f32 {
    let is_used = |&&(sharpness, child): &&(f32, f32)| match method {
        CreaseMethod::Uniform => sharpness <= 1.0,
        CreaseMethod::Chaikin => child <= 0.0,
    };
    let mut used: Vec<f32> = edges.iter().filter(is_used).map(|edge| edge.0).collect();
    if vertex > 0.0 && decrement(vertex) <= 0.0 {
        used.push(vertex);
    }
    let mean = if used.is_empty() { 0.0 } else { used.iter().sum::<f32>() / used.len() as f32 };
    mean.min(1.0)
}

/// Sharpness along an edge at each level of refinement, from its first end to the other. At level l the edge is in 2^l pieces.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EdgeProfile {
    /// [`edge_weight`] of each piece at levels 0 to 2.
    pub edges: [f32; 7],
    /// How much of the crease's rule there is in the points between pieces when levels 1 and 2 are refined.
    pub vertices: [f32; 4],
    /// Between which pieces of levels 1 to 3 the surface has a normal on each side: a bit each.
    pub creased: u32,
}

impl EdgeProfile {
    /// Profile of an edge with this sharpness. `ends` is the sharpness of its outermost pieces at levels 1 to 3, at the first end
    /// and at the other.
    pub(crate) fn new(method: CreaseMethod, sharpness: f32, ends: [[f32; LEVELS]; 2]) -> Self {
        let mut profile = Self { edges: [0.0; 7], vertices: [0.0; 4], creased: 0 };
        let mut pieces = vec![sharpness];
        let (mut edge, mut vertex, mut bit) = (0, 0, 0);
        for level in 0..=LEVELS {
            // Level 0 has no points between pieces.
            for pair in pieces.windows(2) {
                let is_creased = pair.iter().all(|&s| s >= SHARP_FROM);
                profile.creased |= u32::from(is_creased) << bit;
                bit += 1;
            }
            if level == LEVELS {
                break;
            }
            let mut next = vec![ends[0][level]];
            for pair in pieces.windows(2) {
                let children = children(method, pair);
                let sharp = |pair: &[f32]| pair.iter().all(|&s| s > 0.0);
                let ends: Vec<(f32, f32)> = pair.iter().copied().zip(children.iter().copied()).collect();
                profile.vertices[vertex] = match (sharp(pair), sharp(&children)) {
                    (false, _) => 0.0,
                    (true, true) => 1.0,
                    (true, false) => parent_weight(method, &ends, 0.0),
                };
                vertex += 1;
                next.extend(children);
            }
            next.push(ends[1][level]);
            for (&piece, children) in pieces.iter().zip(next.chunks_exact(2)) {
                profile.edges[edge] = edge_weight(method, piece, [children[0], children[1]]);
                edge += 1;
            }
            pieces = next;
        }
        profile
    }
}
