//! The page itself.

use super::super::super::error::CliError;
use super::super::facts::MeshOut;
use super::super::findings::Findings;
use super::super::recorded::Recorded;
use super::super::results::{GPU, Interval, NONE, Results, Row, Setting, Times, Who};
use super::super::unique;
use super::plots::{COLOURS, DASHES, FLOOR, Line, LineStyle, MARKS, plot};
use ash_subdiv::bench::{Normals, Path};
use ash_subdiv::measure::statistics::growth;
use ash_subdiv::{Construction, Scheme};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// What the axis of tessellation factors says.
const FACTOR: &str = "factor";
const STYLE: &str = include_str!("style.css");

pub(super) fn page(results: &Results, csv: &[u8], json: &str) -> Result<String, CliError> {
    let data = |kind: &str, bytes: &[u8]| format!("data:{kind};base64,{}", BASE64_STANDARD.encode(bytes));
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "subdiv bench: " (results.device.name) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { "subdiv bench" }
                (facts(results))
                h2 { "Meshes" }
                div.meshes { @for mesh in &results.meshes { (picture(mesh)) } }
                (plots(results)?)
                (findings(&results.findings))
                (recording(&results.recording))
                (changes(results))
                (published(results))
                h2 { "Rows" }
                (rows(results))
                @if !results.left_out.is_empty() {
                    h3 { "Left out" }
                    ul { @for left in &results.left_out { li { (left) } } }
                }
                h2 { "What was measured" }
                (PreEscaped(METHOD))
                h2 { "Raw numbers" }
                p {
                    a download="results.json" href=(data("application/json", json.as_bytes())) { "results.json" }
                    " holds every frame; "
                    a download="results.csv" href=(data("text/csv", csv)) { "results.csv" }
                    " a line for each row."
                }
                details { summary { "results.csv" } pre { (String::from_utf8_lossy(csv)) } }
            }
        }
    };
    Ok(page.into_string())
}

fn facts(results: &Results) -> Markup {
    let Results { device, options, .. } = results;
    let [width, height] = options.size;
    html! {
        dl {
            dt { "Device" } dd { (device.name) ", Vulkan " (device.vulkan) }
            dt { "Driver" } dd { (device.driver) " " (device.driver_info) }
            dt { "Processors" } dd { (device.processors) " of this machine" }
            dt { "Measured" } dd { (results.measured) ", " (results.program) }
            dt { "Frames" }
            dd {
                (options.frames) " of each row, after " (options.warm_up) " that do not count; "
                (width) " x " (height) " pixels"
                @if options.instances > 1 { "; " (options.instances) " instances" }
                @if options.patches != "all" { "; " (options.patches) " patches only" }
            }
            dt { "Command" } dd { code { (results.command) } }
        }
    }
}

fn picture(mesh: &MeshOut) -> Markup {
    let patches: Vec<String> = mesh
        .patches
        .iter()
        .filter(|(_, n)| **n > 0)
        .map(|(kind, n)| format!("{}: {n}", kind.replace('_', " ")))
        .collect();
    html! {
        figure {
            @if let Some(thumbnail) = &mesh.thumbnail { img src=(thumbnail) width="160" height="160" alt=(mesh.name); }
            figcaption { b { (mesh.name) } br; (mesh.vertices) " vertices" br; "patches " (patches.join(", ")) }
        }
    }
}

/// The same for a contestant in all plots: colours tell schemes apart, marks paths, dashes constructions, widths those with
/// shared normals (wide) and culling (thin).
fn style(who: &Who) -> LineStyle {
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
fn lines<'r>(rows: &[&'r Row], point: impl Fn(&'r Row) -> Option<(f64, f64)>) -> Vec<Line> {
    let mut lines: Vec<(&Who, Line)> = Vec::new();
    for &row in rows {
        let Some(at) = point(row) else { continue };
        match lines.iter_mut().find(|(who, _)| **who == row.who) {
            Some((_, line)) => line.points.push(at),
            None => lines.push((&row.who, Line { style: style(&row.who), points: vec![at] })),
        }
    }
    for (_, line) in &mut lines {
        line.points.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    }
    lines.into_iter().map(|(_, line)| line).collect()
}

