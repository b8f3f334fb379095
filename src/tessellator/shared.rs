//! What a patch corner shares with other patches.

use super::draw::{exact_cross, unit};
use crate::constants::SHARP_EDGE_BIT;
use crate::patch::{Frame, RingValues, Scheme, unit_normal};
use crate::table::SHARED_WORDS;
use glam::Vec3;

/// A ring with its limit point and tangent frame. GLSL twin: `FramedRing` in `glsl/lib/construct/framed_ring.glsl`.
#[derive(Debug, Clone)]
pub struct FramedRing {
    /// Around the vertex.
    pub ring: RingValues<Vec3>,
    /// That of the scheme.
    pub frame: Frame<Vec3>,
}

/// An edge as the vertex of a ring sees it. GLSL twin: `SharedEdge` in `glsl/lib/edges/shared.glsl`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedEdge {
    /// [`RingValues::across`].
    pub across: Vec3,
    /// [`Scheme::transversal`].
    pub transversal: Vec3,
}

impl FramedRing {
    /// Of a ring in a scheme.
    pub fn new(scheme: Scheme, ring: RingValues<Vec3>) -> Self {
        Self { frame: scheme.frame(&ring), ring }
    }

    /// Edge `j` of the ring.
    ///
    /// GLSL twin: `shared_edge` in `glsl/lib/edges/shared.glsl`.
    fn shared_edge(&self, scheme: Scheme, j: usize) -> SharedEdge {
        SharedEdge {
            across: self.ring.across(&self.frame, j),
            transversal: scheme.transversal(&self.ring, &self.frame, j),
        }
    }

    /// The normal at the vertex; without a tangent plane, the mean normal of the faces around it.
    ///
    /// GLSL twin: `ring_normal` in `glsl/lib/construct/framed_ring.glsl`.
    pub fn normal(&self) -> Vec3 {
        let normal = unit_normal(self.frame.a, self.frame.b, Vec3::ZERO);
        if normal != Vec3::ZERO {
            return normal;
        }
        let RingValues { centre, edges, diagonals, .. } = &self.ring;
        let around =
            |i: usize| (if i.is_multiple_of(2) { edges[i / 2 % edges.len()] } else { diagonals[i / 2] }) - *centre;
        let faces = diagonals.len();
        let sum = (0..2 * faces).map(|i| exact_cross(around(i), around(i + 1))).fold(Vec3::ZERO, |sum, x| sum + x);
        unit(sum)
    }
}

/// What a corner of a patch shares: across its plus edge and that edge's transversal, across its minus edge and its
/// transversal, the normal, and the direction of displacement, which is the normal where the surface is not `displaced`.
/// The words are those of [`SharedTable::corners`](crate::table::SharedTable::corners); `own` is the number of the corner's ring,
/// `framed` gives rings by number.
///
/// GLSL twin: `share_corner` in `glsl/lib/edges/shared.glsl`.
pub fn share_corner<'r>(
    scheme: Scheme,
    [owner, plus_ring, plus_edge, minus_ring, minus_edge]: [u32; SHARED_WORDS],
    own: u32,
    displaced: bool,
    framed: impl Fn(u32) -> &'r FramedRing,
) -> [Vec3; 6] {
    let edge = |ring: u32, j: u32| framed(ring).shared_edge(scheme, j as usize);
    let plus = edge(plus_ring, plus_edge & !SHARP_EDGE_BIT);
    let minus = edge(minus_ring, minus_edge);
    let normal = framed(own).normal();
    let direction = if displaced { framed(owner).normal() } else { normal };
    [plus.across, plus.transversal, minus.across, minus.transversal, normal, direction]
}
