//! Results as tables of text.

use super::super::error::CliError;
use super::super::output::{Table, with_stdout};
use super::compare::Change;
use super::presets::{Beside, Preset};
use super::results::{Interval, Row, Times};
use ash_subdiv::measure::statistics::growth;

/// The rows of one mesh and factor after another.
pub(super) fn rows(rows: &[Row]) -> Result<(), CliError> {
    for group in rows.chunk_by(|a, b| (&a.mesh, &a.spacing, a.factor) == (&b.mesh, &b.spacing, b.factor)) {
        let Row { mesh, spacing, factor, patches, .. } = &group[0];
        with_stdout(|out| Ok(writeln!(out, "{mesh}: {patches} patches, factor {factor}, {spacing} spacing")?))?;
        let mut table = Table::new(&[3, 4, 5, 6, 7, 8, 9]);
        table.row([
            &"scheme",
            &"construction",
            &"path",
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
                &row.scheme,
                &row.construction,
                &row.path,
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

/// How time grows with patches, for each that was measured on meshes of several sizes.
pub(super) fn grown(rows: &[Row]) -> Result<(), CliError> {
    let mut table = Table::new(&[4, 5, 6]);
    table.row([&"time grows as patches^", &"scheme", &"construction", &"path", &"factor", &"geometry", &"gpu"]);
    let mut seen = Vec::new();
    for row in rows {
        let key = |row: &Row| (row.label(), row.spacing.clone(), row.factor.to_string());
        if seen.contains(&key(row)) {
            continue;
        }
        seen.push(key(row));
        let same = rows.iter().filter(|other| key(other) == key(row));
        let points = |ms: fn(&Row) -> f64| same.clone().map(|row| (row.patches as f64, ms(row))).collect::<Vec<_>>();
        let power = |ms| growth(&points(ms)).map(|power| format!("{power:.2}"));
        if let (Some(geometry), Some(gpu)) = (power(|row| row.geometry_ms.median), power(|row| row.gpu_ms.median)) {
            table.row([&row.spacing, &row.scheme, &row.construction, &row.path, &row.factor, &geometry, &gpu]);
        }
    }
    if table.is_empty() { Ok(()) } else { table.print() }
}

/// What a paper published beside what was measured.
pub(super) fn published(preset: Option<&Preset>, beside: &[Beside]) -> Result<(), CliError> {
    let Some(preset) = preset else { return Ok(()) };
    with_stdout(|out| Ok(writeln!(out, "{}\n{}", preset.title, preset.note)?))?;
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

/// What became faster or slower.
pub(super) fn changes(changes: &[Change]) -> Result<(), CliError> {
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
            &change.mesh,
            &change.scheme,
            &change.construction,
            &change.path,
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
