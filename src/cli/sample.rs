//! `subdiv sample`: positions and normals on a uniform grid of every patch.

use super::error::CliError;
use super::local::Local;
use super::output::{self, Progress};
use super::parse::{self, Surface};
use super::patches::{by_origin, heading, sub};
use super::source::{DeviceArgs, SourceArgs, report_notices};
use ash_subdiv::capture::{Captured, CapturedVertex};
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::patch::Sample;
use ash_subdiv::table::{FaceOrigin, Patch, PatchId, grid_parameters};
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{Construction, ControlMesh, Fallback, Scheme};
use clap::Args;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use serde::{Serialize, Serializer};
use std::fmt::Display;

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct SampleArgs {
    #[command(flatten)]
    mesh: SourceArgs,
    /// Scheme of the patches that faces become; `limit` is the exact Catmull-Clark surface instead, with --cpu.
    #[arg(long, default_value = Scheme::Gregory.name(), value_parser = parse::scheme_or_limit())]
    scheme: Surface,
    /// Samples along each side of a patch, from 2 up; the GPU has at most its largest factor and one.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(2..=4097))]
    grid: u32,
    /// Evaluate on the CPU in f64, instead of in the evaluation shader.
    #[arg(long, conflicts_with_all = ["construction", "device", "validation"])]
    cpu: bool,
    /// Construction of the control points on the GPU.
    #[arg(long, value_name = "HOW", default_value = Construction::TwoStage.name(), value_parser = parse::one_of(Construction::ALL, Construction::name))]
    construction: Construction,
    #[command(flatten)]
    device: DeviceArgs,
}

const EXAMPLES: &str = "\
Order of samples: of a quad, u = i/(N-1) and v = j/(N-1) at index j*N+i, with corners 0 to 3 of the face at (0,0),
(1,0), (1,1) and (0,1). Of a triangle, rows r = 0..N-1 with u = 1-r/(N-1) at corner 0, in each row w = k/(N-1) for
k = 0..r towards corner 2. A face of five and more corners is such triangles, sub k from corner k to k + 1 and the
centre, unless it is refined; so is a triangle with --adaptive.
The limit surface has quads whole (sub -1); of any other face, triangles too, the part around each corner (sub): (0,0)
is the corner, (1,0) the middle of the edge after it, (1,1) the centre, (0,1) the middle of the edge before it.

JSON: grid, construction, faces[{face, sub, scheme, positions[[x, y, z]], normals[[x, y, z]]}].

Examples:
  subdiv sample --shape torus --grid 3
  subdiv sample model.obj --grid 17 --cpu --json > samples.json
  subdiv sample model.obj --scheme limit --grid 9 --cpu --json > limit.json";

/// A sample as it is written: position and normal.
trait GridPoint {
    type Number: Serialize + Display;

    fn position(&self) -> [Self::Number; 3];
    fn normal(&self) -> [Self::Number; 3];
}

impl GridPoint for CapturedVertex {
    type Number = f32;

    fn position(&self) -> [f32; 3] {
        self.position
    }

    fn normal(&self) -> [f32; 3] {
        self.normal
    }
}

impl GridPoint for Sample<DVec3> {
    type Number = f64;

    fn position(&self) -> [f64; 3] {
        self.position.into()
    }

    fn normal(&self) -> [f64; 3] {
        self.normal.into()
    }
}

#[derive(Serialize)]
#[serde(bound = "")]
struct SamplesOut<'o, L: GridPoint> {
    grid: u32,
    construction: &'static str,
    #[serde(serialize_with = "in_order")]
    faces: Parts<'o, L>,
}

/// Where each part of the surface comes from, what it is, and its samples.
type Parts<'o, L> = (&'o [FaceOrigin], &'o [Part], &'o [Vec<L>]);

/// A part of the surface.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// The scheme that draws it.
    scheme: &'static str,
    /// Name in text.
    name: &'static str,
    /// As what it is sampled.
    kind: PatchKind,
}

impl Part {
    /// Sampled as quads are.
    const LIMIT: Self = Self { scheme: parse::LIMIT, name: parse::LIMIT, kind: PatchKind::Regular };

    fn of(patch: &Patch) -> Self {
        Self { scheme: patch.scheme.name(), name: patch.kind.name(), kind: patch.kind }
    }
}

#[derive(Serialize)]
#[serde(bound = "")]
struct FaceOut<'o, L: GridPoint> {
    face: u32,
    sub: i64,
    scheme: &'static str,
    #[serde(serialize_with = "positions")]
    positions: &'o [L],
    #[serde(serialize_with = "normals")]
    normals: &'o [L],
}

/// Writes the patches one by one, sorted by their origins.
fn in_order<L: GridPoint, S: Serializer>(
    (origins, parts, samples): &Parts<L>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(by_origin(origins).into_iter().map(|i| FaceOut {
        face: origins[i].face,
        sub: sub(&origins[i]),
        scheme: parts[i].scheme,
        positions: &samples[i],
        normals: &samples[i],
    }))
}

fn positions<L: GridPoint, S: Serializer>(samples: &&[L], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(samples.iter().map(L::position))
}

fn normals<L: GridPoint, S: Serializer>(samples: &&[L], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(samples.iter().map(L::normal))
}

