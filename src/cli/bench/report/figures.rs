//! Plots of the report, and the style of each contestant in all of them.

use super::super::super::error::CliError;
use super::super::findings::{any_passes, any_sharpness, any_size};
use super::super::results::Results;
use super::super::row::{NONE, Row, Setting, Who};
use super::super::unique;
use super::plots::{COLOURS, DASHES, FLOOR, Line, LineStyle, MARKS, Plot};
use ash_subdiv::bench::{Normals, Path};
use ash_subdiv::measure::statistics::growth;
use ash_subdiv::{Construction, Scheme};
use maud::{Markup, PreEscaped, html};

pub(super) const GEOMETRY: &str = "ms a frame, geometry alone";
const PIXELS: &str = "ms a frame, with pixels";

/// Colours tell schemes apart, marks paths, dashes constructions, widths those with shared normals (wide) and culling (thin).
pub(super) fn style(who: &Who) -> LineStyle {
    let scheme = Scheme::ALL.iter().position(|scheme| scheme.name() == who.scheme);
    let colour = scheme.map_or(FLOOR, |index| COLOURS[index % COLOURS.len()]);
    let construction = Construction::ALL.iter().position(|construction| construction.name() == who.construction);
    let path = Path::ALL.iter().position(|path| path.name() == who.path);
    let dash = construction.and_then(|index| DASHES[index]);
    let width = match (who.normals == Normals::Own.name(), who.cull == NONE) {
        (true, true) => 2,
        (true, false) => 1,
        (false, true) => 4,
        (false, false) => 3,
    };
    LineStyle { colour, dash, mark: MARKS[path.unwrap_or(0)], width }
}

/// A line for each contestant among these rows.
pub(super) fn lines<'r>(rows: &[&'r Row], point: impl Fn(&'r Row) -> Option<(f64, f64)>) -> Vec<Line> {
    let mut lines: Vec<(&Who, Line)> = Vec::new();
    for &row in rows {
        let Some(at) = point(row) else { continue };
        match lines.iter_mut().find(|(who, _)| **who == row.who) {
            Some((_, line)) => line.points.push(at),
            None => lines.push((&row.who, Line { label: row.who.label(), style: style(&row.who), points: vec![at] })),
        }
    }
    for (_, line) in &mut lines {
        line.points.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    }
    lines.into_iter().map(|(_, line)| line).collect()
}

/// Plots with their captions.
struct Figures<'r> {
    results: &'r Results,
    factors: Vec<f32>,
    drawn: Vec<(String, String)>,
}

/// All plots, under a heading; nothing without rows.
pub(super) fn plots(results: &Results) -> Result<Markup, CliError> {
    let rows = &results.rows;
    if rows.is_empty() {
        return Ok(html! {});
    }
    let mut figures = Figures { results, factors: unique(rows, |row| row.factor), drawn: Vec::new() };
    for setting in unique(rows, |row| &row.setting) {
        figures.by_factor(setting)?;
    }
    figures.by_size()?;
    figures.by_passes()?;
    figures.by_sharpness()?;
    let legend = unique(rows, |row| &row.who);
    if figures.drawn.is_empty() {
        return Ok(html! {});
    }
    Ok(html! {
        h2 { "Plots" }
        details { summary { (figures.drawn.len()) " plots of all rows" }
        ul.legend {
            @for who in legend { li { (swatch(style(who))) " " (who.label()) } }
        }
        div.plots {
            @for (caption, svg) in &figures.drawn { figure.plot { figcaption { (caption) } (PreEscaped(svg)) } }
        }
        }
    })
}

impl<'r> Figures<'r> {
    fn add(&mut self, caption: String, plot: &Plot) -> Result<(), CliError> {
        self.drawn.push((caption, plot.svg()?));
        Ok(())
    }

    /// The mesh, and what else there is to say of this setting among the others.
    fn title(&self, setting: &Setting) -> String {
        format!("{}, {}", setting.mesh, setting.title_among(&self.results.rows))
    }

    fn by_factor(&mut self, setting: &Setting) -> Result<(), CliError> {
        if self.factors.len() < 2 {
            return Ok(());
        }
        let of: Vec<&Row> = self.results.rows.iter().filter(|row| row.setting == *setting).collect();
        let marks: Vec<f64> = self.factors.iter().map(|&factor| factor.into()).collect();
        let title = self.title(setting);
        let x = |row: &Row| f64::from(row.factor);
        let geometry = lines(&of, |row| Some((x(row), row.geometry_ms.median)));
        let pixels = lines(&of, |row| Some((x(row), row.gpu_ms.median)));
        for (what, y, lines) in [("geometry", GEOMETRY, geometry), ("with pixels", PIXELS, pixels)] {
            let plot = Plot { x: "factor", marks: &marks, y, lines: &lines, front: false };
            self.add(format!("{title}: {what}"), &plot)?;
        }
        Ok(())
    }

