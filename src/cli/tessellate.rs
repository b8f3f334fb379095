//! `subdiv tessellate`: the limit surface as a mesh in a file.

use super::camera::CameraArgs;
use super::described::{described, help};
use super::displacement::DisplacementArgs;
use super::error::CliError;
use super::interrupt::{Interruptible, Watch};
use super::output::{self, Progress, short, write_file};
use super::parse;
use super::source::SourceArgs;
use ash_subdiv::ControlMesh;
use ash_subdiv::dice::{Camera, Depth, DiceOptions, MAX_DEPTH, Piece, Plan, Sizes, Stream, Tessellation};
use ash_subdiv::mesh::write::{Kept, Pieces, Polygons, Vertices, write_glb, write_obj, write_ply};
use ash_subdiv::topology::Topology;
use clap::Args;
use serde::Serialize;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Debug, Args)]
#[command(after_help = help::<TessellateOut>(NOTES, EXAMPLES), allow_negative_numbers = true)]
pub(super) struct TessellateArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// The mesh, a file ending in .obj, .ply or .glb. Missing folders are made.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
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
        bytes: u64,
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

    fn options(&self, mesh: &ControlMesh) -> Result<DiceOptions, CliError> {
        let DepthArgs { depth, pixels, edge_length, tolerance, max_depth } = self.depth;
        let depth = match (pixels, edge_length, tolerance) {
            (Some(pixels), ..) => {
                let size = self.size.map(f64::from);
                let points: Vec<_> = mesh.data().positions.iter().map(|&p| p.into()).collect();
                let view = self.camera.view(&points, size[0] / size[1])?;
                let view_projection = view.view_projection.map(|column| column.map(f64::from));
                Depth::Pixels { pixels: pixels.into(), camera: Camera { view_projection, size } }
            }
            (_, Some(length), _) => Depth::EdgeLength(length.into()),
            (.., Some(distance)) => Depth::Tolerance(distance.into()),
            _ => Depth::Fixed(depth.unwrap_or(3)),
        };
        Ok(DiceOptions { depth, max_depth, ..DiceOptions::default() })
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
    let start = Instant::now();
    let progress = Progress::new("reading the mesh");
    let mesh = args.source.load(&progress)?;
    let texels = args.displacement.texels()?;
    progress.now("choosing depths");
    let topology = Topology::new(&mesh);
    let plan = Plan::<f32>::new(&topology, &args.options(&mesh)?)?;
    let sizes = plan.sizes();
    args.check_size(sizes)?;
    let largest_error = if texels.is_none() { Some(plan.error_bound()?) } else { None };
    if let (Some(distance), Some(error)) = (args.depth.tolerance, largest_error)
        && error > f64::from(distance)
    {
        let depth = args.depth.max_depth;
        progress.note(format!("--tolerance {distance}: at --max-depth {depth} the error may be {}", short(error)));
    }
    let depth_histogram = plan.depth_histogram();
    let unused = plan.unused();
    let [vertices, quads, triangles] = if texels.is_none() && unused.is_empty() {
        progress.now("writing, piece by piece");
        let stream = plan.stream(&mesh.data().positions)?;
        let turned = args.turns_texcoords(kind);
        args.write(kind, &Streamed { stream: &stream, sizes, quads: args.quads, turned })?
    } else {
        progress.now("evaluating");
        let mut tessellation = Tessellation::of(plan, &mesh.data().positions)?;
        if let Some(texels) = &texels {
            let [scale, bias] = args.displacement.amount(&mesh);
            tessellation.displace(|texcoord| scale * texels.sample(texcoord) + bias)?;
        }
        progress.now("writing");
        args.write_arrays(kind, &tessellation, &unused)?
    };
    drop(progress);
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
        bytes: std::fs::metadata(&args.output)?.len(),
    };
    if json {
        return output::json_pretty(&out);
    }
    output::with_stdout(|stdout| {
        let TessellateOut { file, faces, vertices, bytes, seconds, .. } = &out;
        let within =
            largest_error.map_or_else(String::new, |error| format!(", within {} of the surface", short(error)));
        Ok(writeln!(stdout, "{file}: {faces} faces, {vertices} vertices, {bytes} bytes{within}; {seconds:.2} s")?)
    })
}

