//! What a caller chooses.

use super::error::DiceError;

/// The greatest depth.
pub const MAX_DEPTH: u32 = 10;

/// How finely each facet is tessellated.
///
/// A *depth* counts levels of subdivision of the control mesh: at depth d a quad becomes `2^d` by `2^d` quads. The first level
/// makes the facets, so 1 is the least. A facet is a face corner of the control mesh and has its number.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Depth {
    /// This for every facet.
    Fixed(u32),
    /// One a facet: one a face corner of the control mesh.
    Each(Vec<u32>),
    /// As deep as makes no edge of the refined control mesh longer than this, in the units of the mesh.
    EdgeLength(f64),
    /// As deep as makes no edge of the refined control mesh longer than `pixels`, as `camera` sees it. Facets that it does not
    /// see have the least depth.
    Pixels {
        /// Length in pixels.
        pixels: f64,
        /// The camera, which need not be the one of the picture.
        camera: Camera,
    },
    /// As deep as keeps all faces within this distance of the limit surface, in the units of the mesh: a bound, see
    /// [`Plan::error_bound`](super::Plan::error_bound).
    Tolerance(f64),
}

/// What measures pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Object space to Vulkan's clip space, by columns.
    pub view_projection: [[f64; 4]; 4],
    /// Width and height in pixels.
    pub size: [f64; 2],
}

/// Options of a tessellation.
#[derive(Debug, Clone, PartialEq)]
pub struct DiceOptions {
    /// How finely facets are tessellated.
    pub depth: Depth,
    /// The greatest depth that lengths may ask for: 1 to [`MAX_DEPTH`].
    pub max_depth: u32,
    /// How much the depths of neighbours may differ. Facets beside much deeper ones become deeper, so that no triangle is
    /// thinner than the step asks for; [`MAX_DEPTH`] leaves all depths as they are.
    pub max_step: u32,
}

impl Default for DiceOptions {
    fn default() -> Self {
        Self { depth: Depth::Fixed(3), max_depth: 8, max_step: 1 }
    }
}

impl DiceOptions {
    /// This depth for every facet.
    pub fn fixed(depth: u32) -> Self {
        Self { depth: Depth::Fixed(depth), ..Self::default() }
    }

    pub(super) fn check(&self, facets: usize) -> Result<(), DiceError> {
        let check_depth = |depth: u32| match depth {
            1..=MAX_DEPTH => Ok(()),
            _ => Err(DiceError::BadDepth { depth }),
        };
        let check_length = |what, value: f64| match value > 0.0 && value.is_finite() {
            true => Ok(()),
            false => Err(DiceError::NotPositive { what, value }),
        };
        check_depth(self.max_depth)?;
        check_length("largest step between neighbours", self.max_step.into())?;
        match &self.depth {
            Depth::Fixed(depth) => check_depth(*depth),
            Depth::Each(depths) if depths.len() != facets => Err(DiceError::DepthCount { given: depths.len(), facets }),
            Depth::Each(depths) => depths.iter().try_for_each(|&depth| check_depth(depth)),
            Depth::Tolerance(distance) => check_length("tolerance", *distance),
            Depth::EdgeLength(length) => check_length("edge length", *length),
            Depth::Pixels { pixels, camera } => {
                check_length("edge length in pixels", *pixels)?;
                camera.size.iter().try_for_each(|&size| check_length("picture size", size))
            }
        }
    }
}
