//! Changes of rows between two days.

use super::super::described::described;
use super::row::{GEOMETRY, GPU, Interval, Row, Setting, Who};
use ash_subdiv::measure::statistics::{CONFIDENCE, change};
use serde::Serialize;

described! {
    /// Change of a row, with pixels or without.
    #[derive(Debug, Serialize)]
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
        /// Confidence that the frames of the two runs differ, from 0 to 1; whatever made them.
        pub confidence: f64,
        /// Drift of the machine between the two runs: new over old of all floors. From 1 to 1 if there are none, and for floors.
        pub machine: Range,
    }
}

described! {
    /// Range of ratios; always with 1 in it.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize)]
    pub(super) struct Range {
        pub low: f64,
        pub high: f64,
    }
}

impl Range {
    pub(super) const ONE: Self = Self { low: 1.0, high: 1.0 };

    pub(super) fn with(self, Interval { low, high, .. }: Interval) -> Self {
        Self { low: self.low.min(low), high: self.high.max(high) }
    }
}

impl Change {
    /// A row that both have: with pixels or without.
    pub(super) fn new(old: &Row, new: &Row, what: &str) -> Option<Self> {
        let of = change(old.frames(what), new.frames(what))?;
        let median = |row: &Row| if what == GPU { row.gpu_ms.median } else { row.geometry_ms.median };
        Some(Self {
            setting: new.setting.clone(),
            who: new.who.clone(),
            factor: new.factor,
            what: what.to_owned(),
            old_ms: median(old),
            new_ms: median(new),
            ratio: of.ratio.into(),
            confidence: of.confidence,
            machine: Range::ONE,
        })
    }

    /// Faster or slower, if that is sure enough and more than the machine did; that it is no more, if it is sure that there is a
    /// difference.
    pub(super) fn verdict(&self) -> &'static str {
        match self.ratio {
            _ if self.confidence < CONFIDENCE => "the same",
            Interval { high, .. } if high < self.machine.low => "faster",
            Interval { low, .. } if low > self.machine.high => "slower",
            _ if self.machine != Range::ONE => "as the machine",
            _ => "the same",
        }
    }
}

/// Drift of the machine, of both kinds of time; `None` without floors.
pub(super) fn machine(changes: &[Change]) -> Option<String> {
    changes.iter().find(|change| change.who.is_floor())?;
    let of = |what: &str| {
        let Range { low, high } = changes.iter().find(|c| c.what == what && !c.who.is_floor())?.machine;
        Some(format!("{what} {low:.2} to {high:.2}"))
    };
    let ranges: Vec<String> = [GPU, GEOMETRY].into_iter().filter_map(of).collect();
    (!ranges.is_empty()).then(|| format!("the machine itself, by its floors, new / old: {}", ranges.join(", ")))
}
