//! Recordings: the host's times for a frame of many models.

use super::super::described::described;
use super::row::{Times, Who};
use ash_subdiv::bench::{Contestant, Path, Recording, Subject};
use serde::{Deserialize, Serialize};

described! {
    #[derive(Debug, Serialize, Deserialize)]
    pub(super) struct Recorded {
        pub mesh: String,
        #[serde(flatten)]
        pub who: Who,
        /// Crowd of models: see `Crowd`.
        pub crowd: String,
        pub models: u32,
        pub prepare_ms: Times,
        pub draw_ms: Times,
        /// Both together.
        pub frame_ms: Times,
    }
}

impl Recorded {
    /// `None` if no frame counts.
    pub(super) fn new(subject: &Subject, contestant: Contestant, models: u32, recording: &Recording) -> Option<Self> {
        let Recording { crowd, prepare, draw, .. } = recording;
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

/// Message where nothing of what is asked for can be recorded.
pub(super) fn none() -> String {
    let paths: Vec<_> = Path::ALL.into_iter().filter(|path| path.is_recorded()).map(Path::name).collect();
    format!("none of --paths is recorded by the renderer alone: name one of {}", paths.join(", "))
}
