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

named! {
    /// Part of the surface that a patch is. The surface is the same.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum DrawnBy {
        /// One a face, which finds the leaf of each of its vertices (Brainerd et al. 2016): few patches, factors as without adaptive
        /// subdivision, every evaluation.
        #[default]
        Faces = "faces",
        /// One a leaf (Niessner et al. 2012), or a fan of triangles if leaves are finer beyond one of its edges: more patches, each with
        /// control points of its own. [`Evaluation::Tessellation`](crate::table::Evaluation::Tessellation) only.
        Leaves = "leaves",
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
    /// Part of the surface that a patch is.
    pub drawn_by: DrawnBy,
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