fn plots(results: &Results) -> Result<Markup, CliError> {
    let rows = &results.rows;
    let mut figures: Vec<(String, String)> = Vec::new();
    let factors = unique(rows, |row| row.factor);
    let marks: Vec<f64> = factors.iter().map(|&factor| factor.into()).collect();
    let mut add = |title: String, x: &str, y: &str, lines: Vec<Line>| -> Result<(), CliError> {
        let marks = if x == FACTOR { &marks[..] } else { &[] };
        figures.push((title, plot(x, marks, y, &lines)?));
        Ok(())
    };
    let (geometry, gpu) = ("ms a frame, geometry alone", "ms a frame, with pixels");
    for setting in unique(rows, |row| &row.setting) {
        let Setting { mesh, .. } = setting;
        let of: Vec<&Row> = rows.iter().filter(|row| row.setting == *setting).collect();
        if factors.len() > 1 {
            let x = |row: &Row| f64::from(row.factor);
            let title = format!("{mesh}, {}", setting.title());
            add(
                format!("{title}: geometry"),
                FACTOR,
                geometry,
                lines(&of, |row| Some((x(row), row.geometry_ms.median))),
            )?;
            add(format!("{title}: with pixels"), FACTOR, gpu, lines(&of, |row| Some((x(row), row.gpu_ms.median))))?;
        }
        let errors = results.meshes.iter().find(|m| m.name == *mesh).map(|m| &m.normal_error);
        if let Some(errors) = errors.filter(|errors| errors.values().any(|&e| e > 0.0)) {
            // The front of what is worth choosing: the fewer milliseconds and the smaller the error, the better.
            let own = |row: &Row| row.who.normals == Normals::Own.name();
            let error = |row: &Row| errors.get(&row.who.scheme).copied().filter(|&e| e > 0.0 && own(row));
            let factor = factors[factors.len() / 2];
            let of: Vec<&Row> = of.into_iter().filter(|row| row.factor == factor).collect();
            let points = lines(&of, |row| Some((row.geometry_ms.median, error(row)?)));
            add(
                format!("{mesh}: error against time at factor {factor}"),
                geometry,
                "error of the normal, rms, rad",
                points,
            )?;
        }
    }
    let like_the_first = |row: &&Row| {
        let first = &rows[0].setting;
        row.setting == Setting { mesh: row.setting.mesh.clone(), ..first.clone() }
    };
    let of_sizes: Vec<&Row> = rows.iter().filter(like_the_first).collect();
    if of_sizes.iter().any(|row| row.patches != of_sizes[0].patches) {
        for factor in factors {
            let of: Vec<&Row> = of_sizes.iter().copied().filter(|row| row.factor == factor).collect();
            let points = lines(&of, |row| Some((row.patches as f64, row.geometry_ms.median)));
            let power = points.first().and_then(|line| growth(&line.points));
            let power =
                power.map_or_else(String::new, |power| format!(": {} as patches^{power:.2}", of[0].who.label()));
            add(format!("Growth at factor {factor}{power}"), "patches", geometry, points)?;
        }
    }
    let legend = unique(rows, |row| &row.who);
    Ok(html! {
        h2 { "Plots" }
        ul.legend {
            @for who in legend { li { (swatch(style(who))) " " (who.label()) } }
        }
        div.plots {
            @for (title, svg) in &figures { figure.plot { figcaption { (title) } (PreEscaped(svg)) } }
        }
    })
}

