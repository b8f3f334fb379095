//! What a caller chooses.

use super::error::AdaptiveError;
use crate::named::named;

/// The greatest depth.
pub const MAX_DEPTH: u32 = crate::constants::MAX_DEPTH;

named! {
    /// What refined vertices are sums of, each frame in which the control vertices moved. The surface is the same.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[non_exhaustive]
    pub enum Sums {
        /// Of those one level above: short sums, which take a step for each level.
        #[default]
        Levels = "levels",
        /// Of control vertices alone: long sums, which can be made all at once.
        Composed = "composed",
    }
}

/// Depths to which faces are refined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AdaptiveOptions {
    /// The level of the end caps around extraordinary vertices, 0 to [`MAX_DEPTH`]. At 0 an irregular quad is one end cap.
    /// Faces other than quads are refined once in any case.
    pub depth: u32,
    /// The level of the end caps around sharp features: darts, corners, creases whose sharpness varies. `None` is
    /// [`AdaptiveOptions::depth`].
    pub sharp_depth: Option<u32>,
    /// Whether faces along creases of finite sharpness are refined, too, down to [`AdaptiveOptions::sharp_depth`]. The surface is
    /// the same: to compare with leaves that follow the crease.
    pub refine_creases: bool,
    /// What refined vertices are sums of.
    pub sums: Sums,
}

impl AdaptiveOptions {
    /// The depth around sharp features.
    pub fn sharp_depth(&self) -> u32 {
        self.sharp_depth.unwrap_or(self.depth)
    }

    pub(super) fn check(&self) -> Result<(), AdaptiveError> {
        for (what, depth) in [("depth", self.depth), ("depth of sharp features", self.sharp_depth())] {
            if depth > MAX_DEPTH {
                return Err(AdaptiveError::TooDeep { what, depth });
            }
        }
        Ok(())
    }
}
