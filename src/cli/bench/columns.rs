//! Results as comma-separated values.

use super::super::error::CliError;
use super::recorded::Recorded;
use super::results::Results;
use super::row::{GPU, Interval, Row};
use std::io::Write;

type Columns<T> = [(&'static str, fn(&T) -> String)];

const OF_ROWS: &Columns<Row> = &[
    ("mesh", |row| row.setting.mesh.clone()),
    ("scheme", |row| row.who.scheme.clone()),
    ("construction", |row| row.who.construction.clone()),
    ("path", |row| row.who.path.clone()),
    ("normals", |row| row.who.normals.clone()),
    ("cull", |row| row.who.cull.clone()),
    ("spacing", |row| row.setting.spacing.clone()),
    ("motion", |row| row.setting.motion.clone()),
    ("view", |row| row.setting.view.clone()),
    ("passes", |row| row.setting.passes.to_string()),
    ("factor", |row| row.factor.to_string()),
    ("patches", |row| row.patches.to_string()),
    ("tes_invocations", |row| count(row.tes_invocations)),
    ("compute_invocations", |row| count(row.compute_invocations)),
    ("triangles", |row| count(row.triangles)),
    ("visible_triangles", |row| count(row.visible_triangles)),
    ("gpu_ms_median", |row| row.gpu_ms.median.to_string()),
    ("gpu_ms_min", |row| row.gpu_ms.min.to_string()),
    ("gpu_ms_max", |row| row.gpu_ms.max.to_string()),
    ("gpu_ms_mad", |row| row.gpu_ms.mad.to_string()),
    ("geometry_ms_median", |row| row.geometry_ms.median.to_string()),
    ("geometry_ms_min", |row| row.geometry_ms.min.to_string()),
    ("geometry_ms_max", |row| row.geometry_ms.max.to_string()),
    ("geometry_ms_mad", |row| row.geometry_ms.mad.to_string()),
    ("setup_ms", |row| row.setup_ms.to_string()),
    ("bytes", |row| row.total_bytes().to_string()),
    ("gpu_ratio", |row| of(row.gpu_ratio, |i| i.value)),
    ("gpu_ratio_low", |row| of(row.gpu_ratio, |i| i.low)),
    ("gpu_ratio_high", |row| of(row.gpu_ratio, |i| i.high)),
    ("geometry_ratio", |row| of(row.geometry_ratio, |i| i.value)),
    ("geometry_ratio_low", |row| of(row.geometry_ratio, |i| i.low)),
    ("geometry_ratio_high", |row| of(row.geometry_ratio, |i| i.high)),
    ("construction_ms", |row| of(row.construction_ms, |i| i.value)),
    ("fence_ms_median", |row| row.fence_ms.get(GPU).map_or_else(String::new, |times| times.median.to_string())),
    ("tables_ms", |row| row.tables_ms.to_string()),
    ("upload_ms", |row| row.upload_ms.to_string()),
    ("first_use_ms", |row| row.first_use_ms().to_string()),
    ("traffic_bytes", |row| row.traffic_total().to_string()),
];

const OF_RECORDINGS: &Columns<Recorded> = &[
    ("mesh", |recorded| recorded.mesh.clone()),
    ("scheme", |recorded| recorded.who.scheme.clone()),
    ("construction", |recorded| recorded.who.construction.clone()),
    ("path", |recorded| recorded.who.path.clone()),
    ("normals", |recorded| recorded.who.normals.clone()),
    ("cull", |recorded| recorded.who.cull.clone()),
    ("crowd", |recorded| recorded.crowd.clone()),
    ("models", |recorded| recorded.models.to_string()),
    ("prepare_ms_median", |recorded| recorded.prepare_ms.median.to_string()),
    ("draw_ms_median", |recorded| recorded.draw_ms.median.to_string()),
    ("frame_ms_median", |recorded| recorded.frame_ms.median.to_string()),
    ("frame_ms_min", |recorded| recorded.frame_ms.min.to_string()),
    ("frame_ms_max", |recorded| recorded.frame_ms.max.to_string()),
];

fn count(count: Option<u64>) -> String {
    count.map(|n| n.to_string()).unwrap_or_default()
}

fn of(interval: Option<Interval>, number: fn(Interval) -> f64) -> String {
    interval.map(|interval| number(interval).to_string()).unwrap_or_default()
}

/// A line for each row, or for each recording if that was measured.
pub(super) fn write_csv(results: &Results, out: &mut dyn Write) -> Result<(), CliError> {
    match results.recording.as_slice() {
        [] => write(OF_ROWS, &results.rows, out),
        recording => write(OF_RECORDINGS, recording, out),
    }
}

fn write<T>(columns: &Columns<T>, lines: &[T], out: &mut dyn Write) -> Result<(), CliError> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(columns.iter().map(|(name, _)| name))?;
    for line in lines {
        csv.write_record(columns.iter().map(|(_, of)| of(line)))?;
    }
    Ok(csv.flush()?)
}
