//! `subdiv error`: how far schemes are from the limit surface.

use super::described::{described, help};
use super::error::CliError;
use super::error_rows::{Row, of_depths, of_schemes, print_csv, print_table};
use super::output::{self, Progress};
use super::plot::{self, Curve, CurvePoint, Figure};
use super::source::SourceArgs;
use super::{parse, published};
use ash_subdiv::adaptive::AdaptiveOptions;
use ash_subdiv::measure::{ErrorOptions, ErrorReport, FaceErrors, surface_errors};
use ash_subdiv::{ControlMesh, Scheme};
use clap::Args;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
#[command(after_help = help::<ReportOut>(NOTES, EXAMPLES))]
pub(super) struct ErrorArgs {
    #[command(flatten)]
    mesh: SourceArgs,
    /// A scheme to measure; may be given several times. All that have patches for the mesh if not given.
    #[arg(long, value_name = "SCHEME", value_parser = parse::one_of(Scheme::ALL, Scheme::name))]
    scheme: Vec<Scheme>,
    /// Depths of adaptive subdivision to measure too, of the schemes gregory and gregory-fitted, or gregory alone if no --scheme is
    /// given; several with commas between. --adaptive adds one.
    #[arg(long, value_name = "DEPTH", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(0..=10))]
    depths: Vec<u32>,
    /// Samples along each side of a face.
    #[arg(long, value_name = "N", default_value_t = 33, value_parser = clap::value_parser!(u32).range(1..=1025))]
    samples: u32,
    /// Samples over the whole of each surface for the distance to the nearest point; 0 measures none.
    #[arg(long, value_name = "N", default_value_t = 60_000, value_parser = clap::value_parser!(u32).range(0..=100_000_000))]
    nearest: u32,
    /// Write comma-separated values, one line for each scheme and set of faces.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Refine the mesh uniformly, 0, 1, .. times, and plot the errors against patches and bytes of tables, with a curve of the
    /// depths beside them: PREFIX.svg and PREFIX.png.
    #[arg(long, value_name = "PREFIX")]
    plot: Option<PathBuf>,
    /// With --plot: how many times the mesh is refined at most.
    #[arg(long, value_name = "STEPS", default_value_t = 3, requires = "plot", value_parser = clap::value_parser!(u32).range(0..=6))]
    plot_steps: u32,
    /// Print what Loop et al. (2009) published for the monster frog or bigguy beside the figures of here.
    #[arg(long, conflicts_with_all = ["csv", "json"])]
    published: bool,
}

const NOTES: &str = "\
position: distance between the points at the same (u, v); on triangles that is a convention.
nearest:  distance to the nearest point of the other surface, both ways, as a dense mesh of triangles.
normal:   angle between the normals at the same (u, v), in radians.
Distances are over the diagonal of the control mesh's bounding box; rms is weighted by area.

";

const EXAMPLES: &str = "\
.

Examples:
  subdiv error --shape creature
  subdiv error model.obj --scheme gregory --scheme acc --samples 17 --json
  subdiv error model.obj --depths 0,1,2,3,5 --scheme gregory
  subdiv error model.obj --plot errors --depths 0,1,2,3";

described! {
    #[derive(Serialize)]
    struct ReportOut {
        mesh: String,
        diagonal: f64,
        area: f64,
        samples: u32,
        nearest_samples: u32,
        /// Error of the limit surface itself.
        nearest_floor_rms: Option<f64> = "measured of the exact surface itself",
        patches: usize,
        irregular_patches: usize,
        /// By depth, too.
        schemes: BTreeMap<String, SchemeOut> = "with --depths also NAME depth DEPTH",
        /// Schemes that have no patches for the mesh, and why.
        undefined: BTreeMap<&'static str, String> = "schemes without patches for the mesh, and why",
        /// Errors that are plotted: the mesh refined 0, 1, .. times more.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        refinements: Vec<RefinementOut> = "with --plot",
    }
}

described! {
    #[derive(Serialize)]
    struct RefinementOut {
        refine: u32,
        samples: u32,
        nearest_floor_rms: Option<f64>,
        patches: usize,
        schemes: BTreeMap<String, RefinedSchemeOut>,
    }
}

