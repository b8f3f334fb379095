//! `subdiv watertight`: whether neighbouring patches meet, to the bit.

use super::described::{described, help};
use super::displacement::{diagonal, scales, texture};
use super::error::CliError;
use super::local::Local;
use super::output::{self, Progress, Table};
use super::parse;
use super::source::{DeviceArgs, SourceArgs, report_notices};
use ash_subdiv::adaptive::DrawnBy;
use ash_subdiv::capture::{CaptureDraw, Captured};
use ash_subdiv::headless::{Headless, Texture};
use ash_subdiv::measure::watertight::{
    self, Mismatch, Seams, Tally, leaked_pixels, random_factors, with_seams_everywhere,
};
use ash_subdiv::renderer::{Cull, Factor, ModelTables};
use ash_subdiv::{Construction, ControlMesh, ModelOptions, Scheme, Spacing, View};
use clap::Args;
use glam::Vec3;
use rayon::prelude::*;
use serde::Serialize;

#[derive(Debug, Args)]
#[command(after_help = help::<WatertightOut>(NOTES, EXAMPLES), allow_negative_numbers = true)]
pub(super) struct WatertightArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// Compare at least this many pairs of vertices: random factors are drawn anew until there are.
    #[arg(long, value_name = "PAIRS", default_value = "0", value_parser = parse::count)]
    samples: u64,
    /// The largest random factor.
    #[arg(long, default_value_t = 12.0, value_parser = parse::factor)]
    largest_factor: f32,
    /// Distance that the built-in height map moves the surface, as a part of the bounding box's diagonal.
    #[arg(long, value_name = "PART", default_value_t = 0.05)]
    displacement_scale: f32,
    /// Width and height in pixels of the pictures in which holes are looked for.
    #[arg(long, value_name = "PIXELS", default_value_t = 512, value_parser = clap::value_parser!(u32).range(16..=8192))]
    side: u32,
    #[command(flatten, next_help_heading = "Device")]
    device: DeviceArgs,
}

const NOTES: &str = "\
What is compared: every vertex on an edge or a corner, as each of its patches evaluates it, bit for bit:
positions always, normals where the mesh shares them and has no crease. With uniform, random and adaptive
factors, all spacings, all constructions, with and without displacement. A mesh without texture coordinates
gets some in which every edge is a seam. Then closed meshes are drawn, and pixels counted in which not as many
layers face the eye as face away.

";

const EXAMPLES: &str = "\
.

Exit code 1 if anything differs; the first edge that does is named.

Examples:
  subdiv watertight --shape creature
  subdiv watertight model.glb --samples 1e8 --json";

described! {
    /// One way to draw the mesh.
    #[derive(Debug, Clone, Serialize)]
    struct Configuration {
        construction: &'static str,
        spacing: &'static str,
        factors: String,
        shared_normals: bool,
        displaced: bool,
        culled: bool,
        samples: u64,
        position_mismatches: u64,
        normal_mismatches: u64,
        leaked_pixels: Option<u64>,
    }
}

described! {
    #[derive(Serialize)]
    struct WatertightOut<'a> {
        mesh: String,
        device: &'a str,
        edges: usize,
        samples: u64,
        position_mismatches: u64,
        normal_mismatches: u64,
        leaked_pixels: Option<u64> = "null for a mesh with a boundary",
        configurations: &'a [Configuration],
    }
}

/// Faces of a mesh whose draws take longer than the pipelines that draw it.
const MANY_FACES: usize = 100_000;

/// Factors of a draw, and what they are called.
fn draws(seams_edges: usize, view: View, largest: f32, seed: u64) -> Vec<(String, CaptureDraw)> {
    let plain = |factor: f32| (format!("uniform {factor}"), CaptureDraw { view, ..CaptureDraw::new(factor) });
    let random = CaptureDraw {
        view,
        edge_factors: random_factors(seams_edges, largest, seed),
        ..CaptureDraw::new(Factor::Edges(1.0))
    };
    vec![
        plain(1.0),
        plain(5.0),
        plain(6.3),
        (format!("random, seed {seed}"), random),
        ("6 pixels".into(), CaptureDraw { view, ..CaptureDraw::new(Factor::Pixels(6.0)) }),
        ("bend 0.25 pixels".into(), CaptureDraw { view, ..CaptureDraw::new(Factor::Curvature(0.25)) }),
    ]
}

