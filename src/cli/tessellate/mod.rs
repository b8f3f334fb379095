//! `subdiv tessellate`: the limit surface as a mesh in a file, or in one a frame.

mod frames;
mod write;

use super::camera::CameraArgs;
use super::described::{described, help};
use super::displacement::DisplacementArgs;
use super::error::CliError;
use super::motion::{FramesArgs, FramesOut};
use super::output::{self, Progress, short};
use super::parse;
use super::source::SourceArgs;
use ash_subdiv::ControlMesh;
use ash_subdiv::dice::{Camera, Depth, DiceOptions, MAX_DEPTH, Plan, Sizes, Tessellation};
use ash_subdiv::topology::Topology;
use clap::Args;
use glam::DVec3;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;
use write::{Streamed, write};

#[derive(Debug, Args)]
#[command(after_help = help::<TessellateOut>(NOTES, EXAMPLES), allow_negative_numbers = true)]
pub(super) struct TessellateArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// The mesh, a file ending in .obj, .ply or .glb. Missing folders are made.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    frames: FramesArgs,
    #[command(flatten)]
    depth: DepthArgs,
    /// Keep faces of four vertices instead of cutting them into triangles (OBJ and PLY). Triangles remain where depths differ.
    #[arg(long)]
    quads: bool,
    /// The most vertices: what would have more is refused before any work is done.
    #[arg(long, value_name = "COUNT", default_value = "1e8", value_parser = parse::count)]
    max_vertices: u64,
    #[command(flatten)]
    camera: CameraArgs,
    /// Width and height in pixels of the picture for --pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = parse::size, help_heading = "Camera")]
    size: [u32; 2],
    #[command(flatten, next_help_heading = "Displacement")]
    displacement: DisplacementArgs,
}

/// How finely.
#[derive(Debug, Args)]
struct DepthArgs {
    /// Levels of subdivision, 1 to 10: at depth D a quad becomes 2^D by 2^D quads. 3 if nothing else is asked for.
    #[arg(long, value_name = "D", conflicts_with_all = ["pixels", "edge_length", "tolerance"])]
    depth: Option<u32>,
    /// As deep as makes edges of the refined control mesh at most this many pixels long, as the camera sees them.
    #[arg(long, value_parser = parse::positive, conflicts_with_all = ["edge_length", "tolerance"])]
    pixels: Option<f32>,
    /// As deep as makes edges of the refined control mesh at most this long, in the units of the mesh.
    #[arg(long, value_name = "LENGTH", value_parser = parse::positive, conflicts_with = "tolerance")]
    edge_length: Option<f32>,
    /// As deep as keeps all faces within this distance of the limit surface, in the units of the mesh.
    #[arg(long, value_name = "DISTANCE", value_parser = parse::positive)]
    tolerance: Option<f32>,
    /// The greatest depth that --pixels, --edge-length and --tolerance may choose.
    #[arg(long, value_name = "D", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_DEPTH)))]
    max_depth: u32,
}

const NOTES: &str = "\
Vertices are points of the Catmull-Clark limit surface, with its normals and texture coordinates;
the mesh is closed where the control mesh is. OBJ has each position once, PLY and GLB have it once
for each normal and texture coordinate there. glTF counts v from the top, OBJ and PLY from the
bottom: it is turned where the files differ.

";

const EXAMPLES: &str = "\
; largest_error is a bound in the units of the mesh, null where the surface is displaced.

Examples:
  subdiv tessellate model.obj -o smooth.glb
  subdiv tessellate model.glb --tolerance 0.01 --quads -o smooth.obj
  subdiv tessellate --shape creature --pixels 4 --size 1920x1080 --yaw 20 -o seen.ply
  subdiv tessellate --shape tentacle --frames 0..60 -o frames/out_%04d.obj
  subdiv tessellate --shape creature --depth 5 --displacement scales -o scales.glb --json";

described! {
    #[derive(Serialize)]
    struct TessellateOut {
        mesh: String,
        file: String,
        faces: usize,
        quads: usize,
        triangles: usize,
        vertices: usize,
        depth_histogram: Vec<usize> = "[facets by depth]",
        largest_error: Option<f64>,
        seconds: f64,
        bytes: u64 = "of all files",
        time: Option<f64>,
        frames: Option<FramesOut>,
    }
}

/// Kinds of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Obj,
    Ply,
    Glb,
}

impl Kind {
    fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        [("obj", Self::Obj), ("ply", Self::Ply), ("glb", Self::Glb)]
            .into_iter()
            .find(|(e, _)| *e == extension)
            .map(|k| k.1)
    }
}

impl TessellateArgs {
    fn kind(&self) -> Result<Kind, CliError> {
        let path = self.output.display();
        let kind = Kind::of(&self.output)
            .ok_or_else(|| CliError::Usage(format!("--output {path}: name a file that ends in .obj, .ply or .glb")))?;
        if self.quads && kind == Kind::Glb {
            return Err(CliError::Usage(format!("--quads: {path} has triangles only: choose .obj or .ply")));
        }
        Ok(kind)
    }

    /// Options that do not go with an exact surface.
    fn check(&self) -> Result<(), CliError> {
        let wrong = [
            (self.source.refine > 0, "--refine: refinement does not change the limit surface: choose a --depth"),
            (self.source.adaptive().is_some(), "--adaptive: all of the surface is exact: leave it out"),
            (self.displacement.has_vectors(), "--displacement-vectors: only heights are baked in: leave it out"),
        ];
        match wrong.into_iter().find(|(wrong, _)| *wrong) {
            Some((_, message)) => Err(CliError::Usage(message.into())),
            None => Ok(()),
        }
    }

