//! Displacement maps on the command line.

use super::error::CliError;
use ash_subdiv::ControlMesh;
use ash_subdiv::headless::{Headless, HeadlessError, Texels, Texture};
use clap::Args;

/// The built-in height map: overlapping scales, which repeat.
const SCALES: &[u8] = include_bytes!("../../assets/scales.png");
/// Name in [`DisplacementArgs::displacement`].
const SCALES_NAME: &str = "scales";

#[derive(Debug, Args)]
pub(super) struct DisplacementArgs {
    /// Move the surface by a height map: a PNG or EXR file, or `scales` for a built-in one. The mesh has to have texture
    /// coordinates.
    #[arg(long, value_name = "FILE")]
    displacement: Option<String>,
    /// Distance that the greatest height (1 in a PNG file) moves it, as a part of the bounding box's diagonal.
    #[arg(long, value_name = "PART", default_value_t = 0.01, allow_negative_numbers = true)]
    displacement_scale: f32,
    /// Distance that is added everywhere, as a part of the diagonal.
    #[arg(long, value_name = "PART", default_value_t = 0.0, allow_negative_numbers = true)]
    displacement_bias: f32,
    /// The map holds vectors in object space, in red, green and blue.
    #[arg(long)]
    displacement_vectors: bool,
    /// Texels that the map has at most.
    #[arg(long, value_name = "COUNT", default_value_t = Texels::MAX)]
    max_texels: u64,
}

impl DisplacementArgs {
    pub(super) fn is_given(&self) -> bool {
        self.displacement.is_some()
    }

    /// Reads the map, if one is given.
    pub(super) fn texels(&self) -> Result<Option<Texels>, CliError> {
        let Some(name) = &self.displacement else { return Ok(None) };
        let vectors = self.displacement_vectors;
        for (option, part) in [("scale", self.displacement_scale), ("bias", self.displacement_bias)] {
            if !part.is_finite() {
                return Err(CliError::Usage(format!("--displacement-{option} {part}: give a number")));
            }
        }
        match name.as_str() {
            SCALES_NAME => Ok(Some(scales()?)),
            file => Ok(Some(Texels::open_up_to(file, vectors, self.max_texels).map_err(|error| match error {
                HeadlessError::Picture { path, message } => {
                    CliError::Work(format!("--displacement {}: {message}", path.display()))
                }
                other => other.into(),
            })?)),
        }
    }

    /// Whether the map is asked for as one of vectors.
    pub(super) fn has_vectors(&self) -> bool {
        self.displacement_vectors
    }

    /// Distance that the map moves a point along an axis, at most.
    pub(super) fn reach(&self, mesh: &ControlMesh, texels: &Texels) -> f64 {
        let [scale, bias] = self.amount(mesh);
        let ends = texels.range().map(|value| f64::from(scale * value + bias).abs());
        ends[0].max(ends[1])
    }

    /// Scale and bias in the mesh's own units.
    pub(super) fn amount(&self, mesh: &ControlMesh) -> [f32; 2] {
        let diagonal = diagonal(mesh);
        [self.displacement_scale * diagonal, self.displacement_bias * diagonal]
    }
}

/// The built-in height map: the picture as often side by side as makes the scales small on an atlas.
pub(super) fn scales() -> Result<Texels, CliError> {
    const TILES: u32 = 4;
    Texels::decode(SCALES, false)
        .map(|texels| texels.tiled(TILES))
        .map_err(|error| CliError::Work(format!("the built-in height map: {error}")))
}

/// The map on the device.
pub(super) fn texture(headless: &Headless, texels: &Texels) -> Result<Texture, CliError> {
    Ok(Texture::new(headless, "displacement map", texels)?)
}

/// Diagonal of the control mesh's bounding box.
pub(super) fn diagonal(mesh: &ControlMesh) -> f32 {
    let [low, high] = mesh.bounds();
    (high - low).length() as f32
}
