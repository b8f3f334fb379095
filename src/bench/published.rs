//! ACC as Loop and Schaefer published it (*Approximating Catmull-Clark Subdivision Surfaces with Bicubic Patches*, 2008): the
//! tangent patches are made in the evaluation, at every vertex, from a few vectors and a cosine of each corner. The crate
//! makes them in the control shader, once a patch: the same surface.

use super::shaders;
use crate::renderer::ShaderId;

/// What is drawn with in the place of the crate's shaders, through the tessellation stages or instanced.
pub(super) fn shaders() -> Vec<(ShaderId, Vec<u32>)> {
    let pairs = [
        (ShaderId::ConstructTwoStageTescAccQuad, shaders::ACC_PUBLISHED_TESC),
        (ShaderId::EvaluateTessellationTeseAccQuad, shaders::ACC_PUBLISHED_TESE),
        (ShaderId::ComputeControlPointsCompAccQuad, shaders::ACC_PUBLISHED_COMP),
        (ShaderId::EvaluateInstancedVertAccQuad, shaders::ACC_PUBLISHED_VERT),
        (ShaderId::EvaluateInstancedVertAccQuadAttributes, shaders::ACC_PUBLISHED_VERT_ATTRIBUTES),
    ];
    pairs.map(|(id, code)| (id, code.to_vec())).into()
}

/// Bytes that the control shader hands on of an irregular quad: 16 points, two tangents of each corner, four cosines.
pub(super) const QUAD_BYTES: u64 = 12 * (16 + 8) + 4 * 4;
