//! Results of two days side by side.
//!
//! The frames of a run say how sure a difference between two runs is, not what made it: between them, a machine drifts by
//! more than within each. The floors say how far it did: they do not draw the surface. (They share the shaders of the view
//! and of the stages' outputs with what does: a change of those, or of the driver, counts as the machine's.)

use super::super::error::CliError;
use super::super::output::note;
use super::change::{Change, Range};
use super::facts::{DeviceOut, MeshOut, OptionsOut};
use super::results::Results;
use super::row::{GEOMETRY, GPU, Row, Who};
use ash_subdiv::bench::{BenchOptions, Contestant};

/// Checks that rows measured with these options on these meshes can be set beside the old ones.
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

/// Checks that there will be rows that both have, if these contestants are raced on these meshes.
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
            before.into_iter().flat_map(|before| [GPU, GEOMETRY].map(|what| Change::new(before, row, what))).flatten(),
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
