//! Legend of a map, written below the picture.

use super::super::canvas::{Canvas, FONT, drawing_error, load_font};
use super::super::error::CliError;
use super::super::output::short;
use super::super::parse::Colour;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The smallest picture that a legend fits in.
const SMALLEST: [u32; 2] = [240, 120];

/// Colours, from no error to the top of the scale.
pub(super) const COLOURS: usize = 256;

/// A colour of the scale, as sRGB bytes: as far apart to the eye as the numbers are, and light where there is little error,
/// so that light and shade show the shape there.
pub(super) fn colour(number: usize) -> Colour {
    let colour = colorous::MAGMA.eval_continuous(1.0 - number as f64 / (COLOURS - 1) as f64);
    Colour([colour.r, colour.g, colour.b, 255])
}

/// What the colours of a map mean.
pub(in super::super) enum Legend {
    /// A scale from zero to `top`.
    Scale {
        /// Quantity that is shown, with its unit.
        title: String,
        top: f64,
        /// Whether there are values above the top.
        exceeded: bool,
    },
    /// Names of colours, from left to right.
    Swatches { title: String, swatches: Vec<Swatch> },
}

/// A name, and the colours that have it.
pub(in super::super) struct Swatch {
    pub name: String,
    pub colours: Vec<Colour>,
}

impl Legend {
    /// Rows of a picture that the legend takes.
    pub(in super::super) fn height(size: [u32; 2]) -> Result<u32, CliError> {
        let [width, height] = size;
        if width < SMALLEST[0] || height < SMALLEST[1] {
            let [w, h] = SMALLEST;
            let message = format!("--size {width}x{height}: pictures with a legend are at least {w}x{h}");
            return Err(CliError::Usage(message));
        }
        Ok(rows(size))
    }

    /// Adds the legend below a picture; `size` includes it.
    pub(in super::super) fn add(&self, size: [u32; 2], background: Colour, rgba: &mut Vec<u8>) -> Result<(), CliError> {
        let [width, height] = size;
        while rgba.len() < 4 * width as usize * height as usize {
            rgba.extend(background.0);
        }
        self.draw(Canvas { size, rgba }, background).map_err(drawing_error)
    }

    fn draw(&self, canvas: Canvas, background: Colour) -> Result<(), impl std::error::Error + use<>> {
        load_font();
        let size = canvas.size;
        let root = canvas.into_drawing_area();
        let font = font_size(size) as i32;
        let [width, height] = size.map(|side| side as i32);
        let [r, g, b, alpha] = background.0;
        let is_dark = alpha > 0 && 299 * u32::from(r) + 587 * u32::from(g) + 114 * u32::from(b) < 128_000;
        let ink = if is_dark { RGBColor(240, 240, 240) } else { RGBColor(30, 30, 34) };
        let text = |x, y, anchor, text: String| {
            let style = (FONT, font).into_font().color(&ink).pos(Pos::new(anchor, VPos::Top));
            root.draw(&Text::new(text, (x, y), style))
        };
        let margin = font;
        let (left, right) = (margin, width - margin);
        let first_row = height - rows(size) as i32;
        let (bar, bar_end) = (first_row + 7 * font / 4, first_row + 11 * font / 4);
        let labels = bar_end + font / 4;
        let bar = |[from, to]: [i32; 2], Colour([r, g, b, _]): Colour| {
            root.draw(&Rectangle::new([(from, bar), (to, bar_end)], RGBColor(r, g, b).filled()))
        };
        match self {
            Self::Scale { title, top, exceeded } => {
                text(left, first_row + font / 4, HPos::Left, title.clone())?;
                for x in left..right {
                    let number = (x - left) as usize * (COLOURS - 1) / (right - left - 1) as usize;
                    bar([x, x], colour(number))?;
                }
                text(left, labels, HPos::Left, "0".into())?;
                text((left + right) / 2, labels, HPos::Center, short(top / 2.0))?;
                let sign = if *exceeded { "≥ " } else { "" };
                text(right, labels, HPos::Right, format!("{sign}{}", short(*top)))?;
            }
            Self::Swatches { title, swatches } => {
                text(left, first_row + font / 4, HPos::Left, title.clone())?;
                let at = |i: usize, count: usize, [from, to]: [i32; 2]| from + (to - from) * i as i32 / count as i32;
                for (i, Swatch { name, colours }) in swatches.iter().enumerate() {
                    let [from, to] = [i, i + 1].map(|i| at(i, swatches.len(), [left, right + 2]));
                    let to = to - 2;
                    for (k, &colour) in colours.iter().enumerate() {
                        bar([k, k + 1].map(|k| at(k, colours.len(), [from, to])), colour)?;
                    }
                    text((from + to) / 2, labels, HPos::Center, name.clone())?;
                }
            }
        }
        root.present()
    }
}

/// Rows of the legend.
fn rows(size: [u32; 2]) -> u32 {
    9 * font_size(size) / 2
}

/// Height of a line, in pixels.
fn font_size([width, height]: [u32; 2]) -> u32 {
    (width.min(height * 2) / 40).clamp(11, 40)
}
