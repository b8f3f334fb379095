//! Pixels that plots and legends are drawn on.

use super::error::CliError;
use plotters::style::{FontStyle, register_font};
use plotters_backend::{BackendColor, BackendCoord, DrawingBackend, DrawingErrorKind};
use std::convert::Infallible;
use std::sync::Once;

/// The font of all that is written into pictures. Programs that show SVG have one of their own by this name.
pub(super) const FONT: &str = "sans-serif";

/// Makes [`FONT`] known: DejaVu Sans, which is part of the program.
pub(super) fn load_font() {
    static ONCE: Once = Once::new();
    // Drawing text would tell that there is no font.
    ONCE.call_once(|| drop(register_font(FONT, FontStyle::Normal, dejavu::sans::regular())));
}

/// Errors of a drawing.
pub(super) fn drawing_error(error: impl std::error::Error) -> CliError {
    CliError::Work(format!("drawing: {error}"))
}

/// A picture to draw on: rows from the top, four bytes RGBA a pixel, colours not multiplied by opacity.
pub(super) struct Canvas<'p> {
    pub size: [u32; 2],
    pub rgba: &'p mut [u8],
}

impl DrawingBackend for Canvas<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size.into()
    }

    fn ensure_prepared(&mut self) -> Result<(), DrawingErrorKind<Infallible>> {
        Ok(())
    }

    fn present(&mut self) -> Result<(), DrawingErrorKind<Infallible>> {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Result<(), DrawingErrorKind<Infallible>> {
        let [width, height] = self.size.map(i64::from);
        let (x, y) = (i64::from(x), i64::from(y));
        if !(0..width).contains(&x) || !(0..height).contains(&y) {
            return Ok(());
        }
        let pixel = &mut self.rgba[4 * (y * width + x) as usize..][..4];
        let behind = (1.0 - color.alpha) * f64::from(pixel[3]) / 255.0;
        let alpha = color.alpha + behind;
        if alpha > 0.0 {
            for (channel, over) in pixel.iter_mut().zip([color.rgb.0, color.rgb.1, color.rgb.2]) {
                let mixed = color.alpha * f64::from(over) + behind * f64::from(*channel);
                *channel = (mixed / alpha).round() as u8;
            }
        }
        pixel[3] = (255.0 * alpha).round() as u8;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_laid_over_what_is_there() {
        let mut rgba = [10, 20, 30, 255, 0, 0, 0, 0];
        let mut canvas = Canvas { size: [2, 1], rgba: &mut rgba };
        let half = BackendColor { alpha: 0.5, rgb: (110, 220, 30) };
        for at in [(0, 0), (1, 0), (2, 0), (0, -1)] {
            canvas.draw_pixel(at, half).unwrap();
        }
        assert_eq!(rgba, [60, 120, 30, 255, 110, 220, 30, 128]);
    }
}
