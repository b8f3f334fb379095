//! Results of two days side by side.

use super::super::error::CliError;
use super::super::output::note;
use super::facts::DeviceOut;
use super::results::{GEOMETRY, GPU, Interval, Results, Row, Setting, Who};
use ash_subdiv::measure::statistics::{CONFIDENCE, change};
use serde::{Deserialize, Serialize};

/// How a row changed, with pixels or without.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Change {
    #[serde(flatten)]
    pub setting: Setting,
    #[serde(flatten)]
    pub who: Who,
    pub factor: f32,
    /// `gpu` or `geometry`.
    pub what: String,
    pub old_ms: f64,
    pub new_ms: f64,
    /// New over old.
    pub ratio: Interval,
    /// That there is a difference, from 0 to 1.
    pub confidence: f64,
}

impl Change {
    /// Faster or slower, if that is sure enough.
    pub(super) fn verdict(&self) -> &'static str {
        match self.ratio {
            _ if self.confidence < CONFIDENCE => "the same",
            Interval { high, .. } if high < 1.0 => "faster",
            Interval { low, .. } if low > 1.0 => "slower",
            _ => "the same",
        }
    }
}

/// The rows that both have.
///
/// Results that were measured otherwise are an error; on another device, there is a note.
pub(super) fn changes(old: &Results, new: &Results) -> Result<Vec<Change>, CliError> {
    if let Some((old, new)) = old.options.alike().into_iter().zip(new.options.alike()).find(|(old, new)| old != new) {
        return Err(CliError::Work(format!("the results to compare with are of {old}, these of {new}: measure alike")));
    }
    let [before, now] = [&old.device, &new.device].map(DeviceOut::title);
    if before != now {
        note(format_args!("the results to compare with are of another device: {before}, not {now}"));
    }
    let mut changes = Vec::new();
    for row in &new.rows {
        let before = old.rows.iter().find(|before| before.is_beside(row) && before.who == row.who);
        changes.extend(
            before.into_iter().flat_map(|before| [GPU, GEOMETRY].map(|what| of_row(before, row, what))).flatten(),
        );
    }
    if changes.is_empty() {
        let what = "the results to compare with have no row in common with these: measure the same meshes and factors";
        return Err(CliError::Work(what.into()));
    }
    Ok(changes)
}

fn of_row(old: &Row, new: &Row, what: &str) -> Option<Change> {
    let of = change(old.frames(what), new.frames(what))?;
    let median = |row: &Row| if what == GPU { row.gpu_ms.median } else { row.geometry_ms.median };
    Some(Change {
        setting: new.setting.clone(),
        who: new.who.clone(),
        factor: new.factor,
        what: what.to_owned(),
        old_ms: median(old),
        new_ms: median(new),
        ratio: of.ratio.into(),
        confidence: of.confidence,
    })
}
