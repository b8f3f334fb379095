//! `subdiv bench`: how long everything takes.
//!
//! | file | holds |
//! |---|---|
//! | `args`, `together` | what is asked for, and what of it goes together |
//! | `results`, `facts` | what was measured, and on what, as it is written and read |
//! | `columns` | the same as comma-separated values |
//! | `findings` | what rows say together |
//! | `text` | all of it as tables |
//! | `recorded` | what the host takes to record a frame |
//! | `presets` | what papers measured |
//! | `compare` | against results of another day |
//! | `report` | the same as one page, with plots |

mod args;
mod columns;
mod compare;
mod facts;
mod findings;
mod presets;
mod recorded;
mod report;
mod results;
mod text;
mod together;

use super::error::CliError;
use super::output::{self, Progress, note};
pub(super) use args::BenchArgs;
use args::Meshes;
use ash_subdiv::bench::{Bench, BenchError, BenchOptions, Contestant, Event, Subject};
use ash_subdiv::headless::Headless;
use ash_subdiv::measure::{ErrorOptions, surface_errors};
use ash_subdiv::{ControlMesh, Scheme, Spacing};
use facts::{DeviceOut, LeftOut, OptionsOut};
use findings::Findings;
use results::{Results, Row};
use std::collections::BTreeMap;
use std::path::Path;

pub(super) fn run(args: &BenchArgs, json: bool) -> Result<(), CliError> {
    let old = args.compare.as_deref().map(Results::read).transpose()?;
    let mut results = match &args.results {
        Some(path) => Results::read(path)?,
        None => args.measure(old.as_ref(), !json && !args.csv)?,
    };
    if let Some(preset) = args.preset {
        results.published = preset.beside(&results);
        results.preset = Some(preset.about(&results.published));
    }
    results.findings = Findings::of(&results.rows, &results.meshes);
    results.changes = old.map(|old| compare::changes(&old, &results)).transpose()?;
    if let Some(folder) = &args.report {
        args.prepare_report(folder)?.write(&results)?;
    }
    if json {
        return output::json_pretty(&results);
    }
    if args.csv {
        return output::with_stdout(|out| columns::write_csv(&results, out));
    }
    if args.results.is_some() {
        text::rows(&results.rows)?;
    }
    text::recording(&results.recording)?;
    text::findings(&results.findings)?;
    text::published(results.preset.as_ref(), &results.published)?;
    results.changes.as_deref().map_or(Ok(()), text::changes)
}

impl BenchArgs {
    /// Measures what can be set beside `old`; prints tables as they come if `show`.
    fn measure(&self, old: Option<&Results>, show: bool) -> Result<Results, CliError> {
        let contestants = self.contestants();
        if contestants.is_empty() {
            return Err(self.no_contestants());
        }
        if self.recording.is_some() && !contestants.iter().any(|contestant| contestant.path.is_recorded()) {
            return Err(CliError::Usage(recorded::none()));
        }
        let progress = Progress::new("reading meshes");
        let patches = self.patches.or(self.preset.map(|p| p.patches)).unwrap_or_default();
        let Meshes { originals, subjects } = self.meshes(patches)?;
        drop(progress);
        let (subjects, meshes): (Vec<_>, Vec<_>) = subjects.into_iter().unzip();
        self.in_vain(&contestants).iter().for_each(note);
        let options = BenchOptions {
            factors: self.factors(),
            size: self.size,
            single_sided: self.single_sided,
            instances: self.instances.or(self.preset.map(|p| p.instances)).unwrap_or(1),
            cameras: unique(&self.view, |&camera| camera),
            frames: self.frames,
            warm_up: self.warm_up,
            ..BenchOptions::default()
        };
        let about = OptionsOut::new(&options, unique(&self.passes, |&passes| passes), patches, self.refine);
        let races = self.races(&options);
        if let Some(old) = old {
            compare::check(old, &about, &meshes)?;
            compare::check_rows(old, &meshes, &races, &contestants)?;
        }
        let report = self.report.as_deref();
        report.map_or(Ok(()), |folder| self.prepare_report(folder).map(drop))?;
        let mut results = self.device.run(|headless| {
            let mut results = Results::new(DeviceOut::new(headless.properties()), about, meshes);
            if report.is_some() {
                for (subject, mesh) in subjects.iter().zip(&mut results.meshes) {
                    mesh.thumbnail = Some(report::thumbnail(headless, subject)?);
                }
            }
            match self.recording {
                Some(models) => recorded::record(headless, &subjects, &contestants, &options, models, &mut results)?,
                None => {
                    if report.is_some() {
                        self.find_normal_errors(&originals, &contestants, &mut results)?;
                    }
                    self.race(headless, &subjects, &contestants, &races, show, &mut results)?;
                }
            }
            Ok(results)
        })?;
        if results.rows.is_empty() && results.recording.is_empty() {
            let why = results.left_out.pop().map_or_else(String::new, |left| format!(": {}", left.why));
            return Err(CliError::Work(format!("nothing could be measured{why}")));
        }
        Ok(results)
    }

