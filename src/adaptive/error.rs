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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_that_cannot_be_addressed_say_what_to_do() {
        let error = AdaptiveError::TooLarge { depth: 9, what: "vertices", count: 5_000_000_000, max: 2_147_483_647 };
        let expected =
            "depth 9: the plan has 5000000000 vertices, of which 2147483647 can be addressed: choose a lesser depth";
        assert_eq!(error.to_string(), expected);
        let vertex = MeshError::UnknownShape { name: "cub".into(), known: "cube".into() };
        assert_eq!(AdaptiveError::Level { level: 3, error: vertex.clone() }.to_string(), format!("level 3: {vertex}"));
    }
}
