//! The page itself.

use super::super::super::error::CliError;
use super::super::change::machine;
use super::super::facts::{MeshOut, left_out_by_reason};
use super::super::findings::Findings;
use super::super::recorded::Recorded;
use super::super::results::Results;
use super::super::row::{Interval, Row, Times};
use super::{figures, front};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

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

fn rows(results: &Results) -> Markup {
    let milliseconds = |ms: f64| html! { td { (format!("{ms:.2}")) } };
    let count = |count: Option<u64>| html! { td { (count.map_or_else(String::new, |n| n.to_string())) } };
    html! {
        @for group in results.rows.chunk_by(Row::is_beside) {
            h3 { (group[0].setting.mesh) ", factor " (group[0].factor) ", " (group[0].setting.title()) }
            div.wide { table {
                thead { tr {
                    @for head in [
                        "", "gpu ms", "× base", "geometry ms", "× base", "fence ms", "construction ms",
                    ] { th scope="col" { (head) } }
                } }
                tbody { @for row in group { tr {
                    th scope="row" { (row.who.label()) }
                    (time(row.gpu_ms)) (ratio(row.gpu_ratio))
                    (time(row.geometry_ms)) (ratio(row.geometry_ratio))
                    (time(row.fence_ms.gpu))
                    td { (row.construction_ms.map_or_else(String::new, |i| format!("{:.2}", i.value))) }
                } } }
            } }
            div.wide { table {
                thead { tr {
                    @for head in [
                        "", "tables ms", "upload ms", "first use ms", "KiB", "traffic KiB", "patches", "evaluations", "compute",
                        "triangles", "visible",
                    ] { th scope="col" { (head) } }
                } }
                tbody { @for row in group { tr {
                    th scope="row" { (row.who.label()) }
                    (milliseconds(row.tables_ms)) (milliseconds(row.upload_ms)) (milliseconds(row.first_use_ms()))
                    td { (format!("{:.1}", row.total_bytes() as f64 / 1024.0)) }
                    td { (format!("{:.1}", row.traffic_total() as f64 / 1024.0)) }
                    td { (row.patches) }
                    (count(row.tes_invocations)) (count(row.compute_invocations)) (count(row.triangles))
                    (count(row.visible_triangles))
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
                    @for head in ["", "", "crowd", "models", "prepare µs", "draw µs", "frame µs"] { th scope="col" { (head) } }
                } }
                tbody { @for r in recording { tr {
                    th scope="row" { (r.mesh) }
                    td { (r.who.label()) } td { (r.crowd) } td { (r.models) }
                    (microseconds(r.prepare_ms)) (microseconds(r.draw_ms)) (microseconds(r.frame_ms))
                } } }
            } }
        }
    }
}

fn changes(results: &Results) -> Markup {
    let Some(changes) = &results.changes else { return html! {} };
    html! {
        h2 { "What changed" }
        @if let Some(machine) = machine(changes) { p { (machine) } }
        div.wide { table {
            thead { tr { @for head in ["", "factor", "", "old ms", "new ms", "new / old", "sure", ""] { th scope="col" { (head) } } } }
            tbody { @for c in changes { tr class=(c.verdict().replace(' ', "-")) {
                th scope="row" { (c.setting.mesh) ", " (c.setting.title()) ": " (c.who.label()) }
                td { (c.factor) } td { (c.what) }
                td { (format!("{:.2}", c.old_ms)) } td { (format!("{:.2}", c.new_ms)) }
                (ratio(Some(c.ratio)))
                td { (format!("{:.1} %", 100.0 * c.confidence)) } td { (c.verdict()) }
            } } }
        } }
    }
}

fn published(results: &Results) -> Markup {
    let Some(preset) = &results.preset else { return html! {} };
    html! {
        h2 { "Published figures" }
        p { b { (preset.title) } br; (preset.note) }
        @if !results.published.is_empty() {
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
