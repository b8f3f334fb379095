//! Models whose faces are subdivided in a geometry shader ([`Evaluation::Subdivision`]).

use crate::renderer::options::{Error, Factor, ModelId};

/// Every device with geometry shaders has room for the strips of so many levels (`glsl/subdivide/faces.geom`).
pub(crate) const MAX_LEVEL: u32 = 3;

/// How often a draw with this factor subdivides.
pub(crate) fn level(id: ModelId, factor: Factor) -> Result<u32, Error> {
    let segments = |level: &u32| factor == Factor::Uniform((1 << level) as f32);
    (0..=MAX_LEVEL).find(segments).ok_or(Error::NoSuchLevel { id, factor })
}

/// The vertices that a face takes in strips, which are no longer than four segments.
pub(crate) fn vertices(level: u32) -> u32 {
    let (side, drawn) = (1 << level, 1 << level.min(2));
    side / drawn * side * 2 * (drawn + 1)
}