described! {
    #[derive(Serialize)]
    struct RefinedSchemeOut {
        #[serde(flatten)]
        all: ErrorsOut,
        table_bytes: u64,
    }
}

described! {
    #[derive(Serialize)]
    struct SchemeOut {
        #[serde(flatten)]
        all: ErrorsOut,
        irregular: Option<ErrorsOut>,
        /// Faces measured with the patches of the fallback.
        fallen_back: usize,
        /// Depth of adaptive subdivision.
        #[serde(skip_serializing_if = "Option::is_none")]
        depth: Option<u32> = "with --depths",
        /// Leaves of adaptive subdivision.
        #[serde(skip_serializing_if = "Option::is_none")]
        leaves: Option<usize> = "with --depths",
        patches: usize,
        table_bytes: u64,
    }
}

described! {
    #[derive(Serialize)]
    pub(super) struct ErrorsOut {
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
    let published = if args.published { Some(published::rows(&args.mesh.name())?) } else { None };
    let progress = Progress::new("reading the mesh");
    let mesh = args.mesh.load(&progress)?;
    let schemes = args.schemes();
    progress.now("measuring");
    let options = ErrorOptions {
        fallback: args.mesh.fallback(),
        refine: args.mesh.refine,
        adaptive: None,
        samples: args.samples,
        nearest: args.nearest,
    };
    let report = surface_errors(&mesh, &schemes, &options)?;
    let undefined = report.schemes.iter().filter_map(|(_, result)| result.as_ref().err());
    if !args.scheme.is_empty()
        && let Some(error) = undefined.clone().next()
    {
        return Err(CliError::Work(error.to_string()));
    }
    let mut rows = of_schemes(&args.mesh, &mesh, &report, &options)?;
    let refinements = match &args.plot {
        Some(_) => refinements(args, &mesh, &schemes, &options, &report, &progress)?,
        None => Vec::new(),
    };
    progress.now("measuring depths");
    let capped = if args.scheme.is_empty() { &[Scheme::Gregory][..] } else { &schemes };
    rows.extend(of_depths(&args.mesh, &mesh, capped, &args.depths(), &options)?);
    drop(progress);
    if let Some(prefix) = &args.plot {
        plot(prefix, args, &schemes, &refinements, &rows)?;
    }
    if json {
        return output::json_pretty(&out(args, &report, &rows, refinements));
    }
    if args.csv {
        print_csv(&rows)?
    } else {
        print_table(&report, &rows)?
    }
    if let Some(rows) = published {
        published::print(rows, &report)?;
    }
    undefined.for_each(output::note);
    Ok(())
}

impl ErrorArgs {
    /// The schemes to measure, each once.
    fn schemes(&self) -> Vec<Scheme> {
        let mut schemes = Vec::new();
        for &scheme in if self.scheme.is_empty() { &Scheme::ALL[..] } else { &self.scheme } {
            if !schemes.contains(&scheme) {
                schemes.push(scheme);
            }
        }
        schemes
    }

    /// The depths to measure, each once, the lesser first.
    fn depths(&self) -> Vec<AdaptiveOptions> {
        let depths = self.depths.iter().map(|&depth| AdaptiveOptions { depth, ..AdaptiveOptions::default() });
        let mut depths: Vec<_> = depths.chain(self.mesh.adaptive()).collect();
        depths.sort_by_key(|options| (options.depth, options.sharp_depth));
        depths.dedup();
        depths
    }
}

/// The errors at each step of refinement; `first` is the report without.
fn refinements(
    args: &ErrorArgs,
    mesh: &ControlMesh,
    schemes: &[Scheme],
    options: &ErrorOptions,
    first: &ErrorReport,
    progress: &Progress,
) -> Result<Vec<RefinementOut>, CliError> {
    progress.now("measuring refined meshes");
    let step = |step: u32| {
        let refine = options.refine + step;
        // As many samples over each face of the mesh as without refinement, and not so few that they miss its middle.
        let samples = options.samples.div_ceil(1 << step).max(options.samples.min(5));
        let options = ErrorOptions { refine, samples, ..*options };
        let refined = match step {
            0 => None,
            _ => Some(surface_errors(mesh, schemes, &options)?),
        };
        let report = refined.as_ref().unwrap_or(first);
        let scheme =
            |row: &Row| (row.name(), RefinedSchemeOut { all: row.error.all.into(), table_bytes: row.table_bytes });
        let schemes = of_schemes(&args.mesh, mesh, report, &options)?.iter().map(scheme).collect();
        let nearest_floor_rms = report.nearest_floor.map(|floor| floor.rms);
        Ok(RefinementOut { refine, samples, nearest_floor_rms, patches: report.patches, schemes })
    };
    (0..=args.plot_steps).map(step).collect()
}

fn plot(
    prefix: &Path,
    args: &ErrorArgs,
    schemes: &[Scheme],
    refinements: &[RefinementOut],
    rows: &[Row],
) -> Result<(), CliError> {
    let curve = |scheme: &Scheme| {
        let name = scheme.name();
        let point = |refinement: &RefinementOut| {
            let RefinedSchemeOut { all, table_bytes } = refinement.schemes.get(name)?;
            Some(CurvePoint {
                patches: refinement.patches as f64,
                table_bytes: *table_bytes as f64,
                errors: [Some(all.position_rms), all.nearest_rms, Some(all.normal_rms)],
            })
        };
        Curve { name: name.into(), points: refinements.iter().filter_map(point).collect() }
    };
    let uniform = schemes.iter().map(curve);
    let by_depth = schemes.iter().map(|&scheme| depth_curve(scheme, rows));
    let curves: Vec<Curve> = uniform.chain(by_depth).filter(|curve| !curve.points.is_empty()).collect();
    let exact = |refinement: &RefinementOut| {
        let patches = refinement.patches as f64;
        let table_bytes = refinement.schemes.values().next()?.table_bytes as f64;
        Some(CurvePoint { patches, table_bytes, errors: [None, refinement.nearest_floor_rms, None] })
    };
    let floor = Curve { name: "floor of measuring".into(), points: refinements.iter().filter_map(exact).collect() };
    let name = args.mesh.name();
    let title = format!("{}: distance from the limit surface", name.rsplit(['/', '\\']).next().unwrap_or(&name));
    let last = args.mesh.refine + args.plot_steps;
    let by_depth = if args.depths().is_empty() { "" } else { ", or by depth irregular faces alone, one patch a face" };
    let subtitle = format!(
        "dots: the whole mesh refined {} to {last} times before patches are made{by_depth}; tables of the two-stage construction",
        args.mesh.refine
    );
    plot::write(prefix, &Figure { title, subtitle, curves, floor })
}

/// The errors of a scheme by depth.
fn depth_curve(scheme: Scheme, rows: &[Row]) -> Curve {
    let point = |row: &Row| {
        let FaceErrors { position, nearest, normal } = row.error.all;
        CurvePoint {
            patches: row.patches as f64,
            table_bytes: row.table_bytes as f64,
            errors: [Some(position.rms), nearest.map(|d| d.rms), Some(normal.rms)],
        }
    };
    let of_scheme = rows.iter().filter(|row| row.scheme == scheme && row.adaptive.is_some());
    Curve { name: format!("{} by depth", scheme.name()), points: of_scheme.map(point).collect() }
}

fn out(args: &ErrorArgs, report: &ErrorReport, rows: &[Row], refinements: Vec<RefinementOut>) -> ReportOut {
    let scheme = |row: &Row| SchemeOut {
        all: row.error.all.into(),
        irregular: row.error.irregular.map(Into::into),
        fallen_back: row.error.fallen_back,
        depth: row.adaptive.map(|options| options.depth),
        leaves: row.leaves,
        patches: row.patches,
        table_bytes: row.table_bytes,
    };
    let undefined =
        report.schemes.iter().filter_map(|(s, result)| Some((s.name(), result.as_ref().err()?.to_string())));
    ReportOut {
        mesh: args.mesh.name(),
        diagonal: report.diagonal,
        area: report.area,
        samples: args.samples,
        nearest_samples: args.nearest,
        nearest_floor_rms: report.nearest_floor.map(|floor| floor.rms),
        patches: report.patches,
        irregular_patches: report.irregular_patches,
        schemes: rows.iter().map(|row| (row.name(), scheme(row))).collect(),
        undefined: undefined.collect(),
        refinements,
    }
}
