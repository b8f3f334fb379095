//! Arguments of `subdiv bench`.

use super::super::cull::{CullArg, cull};
use super::super::described::help;
use super::super::parse;
use super::super::rules::RulesArgs;
use super::super::source::{DeviceArgs, ReadingArgs};
use super::presets::{self, Preset};
use super::results::Results;
use ash_subdiv::adaptive::{DrawnBy, Sums};
use ash_subdiv::bench::{Camera, Contestant, Creases, CullBy, Motion, Normals, Path, Subset};
use ash_subdiv::renderer::Cull;
use ash_subdiv::{Construction, Scheme, Spacing};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = help::<Results>(NOTES, EXAMPLES), allow_negative_numbers = true)]
pub(in super::super) struct BenchArgs {
    /// Control meshes: files ending in .obj, .ply, .gltf or .glb.
    pub(super) mesh: Vec<PathBuf>,
    /// A built-in shape, see `subdiv shapes`; several with commas. The creature if no mesh is given.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub(super) shape: Vec<String>,
    #[command(flatten)]
    pub(super) reading: ReadingArgs,
    #[command(flatten)]
    pub(super) rules: RulesArgs,
    /// Schemes, with commas; all if not given.
    #[arg(long, value_name = "SCHEME", value_delimiter = ',', value_parser = parse::one_of(Scheme::ALL, Scheme::name))]
    pub(super) schemes: Vec<Scheme>,
    /// Constructions, with commas; all if not given.
    #[arg(long, value_name = "HOW", value_delimiter = ',', value_parser = parse::one_of(Construction::ALL, Construction::name))]
    pub(super) constructions: Vec<Construction>,
    /// Ways to draw, with commas; all if not given.
    #[arg(long, value_name = "PATH", value_delimiter = ',', value_parser = parse::one_of(Path::ALL, Path::name))]
    pub(super) paths: Vec<Path>,
    /// Where normals come from, with commas: those that patches share cost time. For watertight schemes.
    #[arg(long, value_name = "WHICH", value_delimiter = ',', default_value = "own", value_parser = parse::one_of(Normals::ALL, Normals::name))]
    pub(super) normals: Vec<Normals>,
    /// Measure each row of gregory and gregory-fitted again as adaptive surfaces of these depths, with commas.
    #[arg(long, value_name = "DEPTH", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(0..=10))]
    pub(super) adaptive: Vec<u32>,
    /// With --adaptive: how creases of finite sharpness are followed, with commas. `direct` has leaves that follow them and caps of
    /// the depth at their ends; `deep` has caps there as deep as the sharpest crease asks for; `refined` refines faces along
    /// them as often.
    #[arg(long, value_name = "HOW", value_delimiter = ',', value_parser = parse::one_of(Creases::ALL, Creases::name))]
    pub(super) creases: Vec<Creases>,
    /// With --adaptive: what refined vertices are sums of, with commas: `levels`, of those one level above, in a step for each
    /// level; `composed`, of control vertices, all at once.
    #[arg(long, value_name = "OF", value_delimiter = ',', default_value = "levels", value_parser = parse::one_of(Sums::ALL, Sums::name))]
    pub(super) sums: Vec<Sums>,
    /// With --adaptive: patches, with commas: one a face (`faces`) or one a leaf (`leaves`, on paths with tessellation stages).
    #[arg(long, value_name = "WHAT", value_delimiter = ',', default_value = "faces", value_parser = parse::one_of(DrawnBy::ALL, DrawnBy::name))]
    pub(super) by: Vec<DrawnBy>,
    /// Measure each row of the tessellation stages and of instances again with patches culled that are not seen: `back`
    /// those that face away, `frustum` those out of the picture, `small` those between pixels.
    #[arg(long, value_name = "WHICH", value_delimiter = ',', value_enum)]
    pub(super) cull: Vec<CullArg>,
    /// Stages that cull them, with commas: the control shader of each draw, or compute before the draws. If not given, compute for
    /// `cached`, the control shader for other constructions.
    #[arg(long, value_name = "WHAT", value_delimiter = ',', requires = "cull", value_parser = parse::one_of(CullBy::ALL, CullBy::name))]
    cull_by: Vec<CullBy>,
    /// Tessellation factors, with commas; 4,8,16,32 if not given.
    #[arg(long, value_name = "FACTOR", value_delimiter = ',', value_parser = parse::factor)]
    factors: Vec<f32>,
    /// Where the tessellator puts its vertices along an edge; several with commas.
    #[arg(long, value_delimiter = ',', default_value = "equal", value_parser = parse::one_of(Spacing::ALL, Spacing::name))]
    pub(super) spacing: Vec<Spacing>,
    /// Patches that are drawn: all if not given.
    #[arg(long, value_name = "WHICH", value_parser = parse::one_of(Subset::ALL, Subset::name))]
    pub(super) patches: Option<Subset>,
    /// Draw the model this many times, side by side, with a transform each.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(super) instances: Option<u32>,
    /// Draw all again in this many passes of a frame, as for depth and shadows; cached control points are made once.
    /// Several counts with commas, to see from how many on it pays to evaluate once, by compute.
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "1", value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(super) passes: Vec<u32>,
    /// Whether the control vertices move, with commas: if not, cached control points and vertices made by compute are kept.
    #[arg(long, value_name = "WHETHER", value_delimiter = ',', default_value = "moving", value_parser = parse::one_of(Motion::ALL, Motion::name))]
    pub(super) motion: Vec<Motion>,
    /// Where the eye is, with commas: `clipped` shows the middle three times as large, and cuts off what is around.
    #[arg(long, value_name = "WHERE", value_delimiter = ',', default_value = "fit", value_parser = parse::one_of(Camera::ALL, Camera::name))]
    pub(super) view: Vec<Camera>,
    /// Have the rasterizer cull triangles that face away, as renderers do of closed models. Some drivers, lavapipe among
    /// them, then count fewer of what clipping leaves: compare views without it.
    #[arg(long)]
    pub(super) single_sided: bool,
    /// Give all creases this sharpness, but for those that are infinitely sharp; several with commas, to see how time and bytes
    /// grow. 0 takes them away.
    #[arg(long, value_name = "SHARPNESS", value_delimiter = ',', value_parser = parse::sharpness)]
    pub(super) sharpness: Vec<f32>,
    /// Make one large mesh of this many copies; several counts with commas, to see how time grows.
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "1", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(super) replicate: Vec<u32>,
    /// Steps of Catmull-Clark refinement before patches are made.
    #[arg(long, value_name = "STEPS", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=8))]
    pub(super) refine: u32,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = parse::size)]
    pub(super) size: [u32; 2],
    /// Frames of each row that count; at least 6.
    #[arg(long, value_name = "N", default_value_t = 21, value_parser = frames)]
    pub(super) frames: u32,
    /// Frames of each row that go before.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub(super) warm_up: u32,
    /// Measure instead how long the host takes to record a frame of this many models: of one model drawn as often, of as
    /// many models, and of as many whose vertices move; with --cull, also where compute looks what is seen.
    #[arg(long, value_name = "MODELS", conflicts_with_all = ["preset", "compare", "results", "factors", "spacing", "instances", "passes", "motion", "view"], value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(super) recording: Option<u32>,
    /// Measure what a paper measured, and set its figures beside.
    #[arg(long, value_name = "NAME", value_parser = presets::parser())]
    pub(super) preset: Option<&'static Preset>,
    /// Write comma-separated values instead of tables.
    #[arg(long, conflicts_with = "json")]
    pub(super) csv: bool,
    /// Also write index.html, results.json and results.csv to this folder.
    #[arg(long, value_name = "DIR")]
    pub(super) report: Option<PathBuf>,
    /// Report what became faster or slower since, by more than the floors did; what --json wrote.
    #[arg(long, value_name = "OLD.json")]
    pub(super) compare: Option<PathBuf>,
    /// Do not measure: take what --json wrote.
    #[arg(
        long, value_name = "FILE.json",
        conflicts_with_all = ["mesh", "shape", "strict", "weld", "rebuild_quads", "drop_isolated", "schemes", "constructions", "paths", "normals", "adaptive", "creases", "sums", "by", "cull", "cull_by", "factors", "patches", "instances", "passes", "motion", "view", "single_sided", "sharpness", "replicate", "refine", "spacing", "size", "frames", "warm_up"]
    )]
    pub(super) results: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Device")]
    pub(super) device: DeviceArgs,
}

