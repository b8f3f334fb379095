//! How many leaves a plan has.

use super::feature::Reason;
use super::plan::{LeafKind, Plan};

/// The leaves and the refined cells of one level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct LevelCounts {
    /// Regular leaves.
    pub regular: usize,
    /// Single-crease leaves.
    pub single_crease: usize,
    /// End caps.
    pub caps: usize,
    /// Refined cells by reason, in the order of [`Reason::ALL`].
    pub refined: [usize; Reason::ALL.len()],
}

impl LevelCounts {
    /// Leaves of all kinds.
    pub fn leaves(&self) -> usize {
        self.regular + self.single_crease + self.caps
    }
}

impl Plan {
    /// The counts of each level, from level 0.
    pub fn counts(&self) -> Vec<LevelCounts> {
        let deepest = self.leaves.iter().map(|leaf| leaf.level).max().unwrap_or(0);
        let mut counts = vec![LevelCounts::default(); deepest as usize + 1];
        for leaf in &self.leaves {
            let level = &mut counts[leaf.level as usize];
            *match leaf.kind {
                LeafKind::Regular => &mut level.regular,
                LeafKind::SingleCrease { .. } => &mut level.single_crease,
                LeafKind::Cap => &mut level.caps,
            } += 1;
        }
        for cell in &self.refined {
            counts[cell.level as usize].refined[cell.reason as usize] += 1;
        }
        counts
    }
}
