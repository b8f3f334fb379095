//! Plots as SVG. Colours of text and axes are the page's: its style sheet overrules those given here.

use super::super::super::error::CliError;
use crate::cli::canvas::{FONT, load_font};
use crate::cli::output::short;
use ash_subdiv::Construction;
use ash_subdiv::bench::Path;
use maud::html;
use plotters::coord::ranged1d::DefaultFormatting;
use plotters::prelude::*;
use plotters::style::Color;
use std::ops::Range;

/// Curve of one contestant.
pub(super) struct Line {
    /// Shown under the pointer, with the numbers of a point.
    pub label: String,
    pub style: LineStyle,
    /// Both above zero: the axes are logarithmic.
    pub points: Vec<(f64, f64)>,
}

/// Style of a contestant, the same in all plots.
#[derive(Clone, Copy)]
pub(super) struct LineStyle {
    pub colour: RGBColor,
    /// Pixels of a dash and of the gap after it; none for a whole line.
    pub dash: Option<[u32; 2]>,
    pub mark: Mark,
    /// Width of the line, in pixels.
    pub width: u32,
}

/// Mark at the points of a line.
#[derive(Clone, Copy)]
pub(super) struct Mark {
    /// In pixels, from the point.
    pub corners: &'static [(i32, i32)],
    pub filled: bool,
}

impl Mark {
    /// Opacity of its inside, from 0 to 1.
    pub(super) fn opacity(self) -> f64 {
        if self.filled { 1.0 } else { 0.15 }
    }
}

const ROUND: &[(i32, i32)] = &[(-2, -4), (2, -4), (4, -2), (4, 2), (2, 4), (-2, 4), (-4, 2), (-4, -2)];
const SQUARE: &[(i32, i32)] = &[(-4, -4), (4, -4), (4, 4), (-4, 4)];
const DIAMOND: &[(i32, i32)] = &[(0, -6), (6, 0), (0, 6), (-6, 0)];
const UP: &[(i32, i32)] = &[(0, -5), (5, 4), (-5, 4)];
const STAR: &[(i32, i32)] = &[(0, -5), (1, -1), (5, 0), (1, 1), (0, 5), (-1, 1), (-5, 0), (-1, -1)];
const DOWN: &[(i32, i32)] = &[(0, 5), (5, -4), (-5, -4)];

/// For paths, in their order.
pub(super) const MARKS: [Mark; Path::ALL.len()] = [
    Mark { corners: ROUND, filled: true },
    Mark { corners: ROUND, filled: false },
    Mark { corners: SQUARE, filled: false },
    Mark { corners: DIAMOND, filled: true },
    Mark { corners: SQUARE, filled: true },
    Mark { corners: UP, filled: true },
    Mark { corners: UP, filled: false },
    Mark { corners: DOWN, filled: true },
    Mark { corners: STAR, filled: true },
    Mark { corners: DIAMOND, filled: false },
    Mark { corners: DOWN, filled: false },
];

/// For constructions, in their order.
pub(super) const DASHES: [Option<[u32; 2]>; Construction::ALL.len()] = [None, Some([6, 4]), Some([2, 4])];

/// For schemes, in their order; seen on white and on black alike (Okabe and Ito's, a little darker or lighter).
pub(super) const COLOURS: [RGBColor; 7] = [
    RGBColor(0x1f, 0x77, 0xc4),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x0a, 0x9e, 0x73),
    RGBColor(0xc7, 0x66, 0xa5),
    RGBColor(0xc4, 0x90, 0x10),
    RGBColor(0x3a, 0xa0, 0xd8),
    RGBColor(0x9a, 0x6a, 0x4a),
];
/// For floors.
pub(super) const FLOOR: RGBColor = RGBColor(0x88, 0x88, 0x88);

const SIZE: (u32, u32) = (560, 380);

/// A plot with both axes logarithmic.
pub(super) struct Plot<'a> {
    /// Label of the axis along, as [`Plot::y`] of the one upwards.
    pub x: &'a str,
    /// Marks along x; at round numbers if there are none.
    pub marks: &'a [f64],
    pub y: &'a str,
    pub lines: &'a [Line],
    /// Whether the points that no other beats in both are joined.
    pub front: bool,
}

