//! `subdiv sample`: positions and normals on a lattice of every patch.

use super::error::CliError;
use super::output::{self, Progress};
use super::parse;
use super::patches::{by_origin, heading};
use super::source::{DeviceArgs, MeshArgs, tell_notices};
use ash_subdiv::Construction;
use ash_subdiv::capture::{Captured, CapturedVertex};
use ash_subdiv::patch::Sample;
use ash_subdiv::table::{FaceOrigin, Patch, grid_parameters};
use clap::Args;
use glam::DVec3;
use serde::{Serialize, Serializer};
use std::fmt::Display;

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct SampleArgs {
    #[command(flatten)]
    mesh: MeshArgs,
    /// Samples along each side of a patch, from 2 up; the GPU has at most its largest factor and one.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(2..=4097))]
    grid: u32,
    /// Evaluate on the CPU in f64, instead of in the evaluation shader.
    #[arg(long, conflicts_with_all = ["construction", "device", "validation"])]
    cpu: bool,
    /// How the GPU makes the control points.
    #[arg(long, value_name = "HOW", default_value = Construction::TwoStage.name(), value_parser = parse::construction())]
    construction: Construction,
    #[command(flatten)]
    device: DeviceArgs,
}

const EXAMPLES: &str = "\
Order of samples: of a quad, u = i/(N-1) and v = j/(N-1) at index j*N+i, with corners 0 to 3 of the face at (0,0),
(1,0), (1,1) and (0,1). Of a triangle, rows r = 0..N-1 with u = 1-r/(N-1) at corner 0, in each row w = k/(N-1) for
k = 0..r towards corner 2.

Examples:
  subdiv sample --shape torus --grid 3
  subdiv sample model.obj --grid 17 --cpu --json > samples.json";

/// A sample as it is written: position and normal.
trait Lattice {
    type Number: Serialize + Display;

    fn position(&self) -> [Self::Number; 3];
    fn normal(&self) -> [Self::Number; 3];
}

impl Lattice for CapturedVertex {
    type Number = f32;

    fn position(&self) -> [f32; 3] {
        self.position
    }

    fn normal(&self) -> [f32; 3] {
        self.normal
    }
}

impl Lattice for Sample<DVec3> {
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
struct SamplesOut<'o, L: Lattice> {
    grid: u32,
    construction: &'static str,
    #[serde(serialize_with = "in_order")]
    faces: (&'o [FaceOrigin], &'o [Vec<L>]),
}

#[derive(Serialize)]
#[serde(bound = "")]
struct FaceOut<'o, L: Lattice> {
    face: u32,
    sub: i64,
    #[serde(serialize_with = "positions")]
    positions: &'o [L],
    #[serde(serialize_with = "normals")]
    normals: &'o [L],
}

/// Writes the patches one by one, sorted by their origins.
fn in_order<L: Lattice, S: Serializer>(
    (origins, samples): &(&[FaceOrigin], &[Vec<L>]),
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(by_origin(origins).into_iter().map(|i| FaceOut {
        face: origins[i].face,
        sub: origins[i].sub,
        positions: &samples[i],
        normals: &samples[i],
    }))
}

fn positions<L: Lattice, S: Serializer>(samples: &&[L], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(samples.iter().map(L::position))
}

fn normals<L: Lattice, S: Serializer>(samples: &&[L], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(samples.iter().map(L::normal))
}

pub(super) fn run(args: &SampleArgs, json: bool) -> Result<(), CliError> {
    let progress = Progress::new("reading the mesh");
    let mesh = args.mesh.load()?;
    if args.cpu {
        progress.now("sampling");
        let surface = args.mesh.cpu_surface(&mesh, &progress)?;
        let samples = surface.grid(&surface.control_points(|p| p), args.grid);
        drop(progress);
        return write(args, json, surface.plan().patches(), &surface.origins(), &samples);
    }
    let (tables, samples) = args.device.run(|headless| {
        let max = headless.properties().max_tessellation_level + 1;
        if args.grid > max {
            let (grid, device) = (args.grid, &headless.properties().name);
            return Err(CliError::Work(format!("--grid {grid}: {device} evaluates at most {max}; more with --cpu")));
        }
        progress.now("building tables");
        let options = args.mesh.model_options(args.construction);
        let captured = Captured::new(headless, &mesh, &options)?;
        tell_notices(captured.tables().notices(), &progress);
        progress.now("sampling");
        let samples = captured.grid(args.grid)?;
        Ok((captured.tables().clone(), samples))
    })?;
    drop(progress);
    write(args, json, tables.plan().patches(), tables.origins(), &samples)
}

fn write<L: Lattice>(
    args: &SampleArgs,
    json: bool,
    patches: &[Patch],
    origins: &[FaceOrigin],
    samples: &[Vec<L>],
) -> Result<(), CliError> {
    if json {
        let construction = if args.cpu { "cpu" } else { args.construction.name() };
        return output::json(&SamplesOut { grid: args.grid, construction, faces: (origins, samples) });
    }
    output::with_stdout(|out| {
        for i in by_origin(origins) {
            writeln!(out, "{}{}", heading(origins[i]), patches[i].kind.name())?;
            let parameters = grid_parameters(patches[i].kind, args.grid);
            for ([u, v], sample) in parameters.into_iter().zip(&samples[i]) {
                let [x, y, z] = sample.position();
                let [a, b, c] = sample.normal();
                writeln!(out, "  {u:.4} {v:.4}  {x:>13.8}{y:>14.8}{z:>14.8}  {a:>12.8}{b:>13.8}{c:>13.8}")?;
            }
        }
        Ok(())
    })
}
