//! What was measured, as it is written to JSON and CSV and read again.

use super::super::error::CliError;
use super::super::parse;
use super::compare::Change;
use super::facts::{DeviceOut, LeftOut, MeshOut, OptionsOut, command_line};
use super::presets::Beside;
use ash_subdiv::Spacing;
use ash_subdiv::bench::{self, BenchOptions, Series, Subject, Subset};
use ash_subdiv::measure::statistics::{self, Estimate, Summary, paired_ratio};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::time::SystemTime;

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Results {
    pub program: String,
    /// As it was typed.
    pub command: String,
    /// When the measurement began, RFC 3339.
    pub measured: String,
    pub device: DeviceOut,
    pub options: OptionsOut,
    pub meshes: Vec<MeshOut>,
    pub rows: Vec<Row>,
    #[serde(default)]
    pub left_out: Vec<LeftOut>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub published: Vec<Beside>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub changes: Option<Vec<Change>>,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Times {
    pub median: f64,
    pub min: f64,
    pub max: f64,
    pub mad: f64,
}

/// An estimate with its interval of 95 %.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Interval {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Row {
    pub mesh: String,
    pub scheme: String,
    pub construction: String,
    pub path: String,
    pub spacing: String,
    pub factor: f32,
    pub patches: u64,
    pub tes_invocations: Option<u64>,
    pub triangles: Option<u64>,
    pub gpu_ms: Times,
    pub geometry_ms: Times,
    pub setup_ms: f64,
    pub bytes: BTreeMap<String, u64>,
    /// To the first row of the mesh and factor, frame by frame.
    pub gpu_ratio: Option<Interval>,
    pub geometry_ratio: Option<Interval>,
    pub construction_ms: Option<Interval>,
    pub tables_ms: f64,
    pub upload_ms: f64,
    pub pipelines_ms: f64,
    pub first_frame_ms: f64,
    pub traffic_bytes: BTreeMap<String, u64>,
    pub fence_ms: BTreeMap<String, Times>,
    /// Every frame that counts.
    pub frames_ms: BTreeMap<String, Vec<f64>>,
}

/// The keys of `frames_ms` and `fence_ms`.
pub(super) const GPU: &str = "gpu";
pub(super) const GEOMETRY: &str = "geometry";

impl Results {
    pub(super) fn new(device: DeviceOut, options: &BenchOptions, patches: Subset) -> Self {
        Self {
            program: format!("subdiv {}", env!("CARGO_PKG_VERSION")),
            command: command_line(std::env::args()),
            measured: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            device,
            options: OptionsOut::new(options, patches),
            meshes: Vec::new(),
            rows: Vec::new(),
            left_out: Vec::new(),
            published: Vec::new(),
            changes: None,
        }
    }

    /// Reads what was written as JSON.
    pub(super) fn read(path: &Path) -> Result<Self, CliError> {
        let named = |message: String| CliError::Work(format!("{}: {message}", path.display()));
        let text = std::fs::read_to_string(path).map_err(|e| named(e.to_string()))?;
        serde_json::from_str(&text).map_err(|e| named(format!("not what `subdiv bench --json` writes: {e}")))
    }

    pub(super) fn write_csv(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record([
            "mesh",
            "scheme",
            "construction",
            "path",
            "spacing",
            "factor",
            "patches",
            "tes_invocations",
            "triangles",
            "gpu_ms_median",
            "gpu_ms_min",
            "gpu_ms_max",
            "geometry_ms_median",
            "geometry_ms_min",
            "geometry_ms_max",
            "setup_ms",
            "bytes",
            "gpu_ratio",
            "geometry_ratio",
            "construction_ms",
            "first_use_ms",
            "traffic_bytes",
        ])?;
        for row in &self.rows {
            let count = |count: Option<u64>| count.map(|n| n.to_string()).unwrap_or_default();
            let value = |interval: Option<Interval>| interval.map(|i| i.value.to_string()).unwrap_or_default();
            let names = [&row.mesh, &row.scheme, &row.construction, &row.path, &row.spacing].map(Clone::clone);
            let numbers =
                [row.factor.to_string(), row.patches.to_string(), count(row.tes_invocations), count(row.triangles)];
            let times = [row.gpu_ms, row.geometry_ms].map(|t| [t.median, t.min, t.max].map(|t| t.to_string()));
            csv.write_record(names.into_iter().chain(numbers).chain(times.into_iter().flatten()).chain([
                row.setup_ms.to_string(),
                row.total_bytes().to_string(),
                value(row.gpu_ratio),
                value(row.geometry_ratio),
                value(row.construction_ms),
                row.first_use_ms().to_string(),
                row.traffic_total().to_string(),
            ]))?;
        }
        Ok(csv.flush()?)
    }
}

