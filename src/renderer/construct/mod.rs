//! Constructions that make control points before the draws. The others are stages of the draws.

mod cached;
mod conversion;

pub(crate) use cached::CachedPipelines;
pub(crate) use conversion::Conversion;
