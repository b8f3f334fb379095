use crate::gpu::Spacing;
#[cfg(doc)]
use crate::measure::statistics::FEWEST;
use crate::named::named;

named! {
    /// Position of the eye.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[non_exhaustive]
    pub enum Camera {
        /// Far enough to have all in the picture.
        #[default]
        Fit = "fit",
        /// The middle of that, three times as large: the edges of the picture cut the rest off.
        Clipped = "clipped",
    }
}

named! {
    /// Whether the control vertices move.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    #[non_exhaustive]
    pub enum Motion {
        /// In every frame: what depends on them is made anew.
        #[default]
        Moving = "moving",
        /// Never: what was kept of the frame before is drawn.
        Still = "still",
    }
}

/// Options of the measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchOptions {
    /// Tessellation factors, from 1 up, of all edges and insides.
    pub factors: Vec<f32>,
    /// Where the tessellator puts its vertices.
    pub spacing: Spacing,
    /// Motion of the control vertices, which says what each frame makes anew.
    pub motion: Motion,
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// Cameras that each contestant draws from, in turns.
    pub cameras: Vec<Camera>,
    /// Whether the rasterizer culls triangles that face away, as renderers have it of closed models. Some drivers then count
    /// fewer of what clipping leaves.
    pub single_sided: bool,
    /// Copies of the model that a frame draws, each with a transform of its own.
    pub instances: u32,
    /// Passes of a frame, each of which draws all instances again, as for depth, shadows and the picture.
    pub passes: u32,
    /// Frames of each contestant that count, at least [`FEWEST`].
    pub frames: u32,
    /// Frames of each contestant that go before and do not count.
    pub warm_up: u32,
}

impl Default for BenchOptions {
    /// Factors 4, 8, 16 and 32, equal spacing, moving vertices, 1024 x 1024 pixels with all in the picture, of both sides, one
    /// instance, one pass, 21 frames after 3.
    fn default() -> Self {
        Self {
            factors: vec![4.0, 8.0, 16.0, 32.0],
            spacing: Spacing::Equal,
            motion: Motion::Moving,
            size: [1024, 1024],
            cameras: vec![Camera::Fit],
            single_sided: false,
            instances: 1,
            passes: 1,
            frames: 21,
            warm_up: 3,
        }
    }
}
