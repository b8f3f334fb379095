//! Gregory patches where a scheme has none.

use super::scheme::Scheme;

/// Replacement for patches that a scheme does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Fallback {
    /// The mesh is refused, and the first such face named ([`Undefined`](super::Undefined)).
    #[default]
    Refuse,
    /// They are drawn with Gregory patches, which are defined everywhere. Edges between the schemes are C0.
    Gregory,
}

impl Fallback {
    /// The scheme of those faces.
    pub fn scheme(self) -> Option<Scheme> {
        match self {
            Self::Refuse => None,
            Self::Gregory => Some(Scheme::Gregory),
        }
    }
}
