//! ACC as Loop and Schaefer published it (*Approximating Catmull-Clark Subdivision Surfaces with Bicubic Patches*, 2008): the
//! tangent patches are made in the evaluation, at every vertex, from a few vectors and a cosine of each corner. The crate
//! makes them in the control shader, once a patch: the same surface.

use crate::gpu::shaders;

/// What is drawn with in the place of the crate's shaders, through the tessellation stages or instanced.
pub(super) fn shaders() -> Vec<(String, Vec<u32>)> {
    let pairs = [
        ("CONSTRUCT_ACC_TESC", shaders::BENCH_ACC_PUBLISHED_TESC),
        ("EVALUATE_ACC_TESE", shaders::BENCH_ACC_PUBLISHED_TESE),
        ("COMPUTE_CONTROL_POINTS_COMP_ACC", shaders::BENCH_ACC_PUBLISHED_COMP),
        ("EVALUATE_INSTANCED_VERT_ACC", shaders::BENCH_ACC_PUBLISHED_VERT),
        ("EVALUATE_INSTANCED_VERT_ACC_ATTRIBUTES", shaders::BENCH_ACC_PUBLISHED_VERT_ATTRIBUTES),
    ];
    pairs.map(|(name, code)| (name.to_owned(), code.to_vec())).into()
}

/// Bytes that the control shader hands on of an irregular quad: 16 points, two tangents of each corner, four cosines.
pub(super) const QUAD_BYTES: u64 = 12 * (16 + 8) + 4 * 4;
