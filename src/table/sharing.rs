//! What neighbouring patches share. Compiled into `build.rs`, too: an axis along which shaders vary.

/// What patches share along edges and at corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Sharing {
    /// Positions alone.
    Positions,
    /// Positions and normals.
    Normals,
    /// Normals and where the displacement is looked up.
    Displacement,
}

impl Sharing {
    /// Vectors that a corner shares. GLSL twin: `SHARED_VECTORS` in `glsl/lib/edges/shared_bits.glsl`.
    pub const fn vectors(self) -> u32 {
        match self {
            Self::Positions => 0,
            Self::Normals => 5,
            Self::Displacement => 6,
        }
    }

    /// Texels of four numbers for the vectors that a corner owns and shares, and whether its plus edge is sharp. GLSL twin:
    /// `KEPT_TEXELS` in `glsl/lib/construct/cached.glsl`.
    pub const fn kept_texels(self, owned: usize) -> u32 {
        let sharp = matches!(self, Self::Normals | Self::Displacement) as u32;
        (3 * (owned as u32 + self.vectors()) + sharp).div_ceil(4)
    }
}