impl Plot<'_> {
    pub(super) fn svg(&self) -> Result<String, CliError> {
        let &Self { x, marks, y, lines, front: has_front } = self;
        let failed = |e: &dyn std::fmt::Display| CliError::Work(format!("the plot of {y} can't be drawn: {e}"));
        load_font();
        let mut svg = String::new();
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        let of = |axis: fn(&(f64, f64)) -> f64| range(lines.iter().flat_map(|line| &line.points).map(axis));
        let (range_x, range_y) = (of(|p| p.0), of(|p| p.1));
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .x_label_area_size(40)
            .y_label_area_size(74)
            .build_cartesian_2d(axis(range_x.clone(), marks), axis(range_y.clone(), &[]))
            .map_err(|e| failed(&e))?;
        let font = (FONT, 13).into_font();
        chart
            .configure_mesh()
            .x_desc(x)
            .y_desc(y)
            .label_style(font.clone())
            .axis_desc_style(font)
            .bold_line_style(BLACK.mix(0.18))
            .light_line_style(TRANSPARENT)
            .x_label_formatter(&|x| short(*x))
            .y_label_formatter(&|y| short(*y))
            .draw()
            .map_err(|e| failed(&e))?;
        if has_front {
            let front = front(lines, &range_x, &range_y);
            chart.draw_series(LineSeries::new(front, BLACK.stroke_width(1))).map_err(|e| failed(&e))?;
        }
        for Line { style: LineStyle { colour, dash, mark, width }, points, .. } in lines {
            let stroke = colour.stroke_width(*width);
            let points = points.iter().copied();
            let drawn = match *dash {
                Some([dash, gap]) => {
                    chart.draw_series(DashedLineSeries::new(points.clone(), dash, gap, stroke)).map(drop)
                }
                None => chart.draw_series(LineSeries::new(points.clone(), stroke)).map(drop),
            };
            drawn.map_err(|e| failed(&e))?;
            let fill = colour.mix(mark.opacity()).filled();
            let outline: Vec<_> = mark.corners.iter().chain(mark.corners.first()).copied().collect();
            let marks = points.map(|at| {
                EmptyElement::at(at)
                    + Polygon::new(mark.corners, fill)
                    + PathElement::new(outline.clone(), colour.stroke_width(2))
            });
            chart.draw_series(marks).map_err(|e| failed(&e))?;
        }
        area.present().map_err(|e| failed(&e))?;
        drop(chart);
        drop(area);
        Ok(self.with_titles(&svg))
    }

    /// With a title for each mark, which are the only polygons.
    fn with_titles(&self, svg: &str) -> String {
        let title = |line: &Line, &(x, y): &(f64, f64)| {
            let text = format!("{}: {} {}, {} {}", line.label, self.x, short(x), self.y, short(y));
            html! { title { (text) } }.into_string()
        };
        let titles = self.lines.iter().flat_map(|line| line.points.iter().map(move |point| title(line, point)));
        let mut marks = svg.split("<polygon");
        let mut titled = marks.next().unwrap_or_default().to_owned();
        for (mark, title) in marks.zip(titles) {
            titled += "<polygon";
            titled += &mark.replacen("/>", &format!(">{title}</polygon>"), 1);
        }
        titled
    }
}

/// From a little below to a little above all values.
fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
    // Where all are the same, or there are none.
    let (low, high) = if low <= high { (low, high) } else { (1.0, 1.0) };
    low / 1.25..high * 1.25
}

/// A logarithmic axis with these marks, or with marks at round numbers: as many as are needed for three, or all there are.
fn axis(range: Range<f64>, given: &[f64]) -> impl Ranged<ValueType = f64, FormatOption = DefaultFormatting> {
    const DECADES: [&[f64]; 4] =
        [&[1.0], &[1.0, 3.0], &[1.0, 2.0, 5.0], &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0]];
    if !given.is_empty() {
        return range.log_scale().with_key_points(given.to_vec());
    }
    let decades = range.start.log10().floor() as i32..=range.end.log10().floor() as i32;
    let marks = |steps: &[f64]| -> Vec<f64> {
        let all = decades.clone().flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)));
        all.filter(|mark| range.contains(mark)).collect()
    };
    let all = DECADES.map(marks);
    let enough = all.iter().find(|marks| marks.len() >= 3).unwrap_or(&all[3]).clone();
    range.log_scale().with_key_points(enough)
}

/// The front of what is worth choosing: through the points that no other is better than in both, from the upper edge of the
/// range of `y` down to the first, and from the last to the right edge of the range of `x`.
fn front(lines: &[Line], x: &Range<f64>, y: &Range<f64>) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = lines.iter().flat_map(|line| &line.points).copied().collect();
    points.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut least = f64::INFINITY;
    points.retain(|&(_, y)| {
        let is_better = y < least;
        least = least.min(y);
        is_better
    });
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return points };
    [(first.0, y.end)].into_iter().chain(points).chain([(x.end, last.1)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(mark: usize, points: &[(f64, f64)]) -> Line {
        let style = LineStyle { colour: COLOURS[0], dash: None, mark: MARKS[mark], width: 2 };
        Line { label: format!("<{mark}>"), style, points: points.to_vec() }
    }

    #[test]
    fn every_point_is_in_the_plot() {
        let lines = [line(0, &[(4.0, 1.0), (8.0, 3.0)]), line(1, &[(4.0, 2.0)])];
        let of = |lines, front| Plot { x: "factor", marks: &[4.0, 8.0], y: "ms", lines, front }.svg().unwrap();
        let svg = of(&lines, false);
        assert_eq!(svg.matches("<polygon").count(), 3);
        assert!(svg.starts_with("<svg") && svg.contains("factor") && svg.trim_end().ends_with("</svg>"));
        assert!(svg.contains("<title>&lt;0&gt;: factor 8, ms 3</title></polygon>"), "{svg}");
        assert_eq!(svg.matches("</title></polygon>").count(), 3);
        assert_eq!(of(&lines, true).matches("#000000").count(), svg.matches("#000000").count() + 1);
        of(&[], true);
    }

    #[test]
    fn fronts_join_what_none_beats() {
        let points = [(4.0, 1.0), (1.0, 9.0), (1.5, 9.0), (2.0, 4.0), (3.0, 5.0), (5.0, 0.5), (1.0, 10.0)];
        let front = front(&[line(0, &points)], &(0.5..8.0), &(0.1..20.0));
        assert_eq!(front, [(1.0, 20.0), (1.0, 9.0), (2.0, 4.0), (4.0, 1.0), (5.0, 0.5), (8.0, 0.5)]);
    }

    #[test]
    fn small_numbers_are_not_nought() {
        let small = [line(0, &[(4.0, 2e-12), (8.0, 9e-11)])];
        let svg = Plot { x: "factor", marks: &[4.0, 8.0], y: "rad", lines: &small, front: false }.svg().unwrap();
        assert!(svg.contains("\n1e-11\n") && !svg.contains("\n0\n"), "{svg}");
    }
}
