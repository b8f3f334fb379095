//! What the host takes to record a frame of many models.

use super::super::error::CliError;
use super::super::output::Progress;
use super::facts::LeftOut;
use super::results::{Results, Times, Who};
use ash_subdiv::bench::{Bench, BenchOptions, Contestant, Path, Recording, Subject};
use ash_subdiv::headless::Headless;
use serde::{Deserialize, Serialize};

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Recorded {
    pub mesh: String,
    #[serde(flatten)]
    pub who: Who,
    /// What the models are: see `Crowd`.
    pub crowd: String,
    pub models: u32,
    pub prepare_ms: Times,
    pub draw_ms: Times,
    /// Both together.
    pub frame_ms: Times,
}

impl Recorded {
    /// `None` if no frame counts.
    fn new(subject: &Subject, contestant: Contestant, models: u32, recording: &Recording) -> Option<Self> {
        let Recording { crowd, prepare, draw } = recording;
        let frame: Vec<f64> = prepare.iter().zip(draw).map(|(prepare, draw)| prepare + draw).collect();
        Some(Self {
            mesh: subject.name.clone(),
            who: Who::new(contestant),
            crowd: crowd.name().to_owned(),
            models,
            prepare_ms: Times::of(prepare)?,
            draw_ms: Times::of(draw)?,
            frame_ms: Times::of(&frame)?,
        })
    }
}

/// That nothing of what is asked for can be recorded.
pub(super) fn none() -> String {
    let paths: Vec<_> = Path::ALL.into_iter().filter(|path| path.is_recorded()).map(Path::name).collect();
    format!("none of --paths is recorded by the renderer alone: name one of {}", paths.join(", "))
}

/// Records every contestant that the renderer records alone.
pub(super) fn record(
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