/// A model in one construction and spacing, with or without displacement.
struct Setup<'h> {
    options: ModelOptions,
    texture: Option<Texture>,
    captured: Captured<'h>,
    seams: Seams,
    scale: f32,
}

impl WatertightArgs {
    /// The constructions that differ.
    fn constructions(&self) -> &'static [Construction] {
        let by_leaves = self.source.adaptive().is_some_and(|adaptive| adaptive.drawn_by == DrawnBy::Leaves);
        if by_leaves { &Construction::ALL[..1] } else { &Construction::ALL }
    }

    fn options(&self, construction: Construction, spacing: Spacing, shared_normals: bool) -> ModelOptions {
        let options = self.source.model_options(Scheme::Gregory, construction);
        ModelOptions { spacing, shared_normals, edge_factors: true, ..options }
    }

    /// Options of every way to draw, and whether it is displaced.
    fn ways(&self) -> Vec<(ModelOptions, bool)> {
        let mut ways = Vec::new();
        for &construction in self.constructions() {
            for spacing in Spacing::ALL {
                for (shared_normals, displaced) in [(false, false), (true, false), (true, true)] {
                    ways.push((self.options(construction, spacing, shared_normals), displaced));
                }
            }
        }
        ways
    }

    /// Compares a mesh in every way to draw, in the order of [`WatertightArgs::ways`].
    fn compare_all(
        &self,
        headless: &Headless,
        mesh: &ControlMesh,
        seed: u64,
        closed: bool,
    ) -> Result<Vec<(Configuration, Tally)>, CliError> {
        let compare = |(options, displaced)| {
            let setup = self.setup(headless, mesh, options, displaced)?;
            self.compare(headless, mesh, &setup, seed, closed)
        };
        // Pipelines are made in parallel where they take longer than draws, whose tables and buffers take memory.
        let found: Result<Vec<_>, _> = match mesh.face_count() < MANY_FACES {
            true => self.ways().into_par_iter().map(compare).collect(),
            false => self.ways().into_iter().map(compare).collect(),
        };
        Ok(found?.into_iter().flatten().collect())
    }

    fn setup<'h>(
        &self,
        headless: &'h Headless,
        mesh: &ControlMesh,
        options: ModelOptions,
        displaced: bool,
    ) -> Result<Setup<'h>, CliError> {
        let texture = if displaced { Some(texture(headless, &scales()?)?) } else { None };
        let captured = match &texture {
            // SAFETY: the texture lives as long as the model, in one structure.
            Some(texture) => unsafe { Captured::displaced(headless, mesh, &options, texture.into())? },
            None => Captured::new(headless, mesh, &options)?,
        };
        let seams = Seams::new(mesh, captured.tables())?;
        let scale = if displaced { self.displacement_scale * diagonal(mesh) } else { 0.0 };
        Ok(Setup { options, texture, captured, seams, scale })
    }

    /// Views from two sides: of all of the mesh, and of a part of it through a longer lens.
    fn views(&self, mesh: &ControlMesh) -> [View; 2] {
        let [low, high] = mesh.bounds().map(|corner| corner.as_vec3());
        let (middle, radius) = ((low + high) / 2.0, (high - low).length() / 2.0);
        let eye = middle + Vec3::new(0.8, 0.3, -0.7).normalize() * (4.0 * radius);
        let target = middle + 0.2 * (high - middle);
        // Nothing is nearer or farther, wherever displacement moves it.
        let depths = [2.0 * radius, 7.0 * radius];
        let close = View::perspective(eye.into(), target.into(), [0.0, 1.0, 0.0], 0.2, 1.0, depths);
        let whole = View::framing(mesh.bounds(), [-0.6, 0.5, 1.0], 1.0);
        [whole, close].map(|view| view.sized(self.side, self.side))
    }
}

