//! Error against patches and against bytes, as SVG and PNG.

use super::canvas::{Canvas, FONT, drawing_error, load_font};
use super::error::CliError;
use super::output::{short, write_file};
use ash::vk;
use ash_subdiv::headless::save_png;
use image::RgbaImage;
use image::imageops::{FilterType, resize};
use plotters::coord::Shift;
use plotters::prelude::*;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A scheme at several costs.
pub(super) struct Curve {
    pub name: String,
    pub points: Vec<CurvePoint>,
}

/// Cost of a surface, and its errors against the limit surface (root mean squares; none where not measured).
pub(super) struct CurvePoint {
    pub patches: f64,
    pub table_bytes: f64,
    pub errors: [Option<f64>; 3],
}

/// Content of a plot.
pub(super) struct Figure {
    pub title: String,
    pub subtitle: String,
    pub curves: Vec<Curve>,
    /// Curve that an exact scheme would have.
    pub floor: Curve,
}

/// Names of the errors of a [`CurvePoint`].
const ERRORS: [&str; 3] = ["position rms / diagonal", "nearest rms / diagonal", "normal rms, radians"];

type Cost = (&'static str, fn(&CurvePoint) -> f64);
const COSTS: [Cost; 2] = [("patches", |point| point.patches), ("bytes of tables", |point| point.table_bytes)];

/// Errors that are no more than this are none.
const ROUNDING: f64 = 1e-12;

/// In pixels.
const SIZE: [u32; 2] = [1500, 940];

/// The PNG is drawn larger by this, and scaled down: the lines that are drawn have no half-covered pixels.
const OVERSAMPLING: u32 = 3;

/// Okabe and Ito's: told apart with any colour vision.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];

/// `prefix.svg` and `prefix.png`; if it has such an ending already, that is taken off first.
pub(super) fn files(prefix: &Path) -> [PathBuf; 2] {
    let ends = prefix.extension().is_some_and(|ending| ending == "svg" || ending == "png");
    let stem = if ends { prefix.with_extension("") } else { prefix.to_owned() };
    [".svg", ".png"].map(|ending| {
        let mut file = stem.clone().into_os_string();
        file.push(ending);
        file.into()
    })
}

/// Writes both files.
pub(super) fn write(prefix: &Path, figure: &Figure) -> Result<(), CliError> {
    load_font();
    let [svg, png] = files(prefix);
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, SIZE.into()).into_drawing_area();
    figure.draw(&area, 1).map_err(drawing_error)?;
    drop(area);
    write_file(&svg, |part| std::fs::write(part, &text).map_err(|error| error.to_string()))?;

    let [width, height] = SIZE.map(|side| side * OVERSAMPLING);
    let mut large = RgbaImage::new(width, height);
    let area = Canvas { size: [width, height], rgba: &mut large }.into_drawing_area();
    figure.draw(&area, OVERSAMPLING).map_err(drawing_error)?;
    drop(area);
    let [width, height] = SIZE;
    let small = resize(&large, width, height, FilterType::Triangle);
    let extent = vk::Extent2D { width, height };
    write_file(&png, |part| save_png(part, extent, &small).map_err(|error| error.to_string()))
}

const FLOOR_COLOUR: RGBColor = RGBColor(150, 150, 150);

type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

impl Figure {
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Drawn<B> {
        let font = |size: u32| (FONT, size * scale).into_font();
        area.fill(&WHITE)?;
        let (head, panels) = area.split_vertically(86 * scale);
        let left = 24 * scale as i32;
        head.draw(&Text::new(self.title.as_str(), (left, 14 * scale as i32), font(26)))?;
        head.draw(&Text::new(self.subtitle.as_str(), (left, 52 * scale as i32), font(17)))?;
        let panels = panels.split_evenly((COSTS.len(), ERRORS.len()));
        let mut panels = panels.iter();
        for cost in COSTS {
            for (error, what) in ERRORS.into_iter().enumerate() {
                if let Some(panel) = panels.next() {
                    self.draw_panel(panel, scale, cost, (error, what))?;
                }
            }
        }
        area.present()
    }