impl SampleArgs {
    /// What is given that the limit surface cannot have.
    fn not_of_limit(&self) -> Option<&'static str> {
        let SampleArgs { mesh, cpu, .. } = self;
        let wrong = [
            (!cpu, "the limit surface is evaluated on the CPU: add --cpu"),
            (mesh.refine > 0, "refinement does not change the limit surface: leave out --refine"),
            (
                mesh.adaptive().is_some(),
                "adaptive surfaces come to the limit surface, which has no depth: leave out --adaptive",
            ),
            (
                mesh.fallback() != Fallback::Refuse,
                "the limit surface has no faces without patches: leave out --fallback",
            ),
        ];
        wrong.into_iter().find_map(|(is_wrong, message)| is_wrong.then_some(message))
    }
}

pub(super) fn run(args: &SampleArgs, json: bool) -> Result<(), CliError> {
    if args.scheme == Surface::Limit
        && let Some(message) = args.not_of_limit()
    {
        return Err(CliError::Usage(format!("--scheme limit: {message}")));
    }
    args.mesh.refuse_leaves()?;
    let progress = Progress::new("reading the mesh");
    let mesh = args.mesh.load(&progress)?;
    let scheme = match args.scheme {
        Surface::Patches(scheme) => scheme,
        Surface::Limit => {
            progress.now("sampling");
            let (origins, samples) = sample_limit(&mesh, args.grid)?;
            drop(progress);
            return write(args, json, (&origins, &vec![Part::LIMIT; origins.len()], &samples));
        }
    };
    let parts = |patches: &[Patch]| patches.iter().map(Part::of).collect::<Vec<_>>();
    if args.cpu {
        progress.now("sampling");
        let surface = args.mesh.cpu_surface(&mesh, scheme, &progress)?;
        let samples = surface.grid(&surface.control_points(|p| p), args.grid);
        drop(progress);
        return write(args, json, (&surface.origins(), &parts(surface.plan().patches()), &samples));
    }
    let (mesh, local) = Local::of(mesh)?;
    let (tables, samples) = args.device.run(|headless| {
        let max = headless.properties().max_tessellation_level + 1;
        if args.grid > max {
            let (grid, device) = (args.grid, &headless.properties().name);
            return Err(CliError::Work(format!("--grid {grid}: {device} evaluates at most {max}; more with --cpu")));
        }
        progress.now("building tables");
        let options = args.mesh.model_options(scheme, args.construction);
        let captured = Captured::new(headless, &mesh, &options)?;
        report_notices(captured.tables().notices(), &progress);
        progress.now("sampling");
        let samples = captured.grid(args.grid)?;
        Ok((captured.tables().clone(), samples))
    })?;
    drop(progress);
    let (origins, parts) = (tables.origins(), parts(tables.plan().patches()));
    if local.is_file() {
        return write(args, json, (&origins, &parts, &samples));
    }
    let sample = |vertex: &CapturedVertex| Sample {
        position: local.in_file(Vec3::from(vertex.position).as_dvec3()),
        normal: Vec3::from(vertex.normal).as_dvec3(),
    };
    let samples: Vec<Vec<_>> = samples.iter().map(|part| part.iter().map(sample).collect()).collect();
    write(args, json, (&origins, &parts, &samples))
}

/// Parts of a surface, and the samples of each.
type Sampled = (Vec<FaceOrigin>, Vec<Vec<Sample<DVec3>>>);

/// The limit surface over all faces that it has, `n` samples along each side of each part.
fn sample_limit(mesh: &ControlMesh, n: u32) -> Result<Sampled, CliError> {
    let limit = LimitSurface::new(mesh)?;
    let parameters = grid_parameters(PatchKind::Regular, n);
    let faces = (0..mesh.face_count() as u32).into_par_iter().filter(|&face| limit.has_face(face));
    let of_part = |(face, sub): (u32, i32)| {
        let sample = |&[u, v]: &[f64; 2]| {
            let sample = limit.evaluate(face, sub, u, v);
            Sample { position: sample.position, normal: sample.normal }
        };
        (
            FaceOrigin { face, corner: u32::try_from(sub).ok(), id: PatchId::default() },
            parameters.iter().map(sample).collect(),
        )
    };
    Ok(faces.flat_map_iter(|face| limit.subs(face).map(move |sub| (face, sub))).map(of_part).unzip())
}

fn write<L: GridPoint>(args: &SampleArgs, json: bool, faces: Parts<L>) -> Result<(), CliError> {
    if json {
        let construction = if args.cpu { "cpu" } else { args.construction.name() };
        return output::json(&SamplesOut { grid: args.grid, construction, faces });
    }
    let (origins, parts, samples) = faces;
    output::with_stdout(|out| {
        for i in by_origin(origins) {
            let Part { name, kind, .. } = parts[i];
            writeln!(out, "{}{name}", heading(origins[i]))?;
            for ([u, v], sample) in grid_parameters(kind, args.grid).into_iter().zip(&samples[i]) {
                let [x, y, z] = sample.position();
                let [a, b, c] = sample.normal();
                writeln!(out, "  {u:.4} {v:.4}  {x:>13.8}{y:>14.8}{z:>14.8}  {a:>12.8}{b:>13.8}{c:>13.8}")?;
            }
        }
        Ok(())
    })
}
