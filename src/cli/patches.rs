//! `subdiv patches`: the control points of every patch.

use super::error::CliError;
use super::leaves;
use super::local::Local;
use super::output::{self, Progress};
use super::source::{DeviceArgs, MeshArgs, report_notices};
use ash_subdiv::capture::Captured;
use ash_subdiv::table::{CpuSurface, FaceOrigin, Notice, Patch, TableOptions};
use ash_subdiv::{Construction, ControlMesh, ModelOptions};
use clap::{Args, ValueEnum};
use glam::Vec3;
use serde::{Serialize, Serializer};
use std::fmt::Display;

/// Maker of the control points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Maker {
    /// The GPU: rings in the vertex shader, patches in the control shader.
    TwoStage,
    /// The GPU: weighted sums in the control shader.
    Stencil,
    /// The GPU: rings, then patches, in compute shaders.
    Cached,
    /// The CPU, in f64.
    Cpu,
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct PatchesArgs {
    #[command(flatten)]
    mesh: MeshArgs,
    /// Maker of the control points.
    #[arg(long, value_enum, default_value_t = Maker::TwoStage)]
    construction: Maker,
    #[command(flatten)]
    device: DeviceArgs,
}

const EXAMPLES: &str = "\
Order of points: a regular patch has 4 x 4 Bezier points, row-major with rows along u.
Others have, by scheme: gregory p0.., then e0+ e0- e1+ e1-.., then f0+ f0-..: 20 of a quad, 15 of a
triangle; acc 4 x 4 Bezier points, then the vectors t+ t- x+ x- of each corner: 32; pm and c-patch v0..,
then t0+ t0-.., then b211, b121 and b112 of all sectors: 24 of a quad, 18 of a triangle, 30 of a pentagon. A pentagon
is five patches, one a sector, each of which counts the corners from its own edge on.

JSON: construction, patches[{face, sub, kind, scheme, points[[x, y, z]]}]: face of the input; sub is -1, or the
corner of the face around which refinement made the patch, or at which the edge of a pentagon's sector starts;
kind is regular, irregular_quad, triangle or pentagon; scheme is the one asked for, or the fallback.

With --adaptive: construction, leaves[{face, sub, level, u, v, kind, edge, sharpness, points[[x, y, z]]}], of each patch
in the order of its quadtree: a leaf is the cell in column u and row v of the 2^level by 2^level cells of the patch. Of a
face other than a quad sub is a corner, and cells are 2^(level-1) by 2^(level-1) of the part of the face around it.
kind is regular, single_crease (edge 0 to 3 at v = 0, u = 1, v = 1, u = 0; sharpness at the level of the leaf) or cap.
Points: 4 x 4 of a uniform bicubic B-spline, row-major with rows along u; of caps those of gregory.

Examples:
  subdiv patches --shape cube
  subdiv patches model.obj --construction cpu --json > patches.json
  subdiv patches model.obj --construction cpu --adaptive 3 --json > leaves.json";

/// A patch as it is written.
#[derive(Serialize)]
struct PatchOut<'p, T> {
    /// The face of the input.
    face: u32,
    /// As [`sub`] has it.
    sub: i64,
    kind: &'static str,
    scheme: &'static str,
    points: &'p [[T; 3]],
}

/// All patches as they were made; written one by one, sorted by their origins.
#[derive(Clone, Copy)]
struct Made<'o, T> {
    patches: &'o [Patch],
    origins: &'o [FaceOrigin],
    points: &'o [Vec<[T; 3]>],
}

impl<T: Serialize> Serialize for Made<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(by_origin(self.origins).into_iter().map(|i| PatchOut {
            face: self.origins[i].face,
            sub: sub(&self.origins[i]),
            kind: self.patches[i].kind.name(),
            scheme: self.patches[i].scheme.name(),
            points: &self.points[i],
        }))
    }
}

#[derive(Serialize)]
struct PatchesOut<'o, T: Serialize> {
    construction: String,
    patches: Made<'o, T>,
}

/// The numbers of patches in the order of the input's faces.
pub(super) fn by_origin(origins: &[FaceOrigin]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..origins.len()).collect();
    order.sort_by_cached_key(|&i| (origins[i].face, sub(&origins[i])));
    order
}