/// The key of a map's sum.
const TOTAL: &str = "total";

impl Row {
    /// The rows of one mesh and factor.
    pub(super) fn all(subject: &Subject, spacing: Spacing, rows: Vec<bench::Row>) -> Vec<Self> {
        let base = rows.iter().find(|row| !row.contestant.path.is_floor()).or(rows.first()).cloned();
        rows.into_iter().filter_map(|row| Self::new(subject, spacing, row, base.as_ref()?)).collect()
    }

    /// `None` if no frame counts.
    fn new(subject: &Subject, spacing: Spacing, row: bench::Row, base: &bench::Row) -> Option<Self> {
        let interval = |estimate: Option<Estimate>| estimate.map(Interval::from);
        let traffic = [
            ("tables", row.traffic.tables),
            ("control_points", row.traffic.control_points),
            ("vertices", row.traffic.vertices),
        ];
        let fence = |series: &Series| Times::of(&series.host);
        Some(Self {
            mesh: subject.name.clone(),
            scheme: row.contestant.scheme_name().to_owned(),
            construction: row.contestant.construction_name().to_owned(),
            path: row.contestant.path.name().to_owned(),
            spacing: parse::spacing_name(spacing).to_owned(),
            factor: row.factor,
            patches: row.patches,
            tes_invocations: row.evaluations,
            triangles: row.triangles,
            gpu_ms: Times::of(&row.gpu.device)?,
            geometry_ms: Times::of(&row.geometry.device)?,
            setup_ms: row.setup.per_model(),
            bytes: with_total(&row.bytes),
            gpu_ratio: interval(paired_ratio(&row.gpu.device, &base.gpu.device)),
            geometry_ratio: interval(paired_ratio(&row.geometry.device, &base.geometry.device)),
            construction_ms: interval(row.construction),
            tables_ms: row.setup.tables,
            upload_ms: row.setup.upload,
            pipelines_ms: row.setup.pipelines,
            first_frame_ms: row.setup.first_frame,
            traffic_bytes: with_total(&traffic),
            fence_ms: [(GPU.to_owned(), fence(&row.gpu)?), (GEOMETRY.to_owned(), fence(&row.geometry)?)].into(),
            frames_ms: [(GPU.to_owned(), row.gpu.device), (GEOMETRY.to_owned(), row.geometry.device)].into(),
        })
    }

    pub(super) fn total_bytes(&self) -> u64 {
        self.bytes.get(TOTAL).copied().unwrap_or(0)
    }

    pub(super) fn traffic_total(&self) -> u64 {
        self.traffic_bytes.get(TOTAL).copied().unwrap_or(0)
    }

    pub(super) fn first_use_ms(&self) -> f64 {
        self.pipelines_ms + self.first_frame_ms
    }

    /// What it is, without mesh and factor.
    pub(super) fn label(&self) -> String {
        [&self.scheme, &self.construction, &self.path]
            .into_iter()
            .filter(|s| *s != "none")
            .map(String::as_str)
            .collect::<Vec<_>>()
            .join(" ")
    }

    /// What two runs have in common.
    pub(super) fn key(&self) -> [String; 6] {
        let Self { mesh, scheme, construction, path, spacing, factor, .. } = self.clone();
        [mesh, scheme, construction, path, spacing, factor.to_string()]
    }
}

fn with_total(bytes: &[(&str, u64)]) -> BTreeMap<String, u64> {
    let total = (TOTAL, bytes.iter().map(|(_, bytes)| bytes).sum());
    bytes.iter().copied().chain([total]).map(|(name, bytes)| (name.to_owned(), bytes)).collect()
}

impl Times {
    fn of(values: &[f64]) -> Option<Self> {
        let Summary { median, min, max, mad } = Summary::of(values)?;
        Some(Self { median, min, max, mad })
    }
}

impl From<Estimate> for Interval {
    fn from(Estimate { value, low, high }: statistics::Estimate) -> Self {
        Self { value, low, high }
    }
}
