//! `subdiv bench`: how long everything takes.
//!
//! | file | holds |
//! |---|---|
//! | `results`, `facts` | what was measured, and on what, as it is written and read |
//! | `text` | the same as tables |
//! | `presets` | what papers measured |
//! | `compare` | against results of another day |
//! | `report` | the same as one page, with plots |

mod compare;
mod facts;
mod presets;
mod report;
mod results;
mod text;

use super::error::CliError;
use super::output::{self, Progress, note};
use super::parse;
use super::source::DeviceArgs;
use ash_subdiv::bench::{Bench, BenchOptions, Contestant, Event, Path, Subject, Subset};
use ash_subdiv::headless::Headless;
use ash_subdiv::measure::{ErrorOptions, surface_errors};
use ash_subdiv::mesh::{ReadOptions, read, replicate, shape};
use ash_subdiv::{Construction, ControlMesh, Scheme, Spacing};
use clap::Args;
use facts::{DeviceOut, LeftOut, MeshOut};
use presets::Preset;
use results::{Results, Row};
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = NOTES)]
pub(super) struct BenchArgs {
    /// Control meshes: files ending in .obj, .gltf or .glb.
    mesh: Vec<PathBuf>,
    /// A built-in shape, see `subdiv shapes`; several with commas. The creature if no mesh is given.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    shape: Vec<String>,
    /// Schemes, with commas; all if not given.
    #[arg(long, value_name = "SCHEME", value_delimiter = ',', value_parser = parse::scheme())]
    schemes: Vec<Scheme>,
    /// Constructions, with commas; all if not given.
    #[arg(long, value_name = "HOW", value_delimiter = ',', value_parser = parse::construction())]
    constructions: Vec<Construction>,
    /// Ways to draw, with commas; all if not given.
    #[arg(long, value_name = "PATH", value_delimiter = ',', value_parser = parse::path())]
    paths: Vec<Path>,
    /// Tessellation factors, with commas; 4,8,16,32 if not given.
    #[arg(long, value_name = "FACTOR", value_delimiter = ',', value_parser = parse::factor)]
    factors: Vec<f32>,
    /// Where the tessellator puts its vertices along an edge; several with commas.
    #[arg(long, value_delimiter = ',', default_value = "equal", value_parser = parse::spacing())]
    spacing: Vec<Spacing>,
    /// Which patches are drawn: all if not given.
    #[arg(long, value_name = "WHICH", value_parser = parse::subset())]
    patches: Option<Subset>,
    /// Draw the model this many times, side by side, with a transform each.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    instances: Option<u32>,
    /// Draw all again in this many passes of a frame, as for depth and shadows; cached control points are made once.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=64))]
    passes: u32,
    /// Make one large mesh of this many copies; several counts with commas, to see how time grows.
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "1", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    replicate: Vec<u32>,
    /// Steps of Catmull-Clark refinement before patches are made.
    #[arg(long, value_name = "STEPS", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=8))]
    refine: u32,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = parse::size)]
    size: [u32; 2],
    /// Frames of each row that count; at least 6.
    #[arg(long, value_name = "N", default_value_t = 21, value_parser = frames)]
    frames: u32,
    /// Frames of each row that go before.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=1000))]
    warm_up: u32,
    /// Measure what a paper measured, and set its figures beside.
    #[arg(long, value_name = "NAME", value_parser = presets::parser())]
    preset: Option<&'static Preset>,
    /// Write comma-separated values instead of tables.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Also write index.html, results.json and results.csv to this folder.
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Tell what became faster or slower since; what --json wrote.
    #[arg(long, value_name = "OLD.json")]
    compare: Option<PathBuf>,
    /// Do not measure: take what --json wrote.
    #[arg(
        long, value_name = "FILE.json",
        conflicts_with_all = ["mesh", "shape", "schemes", "constructions", "paths", "factors", "patches", "instances", "replicate", "spacing"]
    )]
    results: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Device")]
    device: DeviceArgs,
}

const NOTES: &str = "\
gpu:          milliseconds of a frame on the device, with pixels: median, and median distance from it.
geometry:     the same without rasterization.
x base:       the median of ratios to the first row, frame by frame, with the interval that holds it at 95 %.
construction: control points alone: factor 1 less the bilinear floor at factor 1, without rasterization.
set-up:       tables and upload, without pipelines.
Rows of one mesh and factor draw in turns, so that a machine that becomes slower does so for all.
`compute` evaluates once a frame into a vertex buffer that all passes draw; `instanced` draws one lattice for all patches, an
instance for each, which the vertex shader evaluates; in `geometry` the geometry shader evaluates, in `geometry-two-pass` it
makes control points for `instanced`. They go with the construction `cached`, `geometry` also with `stencil`.
Floors: `bilinear` passes corners through the tessellation stages, `vertex-buffer` draws what was evaluated before.