    /// Makes sure that the report can be written, and that it takes the place of nothing else.
    fn prepare_report<'f>(&self, folder: &'f Path) -> Result<report::Folder<'f>, CliError> {
        report::Folder::prepare(folder, self.compare.as_deref())
    }

    /// How far the normals of the schemes that are raced are from the limit surface's. Copies of a mesh are as far.
    fn find_normal_errors(
        &self,
        originals: &[(String, ControlMesh)],
        contestants: &[Contestant],
        results: &mut Results,
    ) -> Result<(), CliError> {
        let schemes = unique(contestants, |contestant| contestant.patches.map(|(scheme, _)| scheme));
        let schemes: Vec<Scheme> = schemes.into_iter().flatten().collect();
        if schemes.is_empty() {
            return Ok(());
        }
        let _progress = Progress::new("comparing with the limit surface");
        for (of, mesh) in originals {
            let errors = normal_errors(mesh, &schemes, self.refine)?;
            results.meshes.iter_mut().filter(|mesh| mesh.of == *of).for_each(|mesh| mesh.normal_error = errors.clone());
        }
        Ok(())
    }

    /// In what contestants are raced, one after the other.
    fn races(&self, options: &BenchOptions) -> Vec<BenchOptions> {
        let spacings: Vec<Spacing> =
            Spacing::ALL.into_iter().filter(|spacing| self.spacing.contains(spacing)).collect();
        let mut races = Vec::new();
        for motion in unique(&self.motion, |&motion| motion) {
            for passes in unique(&self.passes, |&passes| passes) {
                let race = |&spacing| BenchOptions { motion, passes, spacing, ..options.clone() };
                races.extend(spacings.iter().map(race));
            }
        }
        races
    }

    fn race(
        &self,
        headless: &Headless,
        subjects: &[Subject],
        contestants: &[Contestant],
        races: &[BenchOptions],
        show: bool,
        results: &mut Results,
    ) -> Result<(), CliError> {
        let frames = races.iter().map(|options| Ok(Bench::new(headless, options.clone())?.frames(contestants.len())));
        let frames = frames.sum::<Result<u64, BenchError>>()?;
        let progress = Progress::bar("drawing", frames * subjects.len() as u64);
        for subject in subjects {
            for options in races {
                let (mut printed, mut told) = (Ok(()), results.left_out.len());
                Bench::new(headless, options.clone())?.race(subject, contestants, |event| match event {
                    Event::Frames(frames) => progress.advance(frames),
                    Event::LeftOut(contestant, factor, error) => {
                        results.left_out.push(LeftOut::new(subject, options, contestant, factor, &error));
                    }
                    Event::Rows(rows) => {
                        results.left_out_notes(told).iter().for_each(|left| progress.note(left));
                        told = results.left_out.len();
                        let rows = Row::all(subject, options, &rows);
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

/// What there is, each once, in the order in which they first appear.
fn unique<'a, A, T: PartialEq>(all: &'a [A], of: impl Fn(&'a A) -> T) -> Vec<T> {
    let mut once = Vec::new();
    all.iter().map(of).for_each(|one| {
        if !once.contains(&one) {
            once.push(one);
        }
    });
    once
}

/// How far the normals of each scheme are from the limit surface's, where it has patches.
fn normal_errors(mesh: &ControlMesh, schemes: &[Scheme], refine: u32) -> Result<BTreeMap<String, f64>, CliError> {
    let options = ErrorOptions { refine, samples: 9, nearest: 0, ..ErrorOptions::default() };
    let report = surface_errors(mesh, schemes, &options)?;
    let measured = report.schemes.into_iter().filter_map(|(scheme, errors)| Some((scheme, errors.ok()?)));
    Ok(measured.map(|(scheme, errors)| (scheme.name().to_owned(), errors.all.normal.rms)).collect())
}
