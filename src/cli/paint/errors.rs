//! The error of a surface, as what is painted on it.

use super::legend::{self, COLOURS, Legend};
use super::tiles::Tiles;
use ash_subdiv::MeshError;
use ash_subdiv::measure::{Quantity, error_field};
use ash_subdiv::table::{CpuSurface, grid_parameters};

/// Samples of the error over all patches, about: a second's work.
const SAMPLES: f64 = 1.5e6;

/// This part of all samples is below the top of the scale, if not told otherwise.
const BELOW_TOP: f64 = 0.99;

/// Errors on a square tile for each patch. GLSL twin: `src/cli/glsl/error.frag`.
pub(in super::super) struct ErrorMap {
    pub(super) tiles: Tiles,
    quantity: Quantity,
    /// The error that has the last colour: of positions over the diagonal, of normals in radians.
    pub top: f64,
    /// The largest there is.
    pub largest: f64,
    side: u32,
    values: Vec<f32>,
}

impl ErrorMap {
    /// Measures the patches of `surface`. Distances are over `diagonal`.
    pub(in super::super) fn new(
        surface: &CpuSurface,
        quantity: Quantity,
        diagonal: f64,
        top: Option<f32>,
    ) -> Result<Self, MeshError> {
        let patches = surface.plan().patches();
        let count = patches.len().max(1);
        let side = ((SAMPLES / count as f64).sqrt() as u32).clamp(5, 33);
        let field = error_field(surface, quantity, side)?;
        // A mesh without extent is one point.
        let unit = if quantity == Quantity::Position && diagonal > 0.0 { diagonal } else { 1.0 };
        let tile = (side * side) as usize;
        let mut values = vec![0.0; tile * count];
        let mesh = surface.prepared().mesh();
        for ((patch, errors), values) in patches.iter().zip(&field).zip(values.chunks_exact_mut(tile)) {
            let is_triangle = mesh.face_corners(patch.face).len() == 3;
            for (&[u, v], error) in grid_parameters(patch.kind, side).iter().zip(errors) {
                // In a triangle the second and the third barycentric coordinate are x and y.
                let at = if is_triangle { [v, 1.0 - u - v] } else { [u, v] };
                let [x, y] = at.map(|x| (x * f64::from(side - 1)).round() as usize);
                values[y * side as usize + x] = (error / unit) as f32;
            }
        }
        let mut all: Vec<f64> = field.concat().iter().map(|error| error / unit).collect();
        let largest = all.iter().copied().fold(0.0, f64::max);
        let top = top.map_or_else(|| scale_for(&mut all, quantity), f64::from);
        Ok(Self { tiles: Tiles::new(surface)?, quantity, top, largest, side, values })
    }

    /// The scale.
    pub(super) fn legend(&self, scheme: &str) -> Legend {
        let what = match self.quantity {
            Quantity::Normal => "normal error, radians",
            Quantity::Position => "position error / diagonal",
        };
        Legend::Scale { title: format!("{scheme}: {what}"), top: self.top, exceeded: self.largest > self.top }
    }

    /// Bytes that the shader reads.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let Tiles { columns, words, .. } = &self.tiles;
        let header = [self.side, *columns, (self.top as f32).to_bits(), words.len() as u32];
        let colours: Vec<[f32; 4]> = (0..COLOURS).map(|number| legend::colour(number).linear()).collect();
        let [header, words]: [&[u8]; 2] = [bytemuck::cast_slice(&header), bytemuck::cast_slice(words)];
        [header, bytemuck::cast_slice(&colours), words, bytemuck::cast_slice(&self.values)].concat()
    }
}

/// A round number that most errors are below; not so small that rounding would be seen.
fn scale_for(errors: &mut [f64], quantity: Quantity) -> f64 {
    let smallest: f64 = match quantity {
        Quantity::Position => 1e-6,
        Quantity::Normal => 1e-4,
    };
    if errors.is_empty() {
        return smallest;
    }
    let place = (BELOW_TOP * (errors.len() - 1) as f64) as usize;
    let (_, &mut high, _) = errors.select_nth_unstable_by(place, f64::total_cmp);
    round_up(high.max(smallest))
}

/// The next number of two digits that is easy to halve.
fn round_up(value: f64) -> f64 {
    let exponent = value.log10().floor() as i32;
    let digits = [1.0, 1.2, 1.6, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let ceiling = digits.into_iter().find(|&digit| digit * 10f64.powi(exponent) >= value * (1.0 - 1e-9));
    // As it is read, not as it is multiplied: 3 * 10^-4 is not 3e-4.
    format!("{}e{exponent}", ceiling.unwrap_or(10.0)).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_end_at_round_numbers() {
        for (value, rounded) in [(2.4e-4, 2.4e-4), (2.41e-4, 3e-4), (0.0101, 0.012), (9.0, 10.0), (1.0, 1.0)] {
            assert_eq!(round_up(value), rounded);
        }
        let mut errors: Vec<f64> = (0..=1000).map(|i| f64::from(i) / 1000.0).collect();
        assert_eq!(scale_for(&mut errors, Quantity::Normal), 1.0);
        errors[..995].fill(0.0);
        assert_eq!(scale_for(&mut errors[..], Quantity::Position), 1e-6);
        assert_eq!(scale_for(&mut [], Quantity::Position), 1e-6);
    }
}
