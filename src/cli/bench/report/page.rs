//! The page itself.

use super::super::super::error::CliError;
use super::super::change::{Change, machine};
use super::super::facts::{MeshOut, left_out_by_reason};
use super::super::findings::{Finding, Findings};
use super::super::presets::Beside;
use super::super::recorded::Recorded;
use super::super::results::Results;
use super::super::row::{Interval, Row, Times};
use super::{figures, front};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, Render, html};

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
                (front::front(results)?)
                h2 { "Conditions" }
                (facts(results))
                h2 { "Meshes" }
                div.meshes { @for mesh in &results.meshes { (picture(mesh)) } }
                (findings(&results.findings))
                (recording(&results.recording))
                (changes(results))
                (published(results))
                (figures::plots(results)?)
                @if !results.rows.is_empty() {
                    h2 { "Rows" }
                    details { summary { "All " (results.rows.len()) " rows" } (rows(results)) }
                }
                @if !results.left_out.is_empty() {
                    h3 { "Left out" }
                    ul { @for left in left_out_by_reason(&results.left_out, 0, usize::MAX) { li { (left) } } }
                }
                h2 { "What was measured" }
                (PreEscaped(METHOD))
                h2 { "Raw numbers" }
                p {
                    a download="results.json" href=(data("application/json", json.as_bytes())) { "results.json" }
                    " holds every frame; "
                    a download="results.csv" href=(data("text/csv", csv)) { "results.csv" }
                    " a line for each row or recording."
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

/// A column of a table: its head, and the cell of a row.
type Column<R> = (&'static str, fn(&R) -> Markup);

/// Rows with their classes; the first cell of each heads it.
fn table<R>(rows: &[R], class: fn(&R) -> Option<String>, columns: &[Column<R>]) -> Markup {
    html! {
        div.wide { table {
            thead { tr { @for (head, _) in columns { th scope="col" { (head) } } } }
            tbody { @for row in rows { tr class=[class(row)] { @for (_, cell) in columns { (cell(row)) } } } }
        } }
    }
}

fn no_class<R>(_: &R) -> Option<String> {
    None
}

fn head(text: impl Render) -> Markup {
    html! { th scope="row" { (text) } }
}

fn cell(text: impl Render) -> Markup {
    html! { td { (text) } }
}

/// A number with two digits after the point.
fn hundredths(x: f64) -> Markup {
    cell(format!("{x:.2}"))
}

fn count(count: Option<u64>) -> Markup {
    cell(count.map_or_else(String::new, |n| n.to_string()))
}

fn kibibytes(bytes: u64) -> Markup {
    cell(format!("{:.1}", bytes as f64 / 1024.0))
}

fn time(times: Times) -> Markup {
    spread(times, 1.0)
}

fn microseconds(times: Times) -> Markup {
    spread(times, 1e3)
}

/// Times in a unit of which a millisecond has `scale`.
fn spread(Times { median, min, max, mad }: Times, scale: f64) -> Markup {
    let [median, min, max, mad] = [median, min, max, mad].map(|ms| format!("{:.2}", scale * ms));
    html! { td title=(format!("{min} to {max}")) { (median) " " small { "±" (mad) } } }
}

fn ratio(interval: Option<Interval>) -> Markup {
    match interval {
        Some(Interval { value, low, high }) => html! {
            td { (format!("{value:.3}")) " " small { (format!("{low:.2}–{high:.2}")) } }
        },
        None => html! { td {} },
    }
}

const TIMES: [Column<Row>; 7] = [
    ("", |row| head(row.who.label())),
    ("gpu ms", |row| time(row.gpu_ms)),
    ("× base", |row| ratio(row.gpu_ratio)),
    ("geometry ms", |row| time(row.geometry_ms)),
    ("× base", |row| ratio(row.geometry_ratio)),
    ("fence ms", |row| time(row.fence_ms.gpu)),
    ("construction ms", |row| cell(row.construction_ms.map_or_else(String::new, |i| format!("{:.2}", i.value)))),
];

const COSTS: [Column<Row>; 11] = [
    ("", |row| head(row.who.label())),
    ("tables ms", |row| hundredths(row.tables_ms)),
    ("upload ms", |row| hundredths(row.upload_ms)),
    ("first use ms", |row| hundredths(row.first_use_ms())),
    ("KiB", |row| kibibytes(row.total_bytes())),
    ("traffic KiB", |row| kibibytes(row.traffic_total())),
    ("patches", |row| cell(row.patches)),
    ("evaluations", |row| count(row.tes_invocations)),
    ("compute", |row| count(row.compute_invocations)),
    ("triangles", |row| count(row.triangles)),
    ("visible", |row| count(row.visible_triangles)),
];

fn rows(results: &Results) -> Markup {
    html! {
        @for group in results.rows.chunk_by(Row::is_beside) {
            h3 { (group[0].setting.mesh) ", factor " (group[0].factor) ", " (group[0].setting.title()) }
            (table(group, no_class, &TIMES))
            (table(group, no_class, &COSTS))
        }
    }
}

const FINDINGS: [Column<Finding>; 6] = [
    ("", |f| head(html! { (f.setting.mesh) ", " (f.setting.title()) })),
    ("", |f| cell(f.who.label())),
    ("factor", |f| cell(f.factor)),
    ("geometry", |f| cell(f.geometry.to_string())),
    ("gpu", |f| cell(f.gpu.to_string())),
    ("bytes", |f| cell(f.bytes.map_or_else(String::new, |power| format!("{power:.2}")))),
];

fn findings(findings: &Findings) -> Markup {
    html! {
        @for (title, list) in findings.lists().into_iter().filter(|(_, list)| !list.is_empty()) {
            h3 { (title) }
            (table(list, no_class, &FINDINGS))
        }
    }
}

const RECORDING: [Column<Recorded>; 7] = [
    ("", |r| head(&r.mesh)),
    ("", |r| cell(r.who.label())),
    ("crowd", |r| cell(&r.crowd)),
    ("models", |r| cell(r.models)),
    ("prepare µs", |r| microseconds(r.prepare_ms)),
    ("draw µs", |r| microseconds(r.draw_ms)),
    ("frame µs", |r| microseconds(r.frame_ms)),
];

fn recording(recording: &[Recorded]) -> Markup {
    html! {
        @if !recording.is_empty() {
            h2 { "What the host takes to record a frame" }
            (table(recording, no_class, &RECORDING))
        }
    }
}

const CHANGES: [Column<Change>; 8] = [
    ("", |c| head(html! { (c.setting.mesh) ", " (c.setting.title()) ": " (c.who.label()) })),
    ("factor", |c| cell(c.factor)),
    ("", |c| cell(&c.what)),
    ("old ms", |c| hundredths(c.old_ms)),
    ("new ms", |c| hundredths(c.new_ms)),
    ("new / old", |c| ratio(Some(c.ratio))),
    ("sure", |c| cell(format!("{:.1} %", 100.0 * c.confidence))),
    ("", |c| cell(c.verdict())),
];

fn changes(results: &Results) -> Markup {
    let Some(changes) = &results.changes else { return html! {} };
    html! {
        h2 { "What changed" }
        @if let Some(machine) = machine(changes) { p { (machine) } }
        (table(changes, |change| Some(change.verdict().replace(' ', "-")), &CHANGES))
    }
}

const PUBLISHED: [Column<Beside>; 9] = [
    ("published", |line| head(&line.published_mesh)),
    ("scheme", |line| cell(&line.scheme)),
    ("construction", |line| cell(&line.construction)),
    ("factor", |line| cell(line.factor)),
    ("figure", |line| cell(html! { (line.figure) " " (line.unit) })),
    ("ratio", |line| cell(format!("{:.3}", line.published_ratio))),
    ("measured", |line| cell(&line.mesh)),
    ("ms", |line| hundredths(line.ms)),
    ("ratio", |line| cell(format!("{:.3}", line.ratio))),
];

fn published(results: &Results) -> Markup {
    let Some(preset) = &results.preset else { return html! {} };
    html! {
        h2 { "Published figures" }
        p { b { (preset.title) } br; (preset.note) }
        @if !results.published.is_empty() {
            p { "Ratios of times, each to the first line of its mesh." }
            (table(&results.published, no_class, &PUBLISHED))
        }
    }
}

const METHOD: &str = "<ul>
<li><b>gpu</b>: milliseconds of a frame on the device by its timestamps, from the first command to the last: clearing,
control points, drawing with pixels, of all passes and instances. The median, with the median distance from it; the range is under the
pointer.</li>
<li><b>geometry</b>: the same with the rasterizer switched off.</li>
<li><b>fence</b>: a frame with pixels on the host's clock: recording, submission, and the wait for the fence.</li>
<li><b>× base</b>: the median of the ratios to the first row of the table, frame by frame, and the interval that holds it
at 95 %. Rows of a table draw in turns, so that a machine that becomes slower does so for all.</li>
<li><b>construction</b>: making the control points alone, as geometry at factor 1 less the bilinear floor at factor 1, of
paths with the tessellation stages.</li>
<li><b>tables</b>, <b>upload</b>: what each model needs before its first frame, the median of several times. <b>first
use</b>: pipelines, and the first frame with them; drivers may find them compiled on the disk.</li>
<li><b>KiB</b>: everything that drawing reads. <b>traffic</b>: what a frame moves, counted as if there were no caches.
<b>evaluations</b>, <b>compute</b>: invocations of evaluation and compute shaders in a frame.</li>
<li><b>sure</b>: that the frames of both runs differ, whatever made them. It holds the noise within each run, not the drift
of the machine between them; the floors, which no change of the program makes faster or slower, show that: <b>faster</b>
and <b>slower</b> are rows whose interval is wholly outside of what the intervals of all floors reach, <b>as the machine</b> those
that differ by no more. Few floors reach less far than a machine may drift: the more factors, the surer.</li>
<li><b>views</b>: of each, the time of a triangle that clipping leaves, over that in the first. <b>passes</b>: where the
times of evaluating once by compute and of tessellating in every pass cross. <b>growth</b>: the power of patches, over copies of a
mesh. Each with
the interval that holds it at 95 %; <b>more</b> is more than what was measured can tell.</li>
<li>Floors: <b>bilinear</b> passes the corners of faces through the tessellation stages at the same factors;
<b>vertex-buffer</b> draws triangles that were evaluated before. With pixels they are no floors in the strict sense: the
bilinear one draws the control mesh, which is larger than the surface.</li>
</ul>";
