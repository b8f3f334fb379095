//! Results as tables of text.

use super::super::error::CliError;
use super::super::output::{Table, with_stdout};
use super::change::{Change, machine};
use super::findings::{Finding, Findings};
use super::presets::{Beside, PresetOut};
use super::recorded::Recorded;
use super::row::{Interval, Row, Times, Who};

/// The rows of one mesh and factor after another.
pub(super) fn rows(rows: &[Row]) -> Result<(), CliError> {
    for group in rows.chunk_by(Row::is_beside) {
        let Row { setting, factor, patches, .. } = &group[0];
        let (mesh, title) = (&setting.mesh, setting.title());
        with_stdout(|out| Ok(writeln!(out, "{mesh}: {patches} patches, factor {factor}, {title}")?))?;
        let mut table = Table::new(&[3, 4, 5, 6, 7, 8, 9, 10]);
        table.row([
            &"scheme",
            &"construction",
            &"path",
            &"triangles",
            &"gpu ms",
            &"x base",
            &"geometry ms",
            &"x base",
            &"construction",
            &"set-up",
            &"KiB",
        ]);
        for row in group {
            table.row([
                &row.who.scheme,
                &row.who.construction,
                &if row.patches == *patches {
                    row.who.path_label()
                } else {
                    format!("{}, {} patches", row.who.path_label(), row.patches)
                },
                &row.triangles.map_or("-".into(), |n| n.to_string()),
                &time(row.gpu_ms),
                &ratio(row.gpu_ratio),
                &time(row.geometry_ms),
                &ratio(row.geometry_ratio),
                &row.construction_ms.map_or("-".into(), |i| format!("{:.2}", i.value)),
                &format!("{:.2}", row.setup_ms),
                &format!("{:.1}", row.total_bytes() as f64 / 1024.0),
            ]);
        }
        table.print()?;
        with_stdout(|out| Ok(writeln!(out)?))?;
    }
    Ok(())
}

fn time(Times { median, mad, .. }: Times) -> String {
    format!("{median:.2} ±{mad:.2}")
}

fn ratio(interval: Option<Interval>) -> String {
    interval.map_or("-".into(), |Interval { value, low, high }| format!("{value:.3} ({low:.2} to {high:.2})"))
}

/// Recordings.
pub(super) fn recording(recording: &[Recorded]) -> Result<(), CliError> {
    if recording.is_empty() {
        return Ok(());
    }
    let mut table = Table::new(&[5, 6, 7, 8]);
    table.row([
        &"recorded",
        &"scheme",
        &"construction",
        &"path",
        &"crowd",
        &"models",
        &"prepare µs",
        &"draw µs",
        &"frame µs",
    ]);
    for Recorded { mesh, who, crowd, models, prepare_ms, draw_ms, frame_ms } in recording {
        let Who { scheme, construction, .. } = who;
        let [prepare, draw, frame] = [prepare_ms, draw_ms, frame_ms].map(|&Times { median, mad, .. }| {
            let [median, mad] = [median, mad].map(|ms| 1e3 * ms);
            format!("{median:.2} ±{mad:.2}")
        });
        table.row([mesh, scheme, construction, &who.path_label(), crowd, models, &prepare, &draw, &frame]);
    }
    table.print()
}

/// Findings over several rows.
pub(super) fn findings(findings: &Findings) -> Result<(), CliError> {
    for (title, list) in findings.lists().into_iter().filter(|(_, list)| !list.is_empty()) {
        let mut table = Table::new(&[4, 5, 6, 7]);
        let bytes = if list[0].bytes.is_some() { "bytes" } else { "" };
        table.row([&title, &"scheme", &"construction", &"path", &"factor", &"geometry", &"gpu", &bytes]);
        for Finding { setting, who, factor, geometry, gpu, bytes } in list {
            table.row([
                &format!("{}, {}", setting.mesh, setting.title()),
                &who.scheme,
                &who.construction,
                &who.path_label(),
                factor,
                geometry,
                gpu,
                &bytes.map_or(String::new(), |power| format!("{power:.2}")),
            ]);
        }
        table.print()?;
        with_stdout(|out| Ok(writeln!(out)?))?;
    }
    Ok(())
}

/// Published figures beside measured ones.
pub(super) fn published(preset: Option<&PresetOut>, beside: &[Beside]) -> Result<(), CliError> {
    let Some(PresetOut { title, note, .. }) = preset else { return Ok(()) };
    with_stdout(|out| Ok(writeln!(out, "{title}\n{note}")?))?;
    if beside.is_empty() {
        return Ok(());
    }
    let mut table = Table::new(&[3, 4, 5, 7, 8]);
    table.row([&"published", &"scheme", &"construction", &"factor", &"figure", &"ratio", &"measured", &"ms", &"ratio"]);
    for line in beside {
        table.row([
            &line.published_mesh,
            &line.scheme,
            &line.construction,
            &line.factor,
            &format!("{} {}", line.figure, line.unit),
            &format!("{:.3}", line.published_ratio),
            &line.mesh,
            &format!("{:.2}", line.ms),
            &format!("{:.3}", line.ratio),
        ]);
    }
    table.print()
}

/// Rows that became faster or slower.
pub(super) fn changes(changes: &[Change]) -> Result<(), CliError> {
    if let Some(machine) = machine(changes) {
        with_stdout(|out| Ok(writeln!(out, "{machine}")?))?;
    }
    let mut table = Table::new(&[4, 6, 7, 8, 9]);
    table.row([
        &"mesh",
        &"scheme",
        &"construction",
        &"path",
        &"factor",
        &"what",
        &"old ms",
        &"new ms",
        &"new / old",
        &"sure",
        &"",
    ]);
    for change in changes {
        table.row([
            &format!("{}, {}", change.setting.mesh, change.setting.title()),
            &change.who.scheme,
            &change.who.construction,
            &change.who.path_label(),
            &change.factor,
            &change.what,
            &format!("{:.2}", change.old_ms),
            &format!("{:.2}", change.new_ms),
            &ratio(Some(change.ratio)),
            &format!("{:.1} %", 100.0 * change.confidence),
            &change.verdict(),
        ]);
    }
    table.print()
}