pub(super) fn run(args: &WatertightArgs, json: bool) -> Result<(), CliError> {
    let progress = Progress::new("reading the mesh");
    let (given, _) = Local::of(args.source.load(&progress)?)?;
    let mesh = if given.data().texcoords.is_some() { given } else { with_seams_everywhere(&given)? };
    let closed = mesh.boundary_edge_count() == 0 && mesh.data().holes.is_empty();
    progress.now("building tables");
    let (device, edges, configurations, first) = args.device.run(|headless| {
        let edges = {
            let tables = ModelTables::new(&mesh, &args.ways()[0].0)?;
            report_notices(tables.notices(), &progress);
            Seams::new(&mesh, &tables)?.edge_count()
        };
        progress.now("comparing");
        let mut configurations = Vec::new();
        let mut first = None;
        let mut samples = 0;
        for seed in 0.. {
            for (configuration, tally) in args.compare_all(headless, &mesh, seed, closed)? {
                samples += tally.samples;
                first = first.or(tally.first);
                configurations.push(configuration);
            }
            if samples >= args.samples || samples == 0 {
                break;
            }
        }
        Ok((headless.properties().name.clone(), edges, configurations, first))
    })?;
    drop(progress);
    let sum = |of: fn(&Configuration) -> u64| configurations.iter().map(of).sum::<u64>();
    let out = WatertightOut {
        mesh: args.source.name(),
        device: &device,
        edges,
        samples: sum(|c| c.samples),
        position_mismatches: sum(|c| c.position_mismatches),
        normal_mismatches: sum(|c| c.normal_mismatches),
        leaked_pixels: closed.then(|| sum(|c| c.leaked_pixels.unwrap_or(0))),
        configurations: &configurations,
    };
    if json {
        output::json_pretty(&out)?;
    } else {
        print(&out)?;
    }
    wrong(first, out.leaked_pixels).map_or(Ok(()), |message| Err(CliError::Work(message)))
}

/// Edges that are not watertight.
fn wrong(first: Option<Mismatch>, leaked_pixels: Option<u64>) -> Option<String> {
    match (first, leaked_pixels) {
        (Some(mismatch), _) => Some(tell(&mismatch)),
        (None, Some(pixels)) if pixels > 0 => Some(format!("{pixels} pixels leak")),
        _ => None,
    }
}

impl WatertightArgs {
    /// Compares a model with all factors, and from the second round on with random ones only.
    fn compare(
        &self,
        headless: &Headless,
        mesh: &ControlMesh,
        setup: &Setup,
        seed: u64,
        closed: bool,
    ) -> Result<Vec<(Configuration, Tally)>, CliError> {
        let mut found = Vec::new();
        let [whole, close] = self.views(mesh);
        let edges = setup.captured.tables().edges().map_or(0, |edges| edges.vertices.len());
        let shared_normals = setup.options.shared_normals;
        for (number, (factors, draw)) in draws(edges, whole, self.largest_factor, seed).into_iter().enumerate() {
            let random = matches!(draw.factor, Factor::Edges(_));
            if seed > 0 && !random {
                continue;
            }
            // One more view for what depends on it.
            let adaptive = matches!(draw.factor, Factor::Pixels(_) | Factor::Curvature(_));
            let views = if adaptive { vec![whole, close] } else { vec![whole] };
            for view in views {
                let culled = adaptive && view == close;
                let cull = if culled { Cull::ALL } else { Cull::NONE };
                let draw = CaptureDraw { view, cull, displacement: [setup.scale, 0.0], ..draw.clone() };
                let tally = watertight::compare(&setup.captured, &setup.seams, &draw, shared_normals)?;
                // Pictures of what differs most; back faces are layers, too, so they must stay.
                let look = closed && seed == 0 && number >= 2;
                let pictured = CaptureDraw { cull: Cull { back: false, ..cull }, ..draw };
                let leaked = if look {
                    let texture = setup.texture.as_ref();
                    Some(leaked_pixels(headless, mesh, &setup.options, texture, &pictured, self.side)?)
                } else {
                    None
                };
                let configuration = Configuration {
                    construction: setup.options.construction.name(),
                    spacing: setup.options.spacing.name(),
                    factors: factors.clone(),
                    shared_normals,
                    displaced: setup.texture.is_some(),
                    culled,
                    samples: tally.samples,
                    position_mismatches: tally.position_mismatches,
                    normal_mismatches: tally.normal_mismatches,
                    leaked_pixels: leaked,
                };
                found.push((configuration, tally));
            }
        }
        Ok(found)
    }
}

