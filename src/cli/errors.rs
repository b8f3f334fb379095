//! `subdiv error`: how far schemes are from the limit surface.

use super::error::CliError;
use super::output::{self, Progress, Table};
use super::parse;
use super::source::SourceArgs;
use ash_subdiv::Scheme;
use ash_subdiv::measure::{Deviation, ErrorOptions, ErrorReport, FaceErrors, SchemeError, surface_errors};
use clap::Args;
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Debug, Args)]
#[command(after_help = NOTES)]
pub(super) struct ErrorArgs {
    #[command(flatten)]
    mesh: SourceArgs,
    /// A scheme to measure; may be given several times. All that have patches for the mesh if not given.
    #[arg(long, value_name = "SCHEME", value_parser = parse::scheme())]
    scheme: Vec<Scheme>,
    /// Samples along each side of a face.
    #[arg(long, value_name = "N", default_value_t = 33, value_parser = clap::value_parser!(u32).range(1..=1025))]
    samples: u32,
    /// Samples over the whole of each surface for the distance to the nearest point; 0 leaves it out.
    #[arg(long, value_name = "N", default_value_t = 60_000, value_parser = clap::value_parser!(u32).range(0..=100_000_000))]
    nearest: u32,
    /// Write comma-separated values, one line for each scheme and set of faces.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
}

const NOTES: &str = "\
position: distance between the points at the same (u, v); on triangles that is a convention.
nearest:  distance to the nearest point of the other surface, both ways, as a dense mesh of triangles.
normal:   angle between the normals at the same (u, v), in radians.
Distances are over the diagonal of the control mesh's bounding box; rms is weighted by area.

Examples:
  subdiv error --shape creature
  subdiv error model.obj --scheme gregory --scheme acc --samples 17 --json";

#[derive(Serialize)]
struct ReportOut {
    mesh: String,
    diagonal: f64,
    area: f64,
    samples: u32,
    nearest_samples: u32,
    patches: usize,
    irregular_patches: usize,
    schemes: BTreeMap<&'static str, SchemeOut>,
    /// Schemes that have no patches for the mesh, and why.
    undefined: BTreeMap<&'static str, String>,
}

#[derive(Serialize)]
struct SchemeOut {
    #[serde(flatten)]
    all: ErrorsOut,
    irregular: Option<ErrorsOut>,
    /// Faces measured with the patches of the fallback.
    fallen_back: usize,
}

#[derive(Serialize)]
struct ErrorsOut {
    position_rms: f64,
    position_rms_per_sample: f64,
    position_max: f64,
    nearest_rms: Option<f64>,
    nearest_rms_per_sample: Option<f64>,
    nearest_max: Option<f64>,
    normal_rms: f64,
    normal_rms_per_sample: f64,
    normal_max: f64,
}

impl From<FaceErrors> for ErrorsOut {
    fn from(errors: FaceErrors) -> Self {
        let FaceErrors { position, nearest, normal } = errors;
        Self {
            position_rms: position.rms,
            position_rms_per_sample: position.rms_per_sample,
            position_max: position.max,
            nearest_rms: nearest.map(|d| d.rms),
            nearest_rms_per_sample: nearest.map(|d| d.rms_per_sample),
            nearest_max: nearest.map(|d| d.max),
            normal_rms: normal.rms,
            normal_rms_per_sample: normal.rms_per_sample,
            normal_max: normal.max,
        }
    }
}

pub(super) fn run(args: &ErrorArgs, json: bool) -> Result<(), CliError> {
    let progress = Progress::new("reading the mesh");
    let mesh = args.mesh.load()?;
    let mut schemes = Vec::new();
    for &scheme in if args.scheme.is_empty() { &Scheme::ALL[..] } else { &args.scheme } {
        if !schemes.contains(&scheme) {
            schemes.push(scheme);
        }
    }
    progress.now("measuring");
    let options = ErrorOptions {
        fallback: args.mesh.fallback(),
        refine: args.mesh.refine,
        samples: args.samples,
        nearest: args.nearest,
    };
    let report = surface_errors(&mesh, &schemes, &options)?;
    drop(progress);
    let undefined = report.schemes.iter().filter_map(|(_, result)| result.as_ref().err());
    if !args.scheme.is_empty()
        && let Some(error) = undefined.clone().next()
    {
        return Err(CliError::Work(error.to_string()));
    }
    if json {
        return output::json_pretty(&out(args, &report));
    }
    if args.csv {
        print_csv(&report)?
    } else {
        print_table(&report)?
    }
    undefined.for_each(output::note);
    Ok(())
}