const NOTES: &str = "\
gpu:          milliseconds of a frame on the device, with pixels: median, and median distance
              from it.
geometry:     the same without rasterization.
x base:       the median of ratios to the first row, frame by frame, with the interval that holds
              it at 95 %.
construction: control points alone: factor 1 less the bilinear floor at factor 1, without
              rasterization; of paths with the tessellation stages, as the floor.
set-up:       tables and upload, without pipelines; the median of several.
triangles:    before clipping; of grids drawn as strips (on lavapipe, of quads from 14 segments
              on) with those that join rows, of no area.
sure:         of --compare: that the frames of both runs differ, whatever made them. It does not
              know that machines drift between runs; floors, which do not draw the surface, tell
              by how much: `faster` and `slower` are rows whose interval is wholly outside of what
              the intervals of all floors reach (floors themselves: not around 1); those that
              differ by no more are `as the machine`. Measure floors along, at several factors:
              few reach less far than the machine may drift.
Patches, triangles and times are of a frame: of all its instances and passes.
Rows of one mesh and factor draw in turns, so that a machine that becomes slower does so for all.

`compute` evaluates once a frame into a vertex buffer that all passes draw; `instanced` draws one
uniform grid for all patches, an instance for each, which the vertex shader evaluates; in `geometry` the
geometry shader evaluates, in `geometry-two-pass` it makes control points for `instanced`. They go
with the construction `cached`, `geometry` also with `stencil`.
`acc-published` is ACC as first published: its evaluation shader makes the tangents, at every
vertex, that `tessellation` makes once a patch. The same surface, with the scheme acc and the
construction two-stage; `acc-published-instanced` likewise with `cached`, to be compared with
`instanced`.
`subdivision` refines faces in a geometry shader, at factors 1, 2, 4 and 8: levels 0 to 3.
The path `cpu` fills its vertices on the CPU: in frames by the host's clock, not in device times;
its factors are rounded up to a power of two.
Floors: `bilinear` passes corners through the tessellation stages, `vertex-buffer` draws what was
evaluated before.
--cull is for `tessellation` and `instanced`: with `cached`, compute shaders cull patches
before they are drawn, else the control shader does. What --cull-by has otherwise is named, as
`back by compute`.
Of several views, the time of a triangle that clipping leaves is set beside that in the first. Of
several counts of passes, `compute wins from so many passes on` says where its time and that of
tessellating in every pass cross. Of copies of a mesh (--replicate), `time grows as` says by which
power of patches. Of a mesh at several --sharpness, time and bytes are set beside those at the
least. `more` is more than what was measured can tell.

