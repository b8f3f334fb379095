//! The meshes that are drawn.

use super::super::error::CliError;
use super::super::output;
use super::super::source::notes;
use super::args::BenchArgs;
use super::facts::{MeshOut, sharpness_in_name};
use super::unique;
use ash_subdiv::bench::{Subject, Subset};
use ash_subdiv::mesh::{SHARPNESS_INFINITE, replicate, shape};
use ash_subdiv::{ControlMesh, MeshData};
use std::path::PathBuf;

/// A mesh before any copies are made.
pub(super) struct Original {
    pub name: String,
    pub mesh: ControlMesh,
    /// Of all creases, if it was given.
    sharpness: Option<f32>,
}

/// The meshes that are drawn.
pub(super) struct Meshes {
    pub originals: Vec<Original>,
    /// With the facts of each.
    pub subjects: Vec<(Subject, MeshOut)>,
}

impl BenchArgs {
    /// Meshes that are drawn.
    pub(super) fn meshes(&self, patches: Subset) -> Result<Meshes, CliError> {
        let originals = self.originals()?;
        let mut subjects = Vec::new();
        for Original { name: of, mesh, sharpness } in &originals {
            for copies in unique(&self.replicate, |&copies| copies) {
                let (name, mesh) = match copies {
                    1 => (of.clone(), mesh.clone()),
                    _ => {
                        let name = format!("{of} x{copies}");
                        let copied = replicate(mesh, block_of(copies), 1.25);
                        let copied = copied.map_err(|error| CliError::Work(format!("{name}: {error}")))?;
                        (name, copied)
                    }
                };
                let subject = Subject::new(&name, mesh, self.refine, patches)?;
                let told = MeshOut::new(&subject, of, *sharpness, copies);
                subjects.push((subject, told));
            }
        }
        Ok(Meshes { originals, subjects })
    }

    /// Reads files and makes shapes, with each sharpness that is asked for.
    fn originals(&self) -> Result<Vec<Original>, CliError> {
        let mut meshes = Vec::new();
        for path in unique(&self.mesh, |path| path) {
            // Without its folder, where that is enough.
            let name = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
            let alone = self.mesh.iter().all(|other| other == path || name(other) != name(path));
            let name = name(path).filter(|_| alone).unwrap_or_else(|| path.display().to_string());
            let (mesh, repairs) = self.reading.read(path, None)?;
            notes(&repairs).iter().for_each(|note| output::note(format_args!("{name}: {note}")));
            meshes.push((name, self.rules.apply(mesh)?));
        }
        let usual = [self.preset.map_or("creature", |preset| preset.shape).to_owned()];
        let shapes = if self.mesh.is_empty() && self.shape.is_empty() { &usual } else { &self.shape[..] };
        for name in unique(shapes, |name| name) {
            meshes.push((name.clone(), self.rules.apply(shape(name)?)?));
        }
        let sweep = self.sharpness_sweep();
        let mut originals = Vec::new();
        for (name, mesh) in meshes {
            if sweep.is_empty() {
                originals.push(Original { name, mesh, sharpness: None });
                continue;
            }
            let data = mesh.data();
            if !data.creases.iter().any(|crease| crease.sharpness < SHARPNESS_INFINITE) {
                let message = format!("{name}: it has no creases of finite sharpness: name a mesh that has");
                return Err(CliError::Work(message));
            }
            for &sharpness in &sweep {
                let name = name.clone() + &sharpness_in_name(sharpness);
                let mesh = sharpened(data.clone(), sharpness)?;
                originals.push(Original { name, mesh, sharpness: Some(sharpness) });
            }
        }
        Ok(originals)
    }

    /// Each sharpness that creases are to have, from the least; none if they are to be as they are.
    fn sharpness_sweep(&self) -> Vec<f32> {
        let preset = self.preset.map_or(&[][..], |preset| preset.sharpness);
        let mut sweep = if self.sharpness.is_empty() { preset.to_vec() } else { self.sharpness.clone() };
        sweep.sort_unstable_by(f32::total_cmp);
        sweep.dedup();
        sweep
    }
}

/// The mesh with all creases that are not infinitely sharp as sharp as this.
fn sharpened(mut data: MeshData, sharpness: f32) -> Result<ControlMesh, CliError> {
    let finite = data.creases.iter_mut().filter(|crease| crease.sharpness < SHARPNESS_INFINITE);
    finite.for_each(|crease| crease.sharpness = sharpness);
    data.creases.retain(|crease| crease.sharpness > 0.0);
    Ok(ControlMesh::new(data)?)
}

/// Copies as a block that is as near to a cube as the count allows.
fn block_of(copies: u32) -> [u32; 3] {
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
            assert_eq!(block_of(copies), block);
        }
        assert!((1..500).all(|n| block_of(n).iter().product::<u32>() == n));
    }
}
