//! Edges between two faces, as the patches on both sides see them.

use ash_subdiv::patch::bicubic::CORNER_SLOTS;
use ash_subdiv::topology::{PatchKind, RingKind, Topology};

/// An edge with a face on each side.
pub struct SharedEdge {
    /// The faces, and the number of the corner in each from which the edge leads counter-clockwise around it.
    pub sides: [(u32, usize); 2],
    /// Whether the surface is to have one tangent plane along it: no crease, and no cone at an end.
    pub smooth: bool,
}

pub fn shared_edges(topology: &Topology) -> Vec<SharedEdge> {
    let mesh = topology.mesh();
    let side = |h: u32| {
        let face = topology.face(h);
        (face, h as usize - mesh.face_corners(face).start)
    };
    let edge = |h: u32| {
        let twin = topology.twin(h).filter(|&twin| h < twin)?;
        // At each end both faces have to be in one ring, and that ring no cone of several faces.
        let ends = [(h, topology.next(twin)), (topology.next(h), twin)];
        let smooth_end = |(left, right): (u32, u32)| {
            let ring = topology.place(left).ring;
            let cone = topology.rings()[ring as usize].kind == RingKind::Corner;
            ring == topology.place(right).ring && !cone
        };
        let smooth = !topology.is_sharp(h) && ends.into_iter().all(smooth_end);
        Some(SharedEdge { sides: [side(h), side(twin)], smooth })
    };
    (0..mesh.corner_count() as u32).filter_map(edge).collect()
}

/// The Bezier points of the edge from corner `k` to the next, among the points of a patch.
pub fn edge_points<T: Copy>(kind: PatchKind, points: &[T], k: usize) -> [T; 4] {
    let n = kind.corners();
    let next = (k + 1) % n;
    let slots = match kind {
        PatchKind::Regular => [CORNER_SLOTS[k][0], CORNER_SLOTS[k][1], CORNER_SLOTS[next][2], CORNER_SLOTS[next][0]],
        _ => [k, n + 2 * k, n + 2 * next + 1, next],
    };
    slots.map(|slot| points[slot])
}

/// The parameters of the corners of a patch.
pub fn corner_parameters(kind: PatchKind) -> &'static [[f64; 2]] {
    match kind {
        PatchKind::Triangle => &[[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]],
        _ => &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
    }
}

/// The parameters of the point at `t` on the way from corner `k` to the next.
pub fn edge_parameters(kind: PatchKind, k: usize, t: f64) -> [f64; 2] {
    let corners = corner_parameters(kind);
    let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
    // At both ends and on the edge itself without rounding: `1 - t` once.
    let s = 1.0 - t;
    [0, 1].map(|i| s * from[i] + t * to[i])
}

/// The bits of a point; zeros of both signs are one.
pub fn bits(point: impl Into<[f32; 3]>) -> [u32; 3] {
    point.into().map(|x| (x + 0.0).to_bits())
}
