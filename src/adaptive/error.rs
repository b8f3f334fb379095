use super::options::MAX_DEPTH;
use crate::mesh::MeshError;
use crate::patch::Scheme;

/// Why there is no plan.
#[allow(missing_docs, reason = "the messages say it")]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AdaptiveError {
    #[error("{what} {depth}: adaptive subdivision goes {MAX_DEPTH} levels deep at most")]
    TooDeep { what: &'static str, depth: u32 },
    #[error("scheme {}: end caps are patches of gregory or gregory-fitted", scheme.name())]
    NoCaps { scheme: Scheme },
    #[error("depth {depth}: the plan has {count} {what}, of which {max} can be addressed: choose a lesser depth")]
    TooLarge { depth: u32, what: &'static str, count: usize, max: usize },
    #[error("level {level}: {error}")]
    Level { level: u32, error: MeshError },
}
