//! The measurement: what is raced and recorded becomes results.

use super::super::error::CliError;
use super::super::output::{Progress, note};
use super::args::BenchArgs;
use super::facts::{DeviceOut, LeftOut, OptionsOut};
use super::meshes::{Meshes, Original};
use super::recorded::{self, Recorded};
use super::results::Results;
use super::row::{Row, Who};
use super::{compare, report, text, unique};
use ash_subdiv::bench::{Bench, BenchError, BenchOptions, Contestant, Event, Recording, Subject};
use ash_subdiv::headless::Headless;
use ash_subdiv::measure::{ErrorOptions, FaceErrors, SchemeError, surface_errors};
use ash_subdiv::{ControlMesh, Spacing};
use std::collections::BTreeMap;
use std::path::Path;

impl BenchArgs {
    /// Measures what can be set beside `old`; prints tables as they come if `show`.
    pub(super) fn measure(&self, old: Option<&Results>, show: bool) -> Result<Results, CliError> {
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
                Some(models) => record(headless, &subjects, &contestants, &options, models, &mut results)?,
                None => {
                    if report.is_some() {
                        self.find_errors(&originals, &contestants, &mut results)?;
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
    pub(super) fn prepare_report<'f>(&self, folder: &'f Path) -> Result<report::Folder<'f>, CliError> {
        report::Folder::prepare(folder, self.compare.as_deref())
    }

    /// Measures the surfaces that are raced against the limit surface. Copies of a mesh are as far.
    fn find_errors(
        &self,
        originals: &[Original],
        contestants: &[Contestant],
        results: &mut Results,
    ) -> Result<(), CliError> {
        let surfaces: Vec<Contestant> = contestants.iter().filter(|one| one.patches.is_some()).copied().collect();
        if surfaces.is_empty() {
            return Ok(());
        }
        let _progress = Progress::new("comparing with the limit surface");
        for Original { name: of, mesh, .. } in originals {
            let errors = errors(mesh, &surfaces, self.refine)?;
            for mesh in results.meshes.iter_mut().filter(|mesh| mesh.of == *of) {
                mesh.normal_error = errors.iter().map(|(name, errors)| (name.clone(), errors.normal.rms)).collect();
                mesh.position_error = errors.iter().map(|(name, errors)| (name.clone(), errors.position.rms)).collect();
            }
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

/// Records every contestant that the renderer records alone.
fn record(
    headless: &Headless,
    subjects: &[Subject],
    contestants: &[Contestant],
    options: &BenchOptions,
    models: u32,
    results: &mut Results,
) -> Result<(), CliError> {
    let recorded = |contestant: &&Contestant| contestant.path.is_recorded();
    let contestants: Vec<Contestant> = contestants.iter().filter(recorded).copied().collect();
    let progress = Progress::bar("recording", (subjects.len() * contestants.len()) as u64);
    let bench = Bench::new(headless, options.clone())?;
    for subject in subjects {
        let told = results.left_out.len();
        for &contestant in &contestants {
            match bench.recording(subject, contestant, models) {
                Err(error) if error.leaves_out() => {
                    results.left_out.push(LeftOut::new(subject, options, contestant, None, &error));
                }
                recordings => {
                    let of = |recording: &Recording| Recorded::new(subject, contestant, models, recording);
                    results.recording.extend(recordings?.iter().filter_map(of));
                }
            }
            progress.advance(1);
        }
        results.left_out_notes(told).iter().for_each(|left| progress.note(left));
    }
    Ok(())
}

/// Samples of the limit surface, about: a second's work or two.
const SAMPLES: f64 = 1.5e6;

/// Rounding of `f32`: no smaller error is told.
const ROUNDING: f64 = 1e-7;

/// Errors of each surface against the limit surface by its name, where the scheme has patches.
fn errors(
    mesh: &ControlMesh,
    contestants: &[Contestant],
    refine: u32,
) -> Result<BTreeMap<String, FaceErrors>, CliError> {
    let samples = ((SAMPLES / mesh.face_count().max(1) as f64).sqrt() as u32).clamp(9, 33);
    let mut errors = BTreeMap::new();
    for adaptive in unique(contestants, |one| one.adaptive_options(mesh, refine)) {
        let alike = contestants.iter().filter(|one| one.adaptive_options(mesh, refine) == adaptive);
        let alike: Vec<_> = alike.filter_map(|&one| Some((one, one.patches?.0))).collect();
        let options = ErrorOptions { refine, adaptive, samples, nearest: 0, ..ErrorOptions::default() };
        let report = surface_errors(mesh, &unique(&alike, |&(_, scheme)| scheme), &options)?;
        for (contestant, scheme) in alike {
            let measured = report.schemes.iter().find(|(of, _)| *of == scheme);
            if let Some(&(_, Ok(SchemeError { mut all, .. }))) = measured {
                [&mut all.position.rms, &mut all.normal.rms].into_iter().for_each(|rms| *rms = rms.max(ROUNDING));
                errors.insert(Who::new(contestant).surface(), all);
            }
        }
    }
    Ok(errors)
}