fn swatch(LineStyle { colour, dash, mark, width }: LineStyle) -> Markup {
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

fn time(Times { median, min, max, .. }: Times) -> Markup {
    html! { td title=(format!("{min:.3} to {max:.3}")) { (format!("{median:.2}")) } }
}

fn ratio(interval: Option<Interval>) -> Markup {
    match interval {
        Some(Interval { value, low, high }) => html! {
            td { (format!("{value:.3}")) " " small { (format!("{low:.2}–{high:.2}")) } }
        },
        None => html! { td {} },
    }
}

fn rows(results: &Results) -> Markup {
    let milliseconds = |ms: f64| html! { td { (format!("{ms:.2}")) } };
    html! {
        @for group in results.rows.chunk_by(Row::is_beside) {
            h3 { (group[0].setting.mesh) ", factor " (group[0].factor) ", " (group[0].setting.title()) }
            div.wide { table {
                thead { tr {
                    @for head in [
                        "", "gpu ms", "× base", "geometry ms", "× base", "fence ms", "construction ms", "tables ms",
                        "upload ms", "first use ms", "KiB", "traffic KiB", "patches", "evaluations", "triangles",
                    ] { th scope="col" { (head) } }
                } }
                tbody { @for row in group { tr {
                    th scope="row" { (row.who.label()) }
                    (time(row.gpu_ms)) (ratio(row.gpu_ratio))
                    (time(row.geometry_ms)) (ratio(row.geometry_ratio))
                    @if let Some(&fence) = row.fence_ms.get(GPU) { (time(fence)) } @else { td {} }
                    td { (row.construction_ms.map_or_else(String::new, |i| format!("{:.2}", i.value))) }
                    (milliseconds(row.tables_ms)) (milliseconds(row.upload_ms)) (milliseconds(row.first_use_ms()))
                    td { (format!("{:.1}", row.total_bytes() as f64 / 1024.0)) }
                    td { (format!("{:.1}", row.traffic_total() as f64 / 1024.0)) }
                    td { (row.patches) }
                    td { (row.tes_invocations.map_or_else(String::new, |n| n.to_string())) }
                    td { (row.triangles.map_or_else(String::new, |n| n.to_string())) }
                } } }
            } }
        }
    }
}

fn findings(findings: &Findings) -> Markup {
    html! {
        @for (title, list) in findings.lists().into_iter().filter(|(_, list)| !list.is_empty()) {
            h3 { (title) }
            div.wide { table {
                thead { tr { @for head in ["", "", "factor", "geometry", "gpu", "bytes"] { th scope="col" { (head) } } } }
                tbody { @for f in list { tr {
                    th scope="row" { (f.setting.mesh) ", " (f.setting.title()) }
                    td { (f.who.label()) } td { (f.factor) } td { (f.geometry) } td { (f.gpu) }
                    td { (f.bytes.map_or_else(String::new, |power| format!("{power:.2}"))) }
                } } }
            } }
        }
    }
}

fn recording(recording: &[Recorded]) -> Markup {
    html! {
        @if !recording.is_empty() {
            h2 { "What the host takes to record a frame" }
            div.wide { table {
                thead { tr {
                    @for head in ["", "", "crowd", "models", "prepare ms", "draw ms", "frame ms"] { th scope="col" { (head) } }
                } }
                tbody { @for r in recording { tr {
                    th scope="row" { (r.mesh) }
                    td { (r.who.label()) } td { (r.crowd) } td { (r.models) }
                    (time(r.prepare_ms)) (time(r.draw_ms)) (time(r.frame_ms))
                } } }
            } }
        }
    }
}

fn changes(results: &Results) -> Markup {
    let Some(changes) = &results.changes else { return html! {} };
    html! {
        h2 { "What changed" }
        div.wide { table {
            thead { tr { @for head in ["", "factor", "", "old ms", "new ms", "new / old", "sure", ""] { th scope="col" { (head) } } } }
            tbody { @for c in changes { tr class=(c.verdict().replace(' ', "-")) {
                th scope="row" { (c.setting.mesh) ": " (c.who.label()) }
                td { (c.factor) } td { (c.what) }
                td { (format!("{:.2}", c.old_ms)) } td { (format!("{:.2}", c.new_ms)) }
                (ratio(Some(c.ratio)))
                td { (format!("{:.1} %", 100.0 * c.confidence)) } td { (c.verdict()) }
            } } }
        } }
    }
}

fn published(results: &Results) -> Markup {
    if results.published.is_empty() {
        return html! {};
    }
    html! {
        h2 { "Published figures beside these" }
        p { "Ratios of times, each to the first line of its mesh." }
        div.wide { table {
            thead { tr {
                @for head in ["published", "scheme", "construction", "factor", "figure", "ratio", "measured", "ms", "ratio"] {
                    th scope="col" { (head) }
                }
            } }
            tbody { @for line in &results.published { tr {
                th scope="row" { (line.published_mesh) }
                td { (line.scheme) } td { (line.construction) } td { (line.factor) }
                td { (line.figure) " " (line.unit) } td { (format!("{:.3}", line.published_ratio)) }
                td { (line.mesh) } td { (format!("{:.2}", line.ms)) } td { (format!("{:.3}", line.ratio)) }
            } } }
        } }
    }
}

const METHOD: &str = "<ul>
<li><b>gpu</b>: milliseconds of a frame on the device by its timestamps, from the first command to the last: clearing,
control points, drawing with pixels. The median; the range is under the pointer.</li>
<li><b>geometry</b>: the same with the rasterizer switched off.</li>
<li><b>fence</b>: a frame with pixels on the host's clock: recording, submission, and the wait for the fence.</li>
<li><b>× base</b>: the median of the ratios to the first row of the table, frame by frame, and the interval that holds it
at 95 %. Rows of a table draw in turns, so that a machine that becomes slower does so for all.</li>
<li><b>construction</b>: making the control points alone, as geometry at factor 1 less the bilinear floor at factor 1.</li>
<li><b>tables</b>, <b>upload</b>: what each model needs before its first frame. <b>first use</b>: pipelines, and the first
frame with them; drivers may find them compiled on the disk.</li>
<li><b>KiB</b>: everything that drawing reads. <b>traffic</b>: what a frame moves, counted as if there were no caches.</li>
<li><b>views</b>: of each, the time of a triangle that clipping leaves, over that in the first. <b>passes</b>: where the
times of evaluating once by compute and of tessellating in every pass cross. <b>growth</b>: the power of patches. Each with
the interval that holds it at 95 %; <b>more</b> is more than what was measured can tell.</li>
<li>Floors: <b>bilinear</b> passes the corners of faces through the tessellation stages at the same factors;
<b>vertex-buffer</b> draws triangles that were evaluated before. With pixels they are no floors in the strict sense: the
bilinear one draws the control mesh, which is larger than the surface.</li>
</ul>";