    /// Rows at one factor that are the same in what `same` leaves of their settings, where `x` is not the same of all.
    fn of_several(
        &self,
        same: impl Fn(&Setting) -> Setting,
        x: impl Fn(&Row) -> u64,
    ) -> Vec<(Setting, f32, Vec<&'r Row>)> {
        let rows = &self.results.rows;
        let mut several = Vec::new();
        for setting in unique(rows, |row| same(&row.setting)) {
            for &factor in &self.factors {
                let is_of = |row: &&Row| same(&row.setting) == setting && row.factor == factor;
                let of: Vec<&Row> = rows.iter().filter(is_of).collect();
                if unique(&of, |row| x(row)).len() > 1 {
                    several.push((setting.clone(), factor, of));
                }
            }
        }
        several
    }

    fn by_size(&mut self) -> Result<(), CliError> {
        let meshes = &self.results.meshes;
        let copies = |row: &Row| {
            let mesh = meshes.iter().find(|mesh| mesh.name == row.setting.mesh);
            mesh.map_or(0, |mesh| u64::from(mesh.copies))
        };
        for (setting, factor, rows) in self.of_several(|setting| any_size(setting, meshes), copies) {
            let lines = lines(&rows, |row| Some((row.patches as f64, row.geometry_ms.median)));
            let power = lines.first().and_then(|line| growth(&line.points));
            let power =
                power.map_or_else(String::new, |power| format!(": {} as patches^{power:.2}", rows[0].who.label()));
            let caption = format!("{}: growth at factor {factor}{power}", self.title(&setting));
            self.add(caption, &Plot { x: "patches", marks: &[], y: GEOMETRY, lines: &lines, front: false })?;
        }
        Ok(())
    }

    /// Against the power of two of sharpness: what doubles with each step is a line at 45 degrees.
    fn by_sharpness(&mut self) -> Result<(), CliError> {
        let meshes = &self.results.meshes;
        let power = |row: &Row| {
            let mesh = meshes.iter().find(|mesh| mesh.name == row.setting.mesh);
            mesh.and_then(|mesh| mesh.sharpness).map_or(0.0, |sharpness| f64::from(sharpness).exp2())
        };
        for (setting, factor, rows) in
            self.of_several(|setting| any_sharpness(setting, meshes), |row| power(row).to_bits())
        {
            let marks = unique(&rows, |row| power(row));
            let title = self.title(&setting);
            let times = lines(&rows, |row| Some((power(row), row.geometry_ms.median)));
            let bytes = lines(&rows, |row| Some((power(row), row.total_bytes() as f64 / 1024.0)));
            for (what, y, lines) in [("time", GEOMETRY, times), ("bytes", "KiB", bytes)] {
                let caption = format!("{title}: {what} against sharpness at factor {factor}");
                self.add(caption, &Plot { x: "2^sharpness", marks: &marks, y, lines: &lines, front: false })?;
            }
        }
        Ok(())
    }

    fn by_passes(&mut self) -> Result<(), CliError> {
        let passes = |row: &Row| u64::from(row.setting.passes);
        let marks: Vec<f64> = self.results.options.passes.iter().map(|&passes| passes.into()).collect();
        for (setting, factor, rows) in self.of_several(any_passes, passes) {
            let lines = lines(&rows, |row| Some((passes(row) as f64, row.geometry_ms.median)));
            let caption = format!("{}: time against passes at factor {factor}", self.title(&setting));
            self.add(caption, &Plot { x: "passes", marks: &marks, y: GEOMETRY, lines: &lines, front: false })?;
        }
        Ok(())
    }
}

pub(super) fn swatch(LineStyle { colour, dash, mark, width }: LineStyle) -> Markup {
    let colour = format!("#{:02x}{:02x}{:02x}", colour.0, colour.1, colour.2);
    let dash = dash.map(|[dash, gap]| format!("{dash} {gap}"));
    let corners: Vec<String> = mark.corners.iter().map(|(x, y)| format!("{},{}", 17 + x, 6 + y)).collect();
    html! {
        svg width="34" height="12" aria-hidden="true" {
            line x1="0" y1="6" x2="34" y2="6" stroke=(colour) stroke-width=(width) stroke-dasharray=[dash] {}
            polygon points=(corners.join(" ")) stroke=(colour) stroke-width="2" fill=(colour) fill-opacity=(mark.opacity()) {}
        }
    }
}
