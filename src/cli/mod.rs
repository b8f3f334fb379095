//! The command line: one file a command, and what they share.
//!
//! | file | holds |
//! |---|---|
//! | `bench` | `bench`: what to race, results, presets, comparisons, the report |
//! | `camera`, `displacement`, `shading`, `picture`, `paint` | what `render` needs |
//! | `described` | the keys of JSON, for help and tables |
//! | `cull` | which patches are culled |
//! | `error_rows`, `plot`, `published` | what `error` needs |
//! | `canvas` | pixels to draw and write on |
//! | `leaves` | what `patches` needs |
//! | `local` | the space in which the device sees a mesh |
//! | `obj` | what `shapes` and `convert` write |
//! | `rules` | rules of subdivision instead of the file's |
//! | `source` | where the mesh comes from, how it is prepared, which device |
//! | `motion` | the mesh at a time, sequences of files |
//! | `output` | standard output, notes, tables of text, progress, files |
//! | `interrupt` | signals that end the program while it writes |
//! | `parse` | values of options |
//! | `error` | what goes to the user, and the exit code |

mod bench;
mod camera;
mod canvas;
mod convert;
mod cull;
mod described;
mod devices;
mod displacement;
mod error;
mod error_rows;
mod errors;
mod evaluation;
mod info;
mod interrupt;
mod leaves;
mod local;
mod memory;
mod motion;
mod output;
mod paint;
mod parse;
mod patches;
mod picture;
mod plot;
mod published;
mod render;
mod rules;
mod sample;
mod screen;
mod shading;
mod shapes;
mod source;
mod tessellate;
mod watertight;

use clap::{Parser, Subcommand};
use described::help;
use error::CliError;
use std::io::Write;
use std::process::ExitCode;

/// Catmull-Clark control meshes, drawn smooth by Vulkan's tessellation stages with Gregory patches.
#[derive(Debug, Parser)]
#[command(name = "subdiv", version, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Write JSON to standard output, and nothing else there.
    #[arg(long, global = true, display_order = 1000)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  subdiv render --shape creature -o creature.png
  subdiv render model.obj --shading patches -o patches.png
  subdiv info model.glb --json
  subdiv error model.obj
  subdiv watertight model.glb
  subdiv tessellate model.obj --tolerance 0.01 -o smooth.glb
  subdiv bench model.obj --report report
  subdiv sample model.obj --grid 9 --cpu --json > samples.json

Exit codes: 0 done, 1 the work failed, 2 wrong usage.
SUBDIV_DEVICE chooses a device where --device does not; SUBDIV_VALIDATION=1 turns validation on.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Draw a mesh to a PNG file.
    Render(Box<render::RenderArgs>),
    /// Count what a mesh has, which patches it becomes and how many bytes they take. Needs no device.
    Info(info::InfoArgs),
    /// Write the control points of every patch, as the GPU or the CPU makes them.
    Patches(patches::PatchesArgs),
    /// Write positions and normals on a uniform grid of every patch, as the GPU or the CPU evaluates them.
    Sample(sample::SampleArgs),
    /// Time each scheme, construction and path on this device.
    Bench(Box<bench::BenchArgs>),
    /// Measure each scheme against the exact surface, in position and normal. Needs no device.
    Error(errors::ErrorArgs),
    /// Prove that neighbouring patches meet, to the last bit, under any factors and displacement.
    Watertight(watertight::WatertightArgs),
    /// Measure the drawn triangles against the exact surface on the screen, with factors by the view and with one for all.
    Screen(screen::ScreenArgs),
    /// Write the limit surface as a mesh: as fine as asked, closed, with normals and texture coordinates. Needs no device.
    Tessellate(Box<tessellate::TessellateArgs>),
    /// Write a control mesh to another file: OBJ with tags, GLB with polygons, PLY. Needs no device.
    Convert(convert::ConvertArgs),
    /// List the built-in shapes, or write one as OBJ.
    Shapes(shapes::ShapesArgs),
    /// List the Vulkan devices, what they can do and what they lack.
    #[command(after_help = help::<Vec<devices::DeviceOut>>("", "."))]
    Devices,
}

/// Runs the program and says how it ended.
pub(crate) fn main() -> ExitCode {
    memory::keep_freed();
    let result = Cli::try_parse().map_err(CliError::from_clap).and_then(|cli| match cli.command {
        Command::Render(args) => render::run(&args, cli.json),
        Command::Info(args) => info::run(&args, cli.json),
        Command::Patches(args) => patches::run(&args, cli.json),
        Command::Sample(args) => sample::run(&args, cli.json),
        Command::Bench(args) => bench::run(&args, cli.json),
        Command::Error(args) => errors::run(&args, cli.json),
        Command::Watertight(args) => watertight::run(&args, cli.json),
        Command::Screen(args) => screen::run(&args, cli.json),
        Command::Tessellate(args) => tessellate::run(&args, cli.json),
        Command::Convert(args) => convert::run(&args, cli.json),
        Command::Shapes(args) => shapes::run(&args, cli.json),
        Command::Devices => devices::run(cli.json),
    });
    let Err(error) = result else { return ExitCode::SUCCESS };
    if let Some(message) = error.message() {
        // Where standard error is closed there is nobody to tell.
        let _ = writeln!(std::io::stderr(), "error: {message}");
    }
    error.exit_code()
}