fn print(out: &WatertightOut) -> Result<(), CliError> {
    let mut table = Table::new(&[6, 7, 8, 9]);
    table.row::<10>([
        &"construction",
        &"spacing",
        &"factors",
        &"normals",
        &"displaced",
        &"culled",
        &"pairs",
        &"positions",
        &"normals",
        &"pixels",
    ]);
    let word = |yes: bool| if yes { "yes" } else { "" };
    for c in out.configurations {
        let pixels = c.leaked_pixels.map_or_else(String::new, |pixels| pixels.to_string());
        table.row::<10>([
            &c.construction,
            &c.spacing,
            &c.factors,
            &(if c.shared_normals { "shared" } else { "" }),
            &word(c.displaced),
            &word(c.culled),
            &c.samples,
            &c.position_mismatches,
            &c.normal_mismatches,
            &pixels,
        ]);
    }
    table.print()?;
    output::with_stdout(|stdout| {
        let WatertightOut { mesh, edges, samples, position_mismatches, normal_mismatches, device, .. } = out;
        let pixels = match out.leaked_pixels {
            Some(pixels) => format!("{pixels} pixels leak"),
            None => "not closed, so no pictures".into(),
        };
        Ok(writeln!(
            stdout,
            "{mesh}: {edges} edges, {samples} pairs compared: {position_mismatches} positions and {normal_mismatches} normals differ; {pixels}; on {device}"
        )?)
    })
}

fn tell(mismatch: &Mismatch) -> String {
    let Mismatch { vertices: [a, b], at, faces: [left, right], captured: [x, y] } = mismatch;
    let place = if a == b { format!("vertex {a}") } else { format!("edge {a}-{b}, at {at} of it") };
    if x == y {
        return format!("{place}: only face {left} has a vertex there");
    }
    format!(
        "{place}: faces {left} and {right} differ: positions {:?} and {:?}, normals {:?} and {:?}",
        x.position, y.position, x.normal, y.normal
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use ash_subdiv::capture::CapturedVertex;

    #[test]
    fn what_is_not_watertight_is_told() {
        let vertex = |x: f32| CapturedVertex {
            coordinate: [0.0, 0.5, 0.0],
            patch: 0,
            position: [x, 2.0, 3.0],
            normal: [0.0, 0.0, 1.0],
        };
        let mismatch = |vertices, captured| Mismatch { vertices, at: 0.25, faces: [4, 9], captured };
        let differ = mismatch([7, 8], [vertex(1.0), vertex(1.5)]);
        assert_eq!(
            wrong(Some(differ), Some(3)).unwrap(),
            "edge 7-8, at 0.25 of it: faces 4 and 9 differ: positions [1.0, 2.0, 3.0] and [1.5, 2.0, 3.0], \
             normals [0.0, 0.0, 1.0] and [0.0, 0.0, 1.0]"
        );
        let alone = mismatch([7, 7], [vertex(1.0), vertex(1.0)]);
        assert_eq!(wrong(Some(alone), None).unwrap(), "vertex 7: only face 4 has a vertex there");
        assert_eq!(wrong(None, Some(3)).unwrap(), "3 pixels leak");
        assert_eq!([wrong(None, Some(0)), wrong(None, None)], [None, None]);
    }
}