pub(super) fn run(args: &PatchesArgs, json: bool) -> Result<(), CliError> {
    if args.mesh.source.adaptive().is_some() && args.construction != Maker::Cpu {
        return Err(CliError::Usage(
            "--adaptive: leaves are written as the CPU makes them: add --construction cpu".into(),
        ));
    }
    let progress = Progress::new("reading the mesh");
    let mesh = args.mesh.load(&progress)?;
    let refine = steps(&args.mesh, &mesh, &progress);
    match args.construction {
        Maker::Cpu => {
            progress.now("making control points");
            let options = TableOptions { refine, ..args.mesh.source.table_options(args.mesh.scheme) };
            let surface = CpuSurface::with_options(&mesh, &options)?;
            report_notices(&surface.notices(), &progress);
            if let Some(plan) = surface.adaptive() {
                drop(progress);
                return leaves::write(&surface, plan, json);
            }
            let points = surface.control_points(|p| p);
            drop(progress);
            let points: Vec<Vec<[f64; 3]>> =
                points.into_iter().map(|patch| patch.into_iter().map(Into::into).collect()).collect();
            write(args, json, Made { patches: surface.plan().patches(), origins: &surface.origins(), points: &points })
        }
        Maker::TwoStage => on_device(args, json, (&mesh, refine), Construction::TwoStage, progress),
        Maker::Stencil => on_device(args, json, (&mesh, refine), Construction::Stencil, progress),
        Maker::Cached => on_device(args, json, (&mesh, refine), Construction::Cached, progress),
    }
}

/// Steps of refinement before patches are made: one where faces have five or more corners, so that they have patches, and not leaves.
fn steps(args: &MeshArgs, mesh: &ControlMesh, progress: &Progress) -> u32 {
    let mut polygons = (0..).zip(&mesh.data().face_sizes).filter(|(_, size)| **size > 4);
    match (args.source.refine, args.source.adaptive(), polygons.next()) {
        (0, None, Some((first, _))) if args.scheme.has_caps() => {
            report_notices(&[Notice::RefinedPolygons { polygons: 1 + polygons.count(), first }], progress);
            1
        }
        (refine, ..) => refine,
    }
}

fn on_device(
    args: &PatchesArgs,
    json: bool,
    (mesh, refine): (&ControlMesh, u32),
    construction: Construction,
    progress: Progress,
) -> Result<(), CliError> {
    let (mesh, local) = Local::of(mesh.clone())?;
    let (tables, points) = args.device.run(|headless| {
        progress.now("building tables");
        let options = ModelOptions { refine, ..args.mesh.model_options(construction) };
        let captured = Captured::new(headless, &mesh, &options)?;
        report_notices(captured.tables().notices(), &progress);
        progress.now("making control points");
        let points = captured.control_points()?;
        Ok((captured.tables().clone(), points))
    })?;
    drop(progress);
    let (patches, origins) = (tables.plan().patches(), &tables.origins());
    if local.is_file() {
        return write(args, json, Made { patches, origins, points: &points });
    }
    let point = |point: &[f32; 3]| local.in_file(Vec3::from(*point).as_dvec3()).to_array();
    let points: Vec<Vec<[f64; 3]>> = points.iter().map(|patch| patch.iter().map(point).collect()).collect();
    write(args, json, Made { patches, origins, points: &points })
}

fn write<T: Serialize + Display>(args: &PatchesArgs, json: bool, made: Made<T>) -> Result<(), CliError> {
    let construction = args.construction.to_possible_value().map(|v| v.get_name().to_owned()).unwrap_or_default();
    if json {
        return output::json(&PatchesOut { construction, patches: made });
    }
    output::with_stdout(|out| {
        for i in by_origin(made.origins) {
            let (origin, Patch { kind, scheme, .. }) = (made.origins[i], made.patches[i]);
            let fallback = if scheme == args.mesh.scheme { "" } else { " of the fallback" };
            writeln!(out, "{}{}{fallback}", heading(origin), kind.name())?;
            for (number, point) in made.points[i].iter().enumerate() {
                let [x, y, z] = point.each_ref().map(ToString::to_string);
                writeln!(out, "  {:<7}{x:>24}{y:>24}{z:>24}", scheme.point_name(kind, number))?;
            }
        }
        Ok(())
    })
}

/// The number of a patch among those of its face: -1 for the whole face; else the corner of the face around which refinement made
/// this part of it, or from which the edge of this piece of a pentagon starts. After several steps, four times the number of the
/// first step's part plus the corner within that, and so on.
pub(super) fn sub(origin: &FaceOrigin) -> i64 {
    origin.path().fold(-1, |sub, corner| i64::from(corner) + if sub < 0 { 0 } else { 4 * sub })
}

/// Text before the kind of a patch.
pub(super) fn heading(origin: FaceOrigin) -> String {
    match sub(&origin) {
        -1 => format!("face {}: ", origin.face),
        sub => format!("face {}, part {sub}: ", origin.face),
    }
}