    fn draw_panel<B: DrawingBackend>(
        &self,
        panel: &DrawingArea<B, Shift>,
        scale: u32,
        (cost_name, cost): Cost,
        (error, error_name): (usize, &str),
    ) -> Drawn<B> {
        let font = |size: u32| (FONT, size * scale).into_font();
        let points = |curve: &Curve| curve.drawn(cost, error);
        let all: Vec<_> = self.curves.iter().chain([&self.floor]).flat_map(points).collect();
        if all.is_empty() {
            let at = [24, 24].map(|x| x * scale as i32);
            panel.draw(&Text::new(format!("{error_name}: no error, or not measured"), at.into(), font(15)))?;
            return Ok(());
        }
        let range = |value: fn(&(f64, f64)) -> f64| axis_range(all.iter().map(value));
        let mut chart = ChartBuilder::on(panel)
            .margin(14 * scale)
            .margin_right(26 * scale)
            .caption(format!("{error_name}, against {cost_name}"), font(17))
            .x_label_area_size(44 * scale)
            .y_label_area_size(74 * scale)
            .build_cartesian_2d(range(|p| p.0).log_scale(), range(|p| p.1).log_scale())?;
        chart
            .configure_mesh()
            .x_labels(6)
            .y_labels(8)
            .x_desc(cost_name)
            .label_style(font(13))
            .axis_desc_style(font(14))
            .light_line_style(RGBColor(238, 238, 238).stroke_width(scale))
            .bold_line_style(RGBColor(214, 214, 214).stroke_width(scale))
            .x_label_formatter(&|&x| short(x))
            .y_label_formatter(&|&y| short(y))
            .draw()?;
        for (number, curve) in self.curves.iter().chain([&self.floor]).enumerate() {
            let is_floor = number == self.curves.len();
            let colour = if is_floor { FLOOR_COLOUR } else { COLOURS[number % COLOURS.len()] };
            // Where curves lie on each other, later ones are thinner, with smaller dots: all are seen.
            let size = (self.curves.len() - number) as u32 * scale;
            chart
                .draw_series(LineSeries::new(points(curve), colour.stroke_width(size + scale)))?
                .label(curve.name.as_str())
                .legend(move |(x, y)| Circle::new((x + 8 * scale as i32, y), 5 * scale, colour.filled()));
            let dot = (3 * scale) + size;
            chart.draw_series(points(curve).into_iter().map(|at| Circle::new(at, dot, colour.filled())))?;
        }
        if error == 0 && cost_name == COSTS[0].0 {
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperRight)
                .label_font(font(15))
                .background_style(WHITE.mix(0.9))
                .border_style(RGBColor(200, 200, 200))
                .margin(10 * scale)
                .legend_area_size(22 * scale)
                .draw()?;
        }
        Ok(())
    }
}

impl Curve {
    /// Points of the curve that can be drawn: this cost against this error.
    fn drawn(&self, cost: fn(&CurvePoint) -> f64, error: usize) -> Vec<(f64, f64)> {
        let points = self.points.iter().map(|point| (cost(point), point.errors[error].unwrap_or(0.0)));
        points.filter(|&(x, y)| x > 0.0 && y > ROUNDING).collect()
    }
}

/// The range of a logarithmic axis around these.
fn axis_range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::MAX, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    let (low, high) = (low / 1.5, high * 1.5);
    // Powers of ten have labels: there are to be two.
    let (first, last) = (low.log10(), high.log10());
    match last.floor() - first.ceil() >= 1.0 {
        true => low..high,
        false => 10f64.powf(first.floor())..10f64.powf(last.ceil()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_are_not_doubled() {
        let names = |prefix: &str| files(Path::new(prefix)).map(|file| file.display().to_string());
        assert_eq!(names("out/frog"), ["out/frog.svg", "out/frog.png"]);
        assert_eq!(names("frog.png"), ["frog.svg", "frog.png"]);
        assert_eq!(names("v1.2"), ["v1.2.svg", "v1.2.png"]);
    }
}