    /// How finely, as seen by a camera that these points are in the picture of.
    fn options(&self, seen: &[DVec3]) -> Result<DiceOptions, CliError> {
        let DepthArgs { depth, pixels, edge_length, tolerance, max_depth } = self.depth;
        let depth = match (pixels, edge_length, tolerance) {
            (Some(pixels), ..) => {
                let size = self.size.map(f64::from);
                let view = self.camera.view(seen, self.aspect())?;
                let view_projection = view.view_projection.map(|column| column.map(f64::from));
                Depth::Pixels { pixels: pixels.into(), camera: Camera { view_projection, size } }
            }
            (_, Some(length), _) => Depth::EdgeLength(length.into()),
            (.., Some(distance)) => Depth::Tolerance(distance.into()),
            _ => Depth::Fixed(depth.unwrap_or(3)),
        };
        Ok(DiceOptions { depth, max_depth, ..DiceOptions::default() })
    }

    /// Width of the picture over its height.
    fn aspect(&self) -> f64 {
        let [width, height] = self.size.map(f64::from);
        width / height
    }

    fn check_size(&self, sizes: Sizes) -> Result<(), CliError> {
        let (vertices, most) = (sizes.vertices as u64, self.max_vertices);
        if vertices > most {
            return Err(CliError::Work(format!(
                "the tessellation has {vertices} vertices and {} bytes, more than --max-vertices {most}: ask for less depth",
                sizes.bytes
            )));
        }
        Ok(())
    }
}

pub(super) fn run(args: &TessellateArgs, json: bool) -> Result<(), CliError> {
    let kind = args.kind()?;
    args.check()?;
    let files = args.frames.files(&args.output)?;
    let start = Instant::now();
    let progress = Progress::new("reading the mesh");
    let made = match args.frames.load(&args.source, &progress)? {
        Some(moving) => args.tessellate_frames(kind, &files, &moving, &progress)?,
        None => args.tessellate(kind, &progress)?,
    };
    drop(progress);
    let Made { counts: [vertices, quads, triangles], depth_histogram, largest_error, frames } = made;
    let sizes = files.iter().map(|file| Ok(std::fs::metadata(file)?.len()));
    let out = TessellateOut {
        mesh: args.source.name(),
        file: args.output.display().to_string(),
        faces: quads + triangles,
        quads,
        triangles,
        vertices,
        depth_histogram,
        largest_error,
        seconds: start.elapsed().as_secs_f64(),
        bytes: sizes.sum::<Result<u64, CliError>>()?,
        time: args.source.time.time,
        frames,
    };
    if json {
        return output::json_pretty(&out);
    }
    output::with_stdout(|stdout| {
        let TessellateOut { file, faces, vertices, bytes, seconds, .. } = &out;
        let within =
            largest_error.map_or_else(String::new, |error| format!(", within {} of the surface", short(error)));
        let frames = args.frames.count().map_or_else(String::new, |frames| format!("{frames} frames of "));
        Ok(writeln!(
            stdout,
            "{file}: {frames}{faces} faces, {vertices} vertices, {bytes} bytes{within}; {seconds:.2} s"
        )?)
    })
}

/// What was written.
struct Made {
    /// Vertices, quads, triangles.
    counts: [usize; 3],
    depth_histogram: Vec<usize>,
    largest_error: Option<f64>,
    frames: Option<FramesOut>,
}

impl TessellateArgs {
    /// The mesh in one file.
    fn tessellate(&self, kind: Kind, progress: &Progress) -> Result<Made, CliError> {
        let mesh = self.source.load(progress)?;
        let texels = self.displacement.texels()?;
        progress.now("choosing depths");
        let topology = Topology::new(&mesh);
        let plan = Plan::<f32>::new(&topology, &self.options(&points(&mesh))?)?;
        let sizes = plan.sizes();
        self.check_size(sizes)?;
        let largest_error = if texels.is_none() { Some(plan.error_bound()?) } else { None };
        self.note_error(largest_error, progress);
        let depth_histogram = plan.depth_histogram();
        let unused = plan.unused();
        let counts = if texels.is_none() && unused.is_empty() {
            progress.now("writing, piece by piece");
            let stream = plan.stream(&mesh.data().positions)?;
            let turned = self.turns_texcoords(kind);
            write(&self.output, kind, &Streamed { stream: &stream, sizes, quads: self.quads, turned })?
        } else {
            progress.now("evaluating");
            let mut tessellation = Tessellation::of(plan, &mesh.data().positions)?;
            if let Some(texels) = &texels {
                let [scale, bias] = self.displacement.amount(&mesh);
                tessellation.displace(|texcoord| scale * texels.sample(texcoord) + bias)?;
            }
            progress.now("writing");
            self.write_arrays(&self.output, kind, &tessellation, &unused)?
        };
        Ok(Made { counts, depth_histogram, largest_error, frames: None })
    }

    /// Reports where the greatest depth does not keep the tolerance.
    fn note_error(&self, largest_error: Option<f64>, progress: &Progress) {
        if let (Some(distance), Some(error)) = (self.depth.tolerance, largest_error)
            && error > f64::from(distance)
        {
            let depth = self.depth.max_depth;
            progress.note(format!("--tolerance {distance}: at --max-depth {depth} the error may be {}", short(error)));
        }
    }
}

fn points(mesh: &ControlMesh) -> Vec<DVec3> {
    mesh.data().positions.iter().map(|&position| position.into()).collect()
}