JSON: program, command, measured, device{name, driver, driver_info, vulkan, timestamp_period, processors}, options{size,
instances, passes, frames, warm_up, patches}, meshes[{name, vertices, faces, patches{kind}}], left_out[{mesh, scheme,
construction, path, spacing, factor, why}], rows[{mesh, scheme, construction, path, spacing, factor, patches,
tes_invocations, triangles, gpu_ms{median, min, max, mad}, geometry_ms{..}, setup_ms, bytes{name}, gpu_ratio{value, low,
high}, geometry_ratio{..}, construction_ms{..}, tables_ms, upload_ms, pipelines_ms, first_frame_ms, traffic_bytes{name},
fence_ms{gpu{..}, geometry{..}}, frames_ms{gpu[], geometry[]}}], published[], changes[].

Examples:
  subdiv bench --shape creature --factors 8,16
  subdiv bench model.obj --schemes gregory,acc --constructions two-stage --patches irregular
  subdiv bench --replicate 1,8,64,512 --factors 2 --paths tessellation --report growth
  subdiv bench --preset loop2009-table1
  subdiv bench model.obj --json > today.json; subdiv bench model.obj --compare today.json";

fn frames(text: &str) -> Result<u32, String> {
    let fits = |n: &u32| (6..=100_000).contains(n);
    text.parse().ok().filter(fits).ok_or_else(|| {
        "it must be a whole number from 6 to 100000: with fewer there is no interval that holds the median".into()
    })
}

pub(super) fn run(args: &BenchArgs, json: bool) -> Result<(), CliError> {
    let old = args.compare.as_deref().map(Results::read).transpose()?;
    let mut results = match &args.results {
        Some(path) => Results::read(path)?,
        None => args.measure(!json && !args.csv)?,
    };
    if let Some(preset) = args.preset {
        results.published = preset.beside(&results.rows);
    }
    results.changes = old.map(|old| compare::changes(&old, &results)).transpose()?;
    if let Some(folder) = &args.report {
        report::write(folder, &results)?;
    }
    if json {
        return output::json_pretty(&results);
    }
    if args.csv {
        return output::with_stdout(|out| results.write_csv(out));
    }
    if args.results.is_some() {
        text::rows(&results.rows)?;
    }
    text::grown(&results.rows)?;
    text::published(args.preset, &results.published)?;
    results.changes.as_deref().map_or(Ok(()), text::changes)
}

impl BenchArgs {
    /// What is asked for, else what the preset says, else everything.
    fn contestants(&self) -> Vec<Contestant> {
        fn pick<T: Copy + PartialEq>(given: &[T], preset: Option<&[T]>, all: &[T]) -> Vec<T> {
            let chosen = if given.is_empty() { preset.unwrap_or(all) } else { given };
            // Each once, in the order of the registry: the first row is what the others are compared with.
            all.iter().copied().filter(|one| chosen.contains(one)).collect()
        }
        Contestant::all(
            &pick(&self.paths, None, &Path::ALL),
            &pick(&self.schemes, self.preset.map(|p| p.schemes), &Scheme::ALL),
            &pick(&self.constructions, self.preset.map(|p| p.constructions), &Construction::ALL),
        )
    }

