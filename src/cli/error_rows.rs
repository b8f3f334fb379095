//! The surfaces that `subdiv error` measures: schemes, and schemes by depth of adaptive subdivision.

use super::described::described;
use super::error::CliError;
use super::errors::ErrorsOut;
use super::output::{self, Table};
use super::source::SourceArgs;
use ash_subdiv::adaptive::{AdaptiveError, AdaptiveOptions, LevelCounts};
use ash_subdiv::measure::{Deviation, ErrorOptions, ErrorReport, FaceErrors, SchemeError, surface_errors};
use ash_subdiv::renderer::ModelTables;
use ash_subdiv::{Construction, ControlMesh, ModelOptions, Scheme};
use serde::Serialize;

/// A surface, its errors and what it costs.
pub(super) struct Row {
    pub scheme: Scheme,
    pub adaptive: Option<AdaptiveOptions>,
    pub error: SchemeError,
    /// Patches that are drawn.
    pub patches: usize,
    /// Leaves of adaptive subdivision.
    pub leaves: Option<usize>,
    /// Of the two-stage construction.
    pub table_bytes: u64,
}

impl Row {
    fn new(
        source: &SourceArgs,
        mesh: &ControlMesh,
        (scheme, error): (Scheme, &SchemeError),
        options: &ErrorOptions,
    ) -> Result<Self, CliError> {
        let &ErrorOptions { refine, adaptive, .. } = options;
        let options = ModelOptions { refine, adaptive, ..source.model_options(scheme, Construction::TwoStage) };
        let tables = ModelTables::new(mesh, &options)?;
        Ok(Self {
            scheme,
            adaptive,
            error: *error,
            patches: tables.plan().patches().len(),
            leaves: tables.leaves().map(|table| table.counts.iter().map(LevelCounts::leaves).sum()),
            table_bytes: tables.bytes().iter().map(|(_, bytes)| bytes).sum(),
        })
    }

    /// Name of the surface: of the scheme, and the depth.
    pub(super) fn name(&self) -> String {
        let scheme = self.scheme.name();
        match self.adaptive {
            None => scheme.into(),
            Some(AdaptiveOptions { depth, sharp_depth: None, .. }) => format!("{scheme} depth {depth}"),
            Some(AdaptiveOptions { depth, sharp_depth: Some(sharp), .. }) => {
                format!("{scheme} depth {depth} sharp {sharp}")
            }
        }
    }
}

/// The schemes of a report, which has patches for them.
pub(super) fn of_schemes(
    source: &SourceArgs,
    mesh: &ControlMesh,
    report: &ErrorReport,
    options: &ErrorOptions,
) -> Result<Vec<Row>, CliError> {
    let measured = report.schemes.iter().filter_map(|(scheme, error)| Some((*scheme, error.as_ref().ok()?)));
    measured.map(|measured| Row::new(source, mesh, measured, options)).collect()
}

/// Those of the schemes that have end caps, at each of the depths.
pub(super) fn of_depths(
    source: &SourceArgs,
    mesh: &ControlMesh,
    schemes: &[Scheme],
    depths: &[AdaptiveOptions],
    options: &ErrorOptions,
) -> Result<Vec<Row>, CliError> {
    let with_caps: Vec<Scheme> = schemes.iter().copied().filter(|scheme| scheme.has_caps()).collect();
    if let (false, [], &[scheme, ..]) = (depths.is_empty(), &with_caps[..], schemes) {
        return Err(AdaptiveError::NoCaps { scheme }.into());
    }
    let mut rows = Vec::new();
    for &depth in depths {
        let options = ErrorOptions { adaptive: Some(depth), ..*options };
        let report = surface_errors(mesh, &with_caps, &options)?;
        rows.extend(of_schemes(source, mesh, &report, &options)?);
    }
    rows.sort_by_key(|row| with_caps.iter().position(|&scheme| scheme == row.scheme));
    Ok(rows)
}

described! {
    /// A line of comma-separated values.
    #[derive(Serialize)]
    struct Line {
        scheme: String,
        faces: &'static str,
        #[serde(flatten)]
        errors: ErrorsOut,
        leaves: Option<usize>,
        table_bytes: u64,
    }
}

/// Each surface over all faces and over irregular ones.
fn by_faces(rows: &[Row]) -> impl Iterator<Item = (&Row, &'static str, FaceErrors)> {
    rows.iter().flat_map(|row| {
        let irregular = row.error.irregular.map(|errors| (row, "irregular", errors));
        std::iter::once((row, "all", row.error.all)).chain(irregular)
    })
}

pub(super) fn print_csv(rows: &[Row]) -> Result<(), CliError> {
    let line = |(row, faces, errors): (&Row, _, FaceErrors)| {
        let &Row { leaves, table_bytes, .. } = row;
        Line { scheme: row.name(), faces, errors: errors.into(), leaves, table_bytes }
    };
    let lines: Vec<Line> = by_faces(rows).map(line).collect();
    output::with_stdout(|out| output::csv(&lines, out))
}

pub(super) fn print_table(report: &ErrorReport, rows: &[Row]) -> Result<(), CliError> {
    let mut table = Table::new(&[2, 3, 4, 5, 6, 7, 8]);
    table.row([&"scheme", &"faces", &"position", &"max", &"nearest", &"max", &"normal", &"max", &"bytes"]);
    for (row, faces, FaceErrors { position, nearest, normal }) in by_faces(rows) {
        let distance = |d: f64| format!("{d:.3e}");
        let near = |value: fn(Deviation) -> f64| nearest.map_or("-".into(), |d| distance(value(d)));
        table.row([
            &row.name(),
            &faces,
            &distance(position.rms),
            &distance(position.max),
            &near(|d| d.rms),
            &near(|d| d.max),
            &format!("{:.5}", normal.rms),
            &format!("{:.5}", normal.max),
            &row.table_bytes,
        ]);
    }
    table.print()?;
    let (patches, irregular) = (report.patches, report.irregular_patches);
    output::with_stdout(|out| {
        write!(out, "{patches} faces, {irregular} irregular; diagonal {}", report.diagonal)?;
        if let Some(floor) = report.nearest_floor {
            write!(out, "; nearest of the exact surface itself {}", output::short(floor.rms))?;
        }
        writeln!(out)?;
        for row in rows.iter().filter(|row| row.error.fallen_back > 0) {
            let (name, faces) = (row.name(), row.error.fallen_back);
            writeln!(
                out,
                "{name} has no patches for {faces} of the irregular faces: those of the fallback are measured"
            )?;
        }
        Ok(())
    })
}
