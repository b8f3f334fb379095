//! What was measured, as it is written to JSON and CSV and read again.

use super::super::error::CliError;
use super::super::parse;
use super::compare::Change;
use super::presets::Beside;
use ash_subdiv::bench::{self, BenchOptions, Contestant, Series, Subject, Subset};
use ash_subdiv::gpu::DeviceProperties;
use ash_subdiv::measure::statistics::{self, Estimate, Summary, paired_ratio};
use ash_subdiv::topology::PatchKind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
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

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct DeviceOut {
    pub name: String,
    pub driver: String,
    pub driver_info: String,
    pub vulkan: String,
    /// Nanoseconds a tick.
    pub timestamp_period: f32,
    /// Of this machine, for drivers that draw on the CPU.
    pub processors: usize,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct OptionsOut {
    pub size: [u32; 2],
    pub instances: u32,
    pub passes: u32,
    pub frames: u32,
    pub warm_up: u32,
    pub patches: String,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct MeshOut {
    pub name: String,
    pub vertices: usize,
    pub faces: usize,
    /// Those that are drawn, by kind.
    pub patches: BTreeMap<String, u32>,
    /// Of each scheme: root mean square of the angle to the limit surface's normal, in radians. Measured for reports.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub normal_error: BTreeMap<String, f64>,
    /// A picture as a `data:` address. Made for reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thumbnail: Option<String>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct LeftOut {
    pub mesh: String,
    pub scheme: String,
    pub construction: String,
    pub path: String,
    pub spacing: String,
    /// All if none.
    pub factor: Option<f32>,
    pub why: String,
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
            options: OptionsOut {
                size: options.size,
                instances: options.instances,
                passes: options.passes,
                frames: options.frames,
                warm_up: options.warm_up,
                patches: patches.name().to_owned(),
            },
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
    pub(super) fn all(subject: &Subject, spacing: ash_subdiv::Spacing, rows: Vec<bench::Row>) -> Vec<Self> {
        let base = rows.iter().find(|row| !row.contestant.path.is_floor()).or(rows.first()).cloned();
        rows.into_iter().filter_map(|row| Self::new(subject, spacing, row, base.as_ref()?)).collect()
    }

    /// `None` if no frame counts.
    fn new(subject: &Subject, spacing: ash_subdiv::Spacing, row: bench::Row, base: &bench::Row) -> Option<Self> {
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

impl DeviceOut {
    pub(super) fn new(properties: &DeviceProperties) -> Self {
        let version = properties.api_version;
        let [major, minor, patch] = [version >> 22 & 0x7f, version >> 12 & 0x3ff, version & 0xfff];
        Self {
            name: properties.name.clone(),
            driver: properties.driver_name.clone(),
            driver_info: properties.driver_info.clone(),
            vulkan: format!("{major}.{minor}.{patch}"),
            timestamp_period: properties.timestamp_period,
            processors: std::thread::available_parallelism().map_or(0, usize::from),
        }
    }
}

impl MeshOut {
    pub(super) fn new(subject: &Subject) -> Self {
        let patches = PatchKind::ALL.map(|kind| (kind.name().to_owned(), subject.patch_count(kind)));
        Self {
            name: subject.name.clone(),
            vertices: subject.mesh.vertex_count(),
            faces: subject.mesh.face_count(),
            patches: patches.into(),
            normal_error: BTreeMap::new(),
            thumbnail: None,
        }
    }
}

impl LeftOut {
    pub(super) fn new(
        subject: &Subject,
        contestant: Contestant,
        spacing: ash_subdiv::Spacing,
        factor: Option<f32>,
        why: &bench::BenchError,
    ) -> Self {
        Self {
            mesh: subject.name.clone(),
            scheme: contestant.scheme_name().to_owned(),
            construction: contestant.construction_name().to_owned(),
            path: contestant.path.name().to_owned(),
            spacing: parse::spacing_name(spacing).to_owned(),
            factor,
            why: why.to_string(),
        }
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mesh, scheme, construction, path, factor, why, .. } = self;
        write!(f, "{mesh}: {scheme} {construction} {path}")?;
        if let Some(factor) = factor {
            write!(f, " at factor {factor}")?;
        }
        write!(f, " is left out: {why}")
    }
}

/// The arguments as a shell would take them.
fn command_line(arguments: impl Iterator<Item = String>) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:+@%".contains(c);
    let quote = |argument: String| match !argument.is_empty() && argument.chars().all(plain) {
        true => argument,
        false => format!("'{}'", argument.replace('\'', "'\\''")),
    };
    let mut arguments = arguments;
    // Not where the program lies, which is nobody's business.
    arguments.next();
    ["subdiv".to_owned()].into_iter().chain(arguments.map(quote)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_can_be_typed_again() {
        let arguments = ["/x/subdiv", "bench", "a b.obj", "--factors", "4,8", "it's", ""];
        let line = command_line(arguments.into_iter().map(str::to_owned));
        assert_eq!(line, r"subdiv bench 'a b.obj' --factors 4,8 'it'\''s' ''");
    }
}