    fn factors(&self) -> Vec<f32> {
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

    fn subjects(&self, patches: Subset) -> Result<Vec<Subject>, CliError> {
        let mut meshes: Vec<(String, ControlMesh)> = Vec::new();
        for path in &self.mesh {
            // Without its folder, where that is enough.
            let name = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
            let alone = self.mesh.iter().filter(|other| name(other) == name(path)).count() == 1;
            let name = name(path).filter(|_| alone).unwrap_or_else(|| path.display().to_string());
            meshes.push((name, read(path, &ReadOptions::default())?));
        }
        let creature = ["creature".to_owned()];
        for name in if self.mesh.is_empty() && self.shape.is_empty() { &creature } else { &self.shape[..] } {
            meshes.push((name.clone(), shape(name)?));
        }
        let mut subjects = Vec::new();
        for (name, mesh) in meshes {
            for &copies in &self.replicate {
                let (name, mesh) = match copies {
                    1 => (name.clone(), mesh.clone()),
                    _ => (format!("{name} x{copies}"), replicate(&mesh, lattice(copies), 1.25)?),
                };
                subjects.push(Subject::new(&name, mesh, self.refine, patches)?);
            }
        }
        Ok(subjects)
    }

    /// Measures; prints tables as they come if `show`.
    fn measure(&self, show: bool) -> Result<Results, CliError> {
        let progress = Progress::new("reading meshes");
        let patches = self.patches.or(self.preset.map(|p| p.patches)).unwrap_or_default();
        let subjects = self.subjects(patches)?;
        drop(progress);
        let contestants = self.contestants();
        if contestants.is_empty() {
            let goes_with = |path: &Path| {
                let names: Vec<_> = path.evaluation()?.constructions().iter().map(|c| c.name()).collect();
                Some(format!("{} goes with {}", path.name(), names.join(" and ")))
            };
            let all: Vec<String> = self.paths.iter().filter_map(goes_with).collect();
            let message = format!("no path of --paths goes with --constructions: {}", all.join(", "));
            return Err(CliError::Usage(message));
        }
        let options = BenchOptions {
            factors: self.factors(),
            spacing: Spacing::Equal,
            size: self.size,
            instances: self.instances.or(self.preset.map(|p| p.instances)).unwrap_or(1),
            passes: self.passes,
            frames: self.frames,
            warm_up: self.warm_up,
        };
        let mut results = self.device.run(|headless| {
            let mut results = Results::new(DeviceOut::new(headless.properties()), &options, patches);
            for subject in &subjects {
                let mut mesh = MeshOut::new(subject);
                if self.report.is_some() {
                    mesh.thumbnail = Some(report::thumbnail(headless, subject)?);
                    mesh.normal_error = normal_errors(subject)?;
                }
                results.meshes.push(mesh);
            }
            self.race(headless, &subjects, &contestants, &options, show, &mut results)?;
            Ok(results)
        })?;
        if results.rows.is_empty() {
            let why = results.left_out.pop().map_or_else(String::new, |left| format!(": {}", left.why));
            return Err(CliError::Work(format!("nothing could be measured{why}")));
        }
        Ok(results)
    }

    fn race(
        &self,
        headless: &Headless,
        subjects: &[Subject],
        contestants: &[Contestant],
        options: &BenchOptions,
        show: bool,
        results: &mut Results,
    ) -> Result<(), CliError> {
        let spacings: Vec<Spacing> = parse::spacings().filter(|spacing| self.spacing.contains(spacing)).collect();
        let bench = |spacing| Bench::new(headless, BenchOptions { spacing, ..options.clone() });
        let frames = bench(Spacing::Equal)?.frames(contestants.len());
        let progress = Progress::bar("drawing", frames * (subjects.len() * spacings.len()) as u64);
        for subject in subjects {
            for &spacing in &spacings {
                let mut printed = Ok(());
                bench(spacing)?.race(subject, contestants, |event| match event {
                    Event::Frames(frames) => progress.advance(frames),
                    Event::LeftOut(contestant, factor, error) => {
                        let left = LeftOut::new(subject, contestant, spacing, factor, &error);
                        progress.suspend(|| note(&left));
                        results.left_out.push(left);
                    }
                    Event::Rows(rows) => {
                        let rows = Row::all(subject, spacing, rows);
                        if show && printed.is_ok() {
                            printed = progress.suspend(|| text::rows(&rows));
                        }
                        results.rows.extend(rows);
                    }
                })?;
                printed?;
            }
        }
        Ok(())
    }
}

/// How far the normals of each scheme are from the limit surface's, where it has patches.
fn normal_errors(subject: &Subject) -> Result<BTreeMap<String, f64>, CliError> {
    let options = ErrorOptions { refine: subject.refine, samples: 9, nearest: 0, ..ErrorOptions::default() };
    let report = surface_errors(&subject.mesh, &Scheme::ALL, &options)?;
    let measured = report.schemes.into_iter().filter_map(|(scheme, errors)| Some((scheme, errors.ok()?)));
    Ok(measured.map(|(scheme, errors)| (scheme.name().to_owned(), errors.all.normal.rms)).collect())
}

/// So many copies as a block that is as near to a cube as the count allows.
fn lattice(copies: u32) -> [u32; 3] {
    let divisor = |n: u32, root: f64| (1..=root.round() as u32).rev().find(|d| n.is_multiple_of(*d)).unwrap_or(1);
    let x = divisor(copies, f64::from(copies).cbrt());
    let rest = copies / x;
    let y = divisor(rest, f64::from(rest).sqrt());
    [rest / y, y, x]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_are_as_many_as_asked_for() {
        for (copies, block) in [(1, [1, 1, 1]), (8, [2, 2, 2]), (9, [3, 3, 1]), (64, [4, 4, 4]), (7, [7, 1, 1])] {
            assert_eq!(lattice(copies), block);
        }
        assert!((1..500).all(|n| lattice(n).iter().product::<u32>() == n));
    }
}