";

const EXAMPLES: &str = "\
.

Examples:
  subdiv bench --shape creature --factors 8,16
  subdiv bench model.obj --schemes gregory,acc --constructions two-stage --patches irregular
  subdiv bench --replicate 1,8,64,512 --factors 2 --paths tessellation --report growth
  subdiv bench --paths tessellation,compute --passes 1,2,3,4
  subdiv bench --paths tessellation,bilinear --normals own,shared --cull frustum --view fit,clipped
  subdiv bench --recording 1000
  subdiv bench --preset loop2009-table1
  subdiv bench model.obj --preset niessner2012
  subdiv bench model.obj --paths tessellation,bilinear,vertex-buffer --json > today.json
  subdiv bench model.obj --paths tessellation,bilinear,vertex-buffer --compare today.json";

fn frames(text: &str) -> Result<u32, String> {
    let fits = |n: &u32| (6..=100_000).contains(n);
    text.parse().ok().filter(fits).ok_or_else(|| {
        "it must be a whole number from 6 to 100000: with fewer there is no interval that holds the median".into()
    })
}

impl BenchArgs {
    /// Contestants that are asked for, else those of the preset, else everything; without a choice of normals and culling.
    pub(super) fn plain_contestants(&self) -> Vec<Contestant> {
        Contestant::all(
            &pick(&self.paths, self.preset.map(|p| p.paths), &Path::ALL),
            &pick(&self.schemes, self.preset.map(|p| p.schemes), &Scheme::ALL),
            &pick(&self.constructions, self.preset.map(|p| p.constructions), &Construction::ALL),
        )
    }

    /// The same with all normals and culling that are asked for.
    pub(super) fn contestants(&self) -> Vec<Contestant> {
        let all = self.plain_contestants();
        let normals = pick(&self.normals, None, &Normals::ALL);
        let mut culls = vec![Cull::NONE, cull(&self.cull)];
        culls.dedup();
        let cull_by = pick(&self.cull_by, Some(&[]), &CullBy::ALL);
        let depths = if self.adaptive.is_empty() { self.preset.map_or(&[][..], |p| p.depths) } else { &self.adaptive };
        let creases = pick(&self.creases, Some(self.preset.map_or(&[Creases::Direct], |p| p.creases)), &Creases::ALL);
        let sums = pick(&self.sums, None, &Sums::ALL);
        let by = pick(&self.by, None, &DrawnBy::ALL);
        let adaptive = all.into_iter().flat_map(|contestant| contestant.at_depths(depths, &creases, &sums, &by));
        adaptive.flat_map(|contestant| contestant.variants(&normals, &culls, &cull_by)).collect()
    }

    pub(super) fn factors(&self) -> Vec<f32> {
        let given = if self.factors.is_empty() {
            self.preset.map_or(&[4.0, 8.0, 16.0, 32.0][..], |p| p.factors)
        } else {
            &self.factors
        };
        let mut factors = given.to_vec();
        factors.sort_unstable_by(f32::total_cmp);
        factors.dedup();
        factors
    }
}

/// What is given, else what the preset says, else all: each once, in the order of the registry, for the first row is what the
/// others are compared with.
fn pick<T: Copy + PartialEq>(given: &[T], preset: Option<&[T]>, all: &[T]) -> Vec<T> {
    let chosen = if given.is_empty() { preset.unwrap_or(all) } else { given };
    all.iter().copied().filter(|one| chosen.contains(one)).collect()
}
