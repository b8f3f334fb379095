//! The front of the report: the fastest for each accuracy, and what it costs.

use super::super::super::error::CliError;
use super::super::facts::MeshOut;
use super::super::results::Results;
use super::super::row::{Row, Setting};
use super::super::unique;
use super::figures::{GEOMETRY, lines, style, swatch};
use super::plots::{FLOOR, Plot};
use crate::cli::output::short;
use ash_subdiv::bench::Normals;
use maud::{Markup, PreEscaped, html};

const NORMAL_ERROR: &str = "error of the normal, rms, rad";

/// A row whose surface is known to be this far from the limit surface.
#[derive(Clone, Copy)]
struct Point<'r> {
    row: &'r Row,
    /// Root mean square over the diagonal, if it is known.
    position: Option<f64>,
    /// Root mean square, in radians.
    normal: f64,
}

impl Point<'_> {
    fn ms(&self) -> f64 {
        self.row.geometry_ms.median
    }
}

/// What was raced in one setting at one factor, and those that none beats in both time and error.
struct Front<'r> {
    setting: &'r Setting,
    factor: f32,
    points: Vec<Point<'r>>,
    /// From the fastest to the closest.
    best: Vec<Point<'r>>,
}

impl<'r> Front<'r> {
    /// `None` where no error is known.
    fn new(results: &'r Results, mesh: &MeshOut, setting: &'r Setting, factor: f32) -> Option<Self> {
        let rows = results.rows.iter().filter(|row| row.setting == *setting && row.factor == factor);
        // Normals that patches share are others.
        let rows = rows.filter(|row| row.who.normals == Normals::Own.name());
        let point = |row: &'r Row| {
            let surface = row.who.surface();
            let normal = *mesh.normal_error.get(&surface)?;
            Some(Point { row, position: mesh.position_error.get(&surface).copied(), normal })
        };
        let points: Vec<_> = rows.filter_map(point).filter(|point| point.normal > 0.0).collect();
        let mut best = points.clone();
        best.sort_by(|a, b| a.ms().total_cmp(&b.ms()).then(a.normal.total_cmp(&b.normal)));
        let mut least = f64::INFINITY;
        best.retain(|point| {
            let is_closer = point.normal < least;
            least = least.min(point.normal);
            is_closer
        });
        (!best.is_empty()).then_some(Self { setting, factor, points, best })
    }

    /// The answer in words.
    fn answer(&self) -> Markup {
        let (first, last) = (self.best[0], self.best[self.best.len() - 1]);
        let who = |point: Point| html! { b { (point.row.who.label()) } };
        html! {
            p {
                (who(first)) " is the fastest: " (short(first.ms())) " ms a frame, normals off by "
                (short(first.normal)) " rad."
                @if self.best.len() > 1 {
                    " " (who(last)) " is the closest: by a factor of " (short(first.normal / last.normal)) ", in "
                    (format!("{:.2}", last.ms() / first.ms())) " times the time."
                }
            }
        }
    }

    fn table(&self) -> Markup {
        let fastest = self.best[0].ms();
        let error = |error: Option<f64>| html! { td { (error.map_or_else(String::new, short)) } };
        html! {
            div.wide { table {
                thead { tr {
                    @for head in [
                        "", "normal, rad", "position / diagonal", "geometry ms", "× fastest", "pixels ms", "set-up ms", "KiB",
                    ] { th scope="col" { (head) } }
                } }
                tbody { @for point @ &Point { row, position, normal } in &self.best { tr {
                    th scope="row" { (swatch(style(&row.who))) " " (row.who.label()) }
                    (error(Some(normal))) (error(position))
                    td { (format!("{:.2}", point.ms())) } td { (format!("{:.2}", point.ms() / fastest)) }
                    td { (format!("{:.2}", row.gpu_ms.median)) } td { (format!("{:.2}", row.setup_ms)) }
                    td { (format!("{:.1}", row.total_bytes() as f64 / 1024.0)) }
                } } }
            } }
        }
    }

    /// Error against time: the fewer milliseconds and the smaller the error, the better.
    fn plot(&self) -> Result<String, CliError> {
        let rows: Vec<&Row> = self.points.iter().map(|point| point.row).collect();
        let mut lines = lines(&rows, |row| {
            let point = self.points.iter().find(|point| std::ptr::eq(point.row, row))?;
            Some((point.ms(), point.normal))
        });
        let is_best = |label: &str| self.best.iter().any(|point| point.row.who.label() == label);
        for line in lines.iter_mut().filter(|line| !is_best(&line.label)) {
            line.style.colour = FLOOR;
        }
        // Those that matter lie on top.
        lines.sort_by_key(|line| is_best(&line.label));
        Plot { x: GEOMETRY, marks: &[], y: NORMAL_ERROR, lines: &lines, front: true }.svg()
    }
}

/// The fastest for each accuracy of each mesh, at the middle one of the factors in the first setting; further settings and
/// factors on demand. Nothing where no errors are known.
pub(super) fn front(results: &Results) -> Result<Markup, CliError> {
    let factors = unique(&results.rows, |row| row.factor);
    let Some(&middle) = factors.get(factors.len() / 2) else { return Ok(html! {}) };
    let (mut first, mut further) = (Vec::new(), Vec::new());
    for mesh in &results.meshes {
        let settings = unique(&results.rows, |row| &row.setting);
        let settings = settings.into_iter().filter(|setting| setting.mesh == mesh.name).enumerate();
        for (i, setting) in settings {
            for front in factors.iter().filter_map(|&factor| Front::new(results, mesh, setting, factor)) {
                let is_middle = front.factor == middle;
                let shown = shown(results, &front, is_middle)?;
                if i == 0 && is_middle { first.push(shown) } else { further.push(shown) }
            }
        }
    }
    Ok(html! {
        @if !first.is_empty() {
            h2 { "The fastest for each accuracy" }
            p {
                "On " (results.device.name) ", of all that was raced: none is both faster and closer to the limit surface. Times are \
                 of geometry alone; errors are root mean squares, of the surface and not of its triangles."
            }
            @for front in first { (front) }
            @if !further.is_empty() {
                details { summary { "Other factors and settings" } @for front in further { (front) } }
            }
        }
    })
}

/// A front, with its plot if asked for.
fn shown(results: &Results, front: &Front, with_plot: bool) -> Result<Markup, CliError> {
    let (setting, factor) = (front.setting, front.factor);
    let title = format!("{}, {}", setting.mesh, setting.title_among(&results.rows));
    let svg = if with_plot { Some(front.plot()?) } else { None };
    Ok(html! {
        h3 { (title) ", factor " (factor) }
        (front.answer())
        div.front {
            (front.table())
            @if let Some(svg) = svg {
                figure.plot {
                    figcaption {
                        (title) ": error against time at factor " (factor) "; the thin line joins what none beats in both"
                    }
                    (PreEscaped(svg))
                }
            }
        }
    })
}