impl TessellateArgs {
    /// Whether v runs the other way in the file that is written.
    fn turns_texcoords(&self, kind: Kind) -> bool {
        self.source.is_gltf() != (kind == Kind::Glb)
    }

    /// Writes a mesh that is there as a whole, without vertices that belong to no face.
    fn write_arrays(
        &self,
        kind: Kind,
        tessellation: &Tessellation<f32>,
        unused: &[u32],
    ) -> Result<[usize; 3], CliError> {
        let cut = if self.quads { None } else { Some(tessellation.all_triangles()) };
        let (quads, triangles) = match &cut {
            Some(triangles) => (&[][..], triangles.as_slice()),
            None => (tessellation.quads(), tessellation.triangles()),
        };
        let turn = |all: &[[f32; 2]]| all.iter().copied().map(turned).collect::<Vec<_>>();
        let texcoords = tessellation.texcoords().filter(|_| self.turns_texcoords(kind)).map(turn);
        let plan = tessellation.plan();
        let sizes = plan.sizes();
        let owned = sizes.positions as u32;
        let copies: Vec<u32> = (owned..sizes.vertices as u32).map(|copy| plan.position_of(copy)).collect();
        let all = Polygons {
            positions: tessellation.positions(),
            normals: tessellation.normals(),
            texcoords: texcoords.as_deref().or(tessellation.texcoords()),
            copies: (owned, &copies),
            quads,
            triangles,
        };
        let kept = Kept::of(&all, unused);
        self.write(kind, &kept.as_ref().map_or(all, Kept::polygons))
    }

    /// Writes the file. Gives the numbers of its vertices, quads and triangles.
    fn write(&self, kind: Kind, mesh: &dyn Pieces) -> Result<[usize; 3], CliError> {
        let write = |part: &Path| -> io::Result<()> {
            let _watch = Watch::start();
            let mut out = BufWriter::with_capacity(1 << 20, Interruptible(File::create(part)?));
            match kind {
                Kind::Obj => write_obj(mesh, &mut out)?,
                Kind::Ply => write_ply(mesh, &mut out)?,
                Kind::Glb => write_glb(mesh, &mut out)?,
            }
            out.flush()
        };
        write_file(&self.output, |part| write(part).map_err(|error| error.to_string()))?;
        let ([vertices, _], [quads, triangles]) = (mesh.vertex_counts(), mesh.face_counts());
        Ok([vertices, quads, triangles])
    }
}

/// A tessellation that is made while it is written.
struct Streamed<'s> {
    stream: &'s Stream<'s, f32>,
    sizes: Sizes,
    /// Whether quads stay quads.
    quads: bool,
    /// Whether v runs the other way.
    turned: bool,
}

impl Pieces for Streamed<'_> {
    fn vertex_counts(&self) -> [usize; 2] {
        [self.sizes.vertices, self.sizes.positions]
    }

    fn face_counts(&self) -> [usize; 2] {
        let Sizes { quads, triangles, .. } = self.sizes;
        if self.quads { [quads, triangles] } else { [0, 2 * quads + triangles] }
    }

    fn has_texcoords(&self) -> bool {
        self.stream.plan().has_texcoords()
    }

    fn position_of(&self, vertex: u32) -> u32 {
        self.stream.plan().position_of(vertex)
    }

    fn vertices(&self, visit: &mut dyn FnMut(Vertices) -> io::Result<()>) -> io::Result<()> {
        self.stream.for_each_piece(|Piece { positions, normals, texcoords }| {
            let other = texcoords.filter(|_| self.turned);
            let other = other.map(|all| all.iter().copied().map(turned).collect::<Vec<_>>());
            visit(Vertices { positions, normals, texcoords: other.as_deref().or(texcoords) })
        })
    }

    fn quads(&self, visit: &mut dyn FnMut(&[[u32; 4]]) -> io::Result<()>) -> io::Result<()> {
        if self.quads { self.stream.for_each_quads(visit) } else { Ok(()) }
    }

    fn triangles(&self, visit: &mut dyn FnMut(&[[u32; 3]]) -> io::Result<()>) -> io::Result<()> {
        if self.quads { self.stream.for_each_triangles(visit) } else { self.stream.for_each_cut(visit) }
    }
}

fn turned([u, v]: [f32; 2]) -> [f32; 2] {
    [u, 1.0 - v]
}