fn measured(report: &ErrorReport) -> impl Iterator<Item = (Scheme, &SchemeError)> {
    report.schemes.iter().filter_map(|(scheme, result)| Some((*scheme, result.as_ref().ok()?)))
}

fn out(args: &ErrorArgs, report: &ErrorReport) -> ReportOut {
    let scheme = |error: &SchemeError| SchemeOut {
        all: error.all.into(),
        irregular: error.irregular.map(Into::into),
        fallen_back: error.fallen_back,
    };
    let undefined =
        report.schemes.iter().filter_map(|(s, result)| Some((s.name(), result.as_ref().err()?.to_string())));
    ReportOut {
        mesh: args.mesh.name(),
        diagonal: report.diagonal,
        area: report.area,
        samples: args.samples,
        nearest_samples: args.nearest,
        patches: report.patches,
        irregular_patches: report.irregular_patches,
        schemes: measured(report).map(|(s, error)| (s.name(), scheme(error))).collect(),
        undefined: undefined.collect(),
    }
}

/// Each scheme over all faces and over irregular ones, each with its number of faces.
fn rows(report: &ErrorReport) -> impl Iterator<Item = (Scheme, &'static str, FaceErrors)> {
    measured(report).flat_map(|(scheme, error)| {
        let irregular = error.irregular.map(|errors| (scheme, "irregular", errors));
        std::iter::once((scheme, "all", error.all)).chain(irregular)
    })
}

fn print_csv(report: &ErrorReport) -> Result<(), CliError> {
    output::with_stdout(|out| {
        writeln!(
            out,
            "scheme,faces,position_rms,position_max,nearest_rms,nearest_max,normal_rms,normal_max,\
             position_rms_per_sample,nearest_rms_per_sample,normal_rms_per_sample"
        )?;
        for (scheme, faces, FaceErrors { position, nearest, normal }) in rows(report) {
            let near =
                |value: fn(&Deviation) -> f64| nearest.as_ref().map(|d| value(d).to_string()).unwrap_or_default();
            let (near_rms, near_max, near_each) = (near(|d| d.rms), near(|d| d.max), near(|d| d.rms_per_sample));
            let (name, p, n) = (scheme.name(), position, normal);
            write!(out, "{name},{faces},{},{},{near_rms},{near_max},{},{},", p.rms, p.max, n.rms, n.max)?;
            writeln!(out, "{},{near_each},{}", p.rms_per_sample, n.rms_per_sample)?;
        }
        Ok(())
    })
}

fn print_table(report: &ErrorReport) -> Result<(), CliError> {
    let mut table = Table::new(&[2, 3, 4, 5, 6, 7]);
    table.row([&"scheme", &"faces", &"position", &"max", &"nearest", &"max", &"normal", &"max"]);
    for (scheme, faces, FaceErrors { position, nearest, normal }) in rows(report) {
        let distance = |d: f64| format!("{d:.3e}");
        let near = |value: fn(Deviation) -> f64| nearest.map_or("-".into(), |d| distance(value(d)));
        table.row([
            &scheme.name(),
            &faces,
            &distance(position.rms),
            &distance(position.max),
            &near(|d| d.rms),
            &near(|d| d.max),
            &format!("{:.5}", normal.rms),
            &format!("{:.5}", normal.max),
        ]);
    }
    table.print()?;
    let (patches, irregular) = (report.patches, report.irregular_patches);
    output::with_stdout(|out| {
        writeln!(out, "{patches} faces, {irregular} irregular; diagonal {}", report.diagonal)?;
        for (scheme, error) in measured(report).filter(|(_, error)| error.fallen_back > 0) {
            let (name, faces) = (scheme.name(), error.fallen_back);
            writeln!(
                out,
                "{name} has no patches for {faces} of the irregular faces: those of the fallback are measured"
            )?;
        }
        Ok(())
    })
}
