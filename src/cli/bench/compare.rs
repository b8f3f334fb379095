//! Results of two days side by side.
//!
//! The frames of a run tell how sure a difference between two runs is, not what made it: between them, a machine drifts by
//! more than within each. The floors tell how far it did: they do not draw the surface. (They share the shaders of the view
//! and of the stages' outputs with what does: a change of those, or of the driver, counts as the machine's.)

use super::super::error::CliError;
use super::super::output::note;
use super::facts::{DeviceOut, MeshOut, OptionsOut};
use super::results::{GEOMETRY, GPU, Interval, Results, Row, Setting, Who};
use ash_subdiv::bench::{BenchOptions, Contestant};
use ash_subdiv::measure::statistics::{CONFIDENCE, change};
use serde::Serialize;

/// How a row changed, with pixels or without.
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
    /// That there is a difference between the frames of the two runs, from 0 to 1; whatever made it.
    pub confidence: f64,
    /// What the machine did between the two runs: new over old of all floors. From 1 to 1 if there are none, and for floors.
    pub machine: Range,
}

/// Of ratios; always with 1 in it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Range {
    pub low: f64,
    pub high: f64,
}

impl Range {
    const ONE: Self = Self { low: 1.0, high: 1.0 };

    fn with(self, Interval { low, high, .. }: Interval) -> Self {
        Self { low: self.low.min(low), high: self.high.max(high) }
    }
}

impl Change {
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

/// What the machine did, of both kinds of time; `None` without floors.
pub(super) fn machine(changes: &[Change]) -> Option<String> {
    changes.iter().find(|change| change.who.is_floor())?;
    let of = |what: &str| {
        let Range { low, high } = changes.iter().find(|c| c.what == what && !c.who.is_floor())?.machine;
        Some(format!("{what} {low:.2} to {high:.2}"))
    };
    let ranges: Vec<String> = [GPU, GEOMETRY].into_iter().filter_map(of).collect();
    (!ranges.is_empty()).then(|| format!("the machine itself, by its floors, new / old: {}", ranges.join(", ")))
}

/// That rows measured with these options on these meshes can be set beside the old ones.
pub(super) fn check(old: &Results, options: &OptionsOut, meshes: &[MeshOut]) -> Result<(), CliError> {
    if let Some((old, new)) = old.options.alike().into_iter().zip(options.alike()).find(|(old, new)| old != new) {
        return Err(CliError::Work(format!("the results to compare with are of {old}, these of {new}: measure alike")));
    }
    let names = |meshes: &[MeshOut]| meshes.iter().map(|mesh| mesh.name.clone()).collect::<Vec<_>>();
    let [before, now] = [&old.meshes, meshes].map(names);
    if !now.iter().any(|name| before.contains(name)) {
        let [before, now] = [before, now].map(|names| names.join(", "));
        let message = format!("the results to compare with are of {before}, these of {now}: measure the same meshes");
        return Err(CliError::Work(message));
    }
    let size = |mesh: &MeshOut| (mesh.vertices, mesh.faces, mesh.patches.clone());
    let other = |mesh: &&MeshOut| old.meshes.iter().any(|old| old.name == mesh.name && size(old) != size(mesh));
    if let Some(MeshOut { name, .. }) = meshes.iter().find(other) {
        let message = format!("{name}: the results to compare with are of another mesh of that name: measure the same");
        return Err(CliError::Work(message));
    }
    Ok(())
}

/// That there will be rows that both have, if these contestants are raced on these meshes.
pub(super) fn check_rows(
    old: &Results,
    meshes: &[MeshOut],
    races: &[BenchOptions],
    contestants: &[Contestant],
) -> Result<(), CliError> {
    let is_raced = |row: &Row| {
        meshes.iter().any(|mesh| mesh.name == row.setting.mesh)
            && races.iter().any(|race| row.setting.is_of(race) && race.factors.contains(&row.factor))
            && contestants.iter().any(|&contestant| row.who == Who::new(contestant))
    };
    if old.rows.iter().any(is_raced) { Ok(()) } else { Err(nothing_in_common()) }
}

fn nothing_in_common() -> CliError {
    let what =
        "the results to compare with have no row in common with these: measure the same meshes, paths and factors";
    CliError::Work(what.into())
}

/// The rows that both have.
///
/// Results that were measured otherwise are an error; on another device, or without floors, there is a note.
pub(super) fn changes(old: &Results, new: &Results) -> Result<Vec<Change>, CliError> {
    check(old, &new.options, &new.meshes)?;
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
        return Err(nothing_in_common());
    }
    if !changes.iter().any(|change| change.who.is_floor()) {
        note(
            "no floor is in both results, so a machine that became slower or faster looks like a change: measure \
             bilinear and vertex-buffer along with the other --paths, both times",
        );
    }
    for what in [GPU, GEOMETRY] {
        let (floors, others): (Vec<&mut Change>, _) =
            changes.iter_mut().filter(|change| change.what == what).partition(|change| change.who.is_floor());
        let machine = floors.iter().fold(Range::ONE, |range, floor| range.with(floor.ratio));
        others.into_iter().for_each(|change| change.machine = machine);
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
        machine: Range::ONE,
    })
}
