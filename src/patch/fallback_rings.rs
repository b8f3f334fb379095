//! How Gregory patches join the patches of another scheme.

use crate::topology::Topology;

/// The one-rings around which all patches have Gregory's points along the edges: those with a face that falls back to Gregory
/// patches, and with ACC those of regular patches, which have these anyway. By default there are none.
///
/// The curve along an edge is a cubic whose points come from the one-rings at its two ends, two from each: the corner point
/// and the edge point. In what a scheme makes of a ring, the schemes differ:
///
/// | ring | corner point | edge points |
/// |---|---|---|
/// | regular | equal in all schemes | equal in all |
/// | of quads, other valences | equal in all | Gregory's, ACC's and Pm's differ |
/// | with triangles | Gregory's and ACC's equal; Pm's differs | all differ |
/// | at creases, boundaries and corners (no Pm) | Gregory's and ACC's equal | equal along the crease, else different |
///
/// So a ring with a face that falls back has Gregory's points in *all* patches around it: both sides of
/// every edge have one curve, which is C0 whatever the schemes. Between patches of one scheme nothing is lost: Pm-patches
/// are G1, and ACC patches have one normal, with any frame at their corners. Between patches of two schemes the tangent
/// planes agree at the corners; along an edge they do where the rings at both ends are regular.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FallbackRings {
    /// By ring; empty if there are none.
    rings: Vec<bool>,
}

impl FallbackRings {
    /// The rings of these faces.
    pub fn new(topology: &Topology, faces: impl IntoIterator<Item = u32>) -> Self {
        let mut rings = Vec::new();
        for face in faces {
            rings.resize(topology.rings().len(), false);
            for h in topology.mesh().face_corners(face) {
                rings[topology.place(h as u32).ring as usize] = true;
            }
        }
        Self { rings }
    }

    /// Whether a ring of [`Topology::rings`] is one of them.
    pub fn contains(&self, ring: u32) -> bool {
        self.rings.get(ring as usize).copied().unwrap_or(false)
    }
}
