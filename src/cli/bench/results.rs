//! Results, as they are written to JSON and read again.

use super::super::described::described;
use super::super::error::CliError;
use super::super::output;
use super::change::Change;
use super::facts::{DeviceOut, LeftOut, MeshOut, OptionsOut, command_line, left_out_by_reason};
use super::findings::Findings;
use super::presets::{Beside, PresetOut};
use super::recorded::Recorded;
use super::row::{GEOMETRY, GPU, Row, Times};
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::Path;
use std::time::SystemTime;

described! {
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
        #[serde(flatten)]
        pub findings: Findings,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub recording: Vec<Recorded>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub preset: Option<PresetOut>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub published: Vec<Beside>,
        /// Changes from other results: not read again.
        #[serde(default, skip_deserializing, skip_serializing_if = "Option::is_none")]
        pub changes: Option<Vec<Change>>,
    }
}

impl Results {
    pub(super) fn new(device: DeviceOut, options: OptionsOut, meshes: Vec<MeshOut>) -> Self {
        Self {
            program: format!("subdiv {}", env!("CARGO_PKG_VERSION")),
            command: command_line(std::env::args()),
            measured: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            device,
            options,
            meshes,
            rows: Vec::new(),
            left_out: Vec::new(),
            findings: Findings::default(),
            recording: Vec::new(),
            preset: None,
            published: Vec::new(),
            changes: None,
        }
    }

    /// Notes on contestants that are left out, from the `told`th on.
    pub(super) fn left_out_notes(&self, told: usize) -> Vec<String> {
        left_out_by_reason(&self.left_out, told, 3)
    }

    /// Writes a line of comma-separated values for each row, or for each recording if that was measured.
    pub(super) fn write_csv(&self, out: &mut dyn Write) -> Result<(), CliError> {
        match self.recording.as_slice() {
            [] => output::csv(&self.rows, out),
            recording => output::csv(recording, out),
        }
    }

    /// Reads what was written as JSON.
    pub(super) fn read(path: &Path) -> Result<Self, CliError> {
        let named = |message: String| CliError::Work(format!("{}: {message}", path.display()));
        let text = std::fs::read_to_string(path).map_err(|e| named(unread(&e)))?;
        let not_ours = |why: String| named(format!("not what `subdiv bench --json` writes: {why}"));
        let results: Self = serde_json::from_str(&text).map_err(|e| not_ours(e.to_string()))?;
        results.check().map_err(not_ours)?;
        Ok(results)
    }

    /// Checks that there are rows, and that times are times.
    fn check(&self) -> Result<(), String> {
        if self.rows.is_empty() && self.recording.is_empty() {
            return Err("it has no rows".into());
        }
        let is_time = |ms: &f64| *ms > 0.0 && ms.is_finite();
        for (number, recorded) in self.recording.iter().enumerate() {
            // There may be nothing to prepare.
            let prepared = recorded.prepare_ms.all().iter().all(|ms| *ms == 0.0 || is_time(ms));
            if !prepared || ![recorded.frame_ms, recorded.draw_ms].iter().flat_map(Times::all).all(|ms| is_time(&ms)) {
                let who = recorded.who.label();
                return Err(format!("recording {} ({who}): a time of it is not above 0", number + 1));
            }
        }
        for (number, row) in self.rows.iter().enumerate() {
            let wrong = |what: &str| Err(format!("row {} ({}): {what}", number + 1, row.who.label()));
            if !(row.factor >= 1.0 && row.factor.is_finite()) {
                return wrong("its factor is not from 1 up");
            }
            let times = [row.gpu_ms, row.geometry_ms];
            let frames = || [GPU, GEOMETRY].into_iter().map(|what| row.frames(what));
            if frames().any(<[f64]>::is_empty) {
                return wrong("it has no frames");
            }
            if !times.iter().flat_map(Times::all).chain(frames().flatten().copied()).all(|ms| is_time(&ms)) {
                return wrong("a time of it is not above 0");
            }
        }
        Ok(())
    }
}

/// Why a file could not be read.
fn unread(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".into(),
        std::io::ErrorKind::IsADirectory => "this is a folder: name a file".into(),
        _ => error.to_string(),
    }
}
