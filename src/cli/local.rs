//! Space in which the device sees a mesh: the file's own, but for meshes that single precision cannot hold there.

use super::error::CliError;
use ash_subdiv::mesh::Change;
use ash_subdiv::{ControlMesh, MeshData};
use glam::DVec3;

/// Diagonals that are drawn as they are.
const DIAGONALS: std::ops::RangeInclusive<f64> = 1e-3..=1e6;
/// Distance from the origin up to which meshes are drawn where they are, in diagonals.
const FAR: f64 = 100.0;

/// A point of the file is the centre and size times the local point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Local {
    centre: DVec3,
    /// A power of two.
    size: f64,
}

impl Local {
    /// The file's own space.
    const FILE: Self = Self { centre: DVec3::ZERO, size: 1.0 };

    /// Takes a mesh into its local space.
    pub(super) fn of(mesh: ControlMesh) -> Result<(ControlMesh, Self), CliError> {
        let local = Self::around(mesh.bounds());
        Ok((local.take(mesh)?, local))
    }

    /// Takes a mesh into this space.
    pub(super) fn take(self, mesh: ControlMesh) -> Result<ControlMesh, CliError> {
        if self.is_file() {
            return Ok(mesh);
        }
        let mut data: MeshData = mesh.into_data();
        self.take_positions(&mut data.positions);
        for edit in &mut data.edits {
            match &mut edit.change {
                Change::Position { position, .. } => *position = self.to_local((*position).into()).into(),
                Change::Offset { offset, .. } | Change::FrameOffset { offset, .. } => {
                    *offset = offset.map(|x| x / self.size);
                }
                _ => {}
            }
        }
        Ok(ControlMesh::new(data)?)
    }

    /// Takes points of the file into this space.
    pub(super) fn take_positions(self, positions: &mut [[f64; 3]]) {
        if !self.is_file() {
            positions.iter_mut().for_each(|position| *position = self.to_local((*position).into()).into());
        }
    }

    /// The space for everything within these bounds.
    pub(super) fn around([low, high]: [DVec3; 2]) -> Self {
        // Halves, for sums may leave the range.
        let (centre, half) = (low / 2.0 + high / 2.0, (high / 2.0 - low / 2.0).length());
        let is_near = centre.abs().max_element() <= 2.0 * FAR * half;
        if !half.is_normal() || DIAGONALS.contains(&(2.0 * half)) && is_near {
            return Self::FILE;
        }
        Self { centre, size: half.log2().floor().exp2() }
    }

    /// Whether nothing changes.
    pub(super) fn is_file(&self) -> bool {
        *self == Self::FILE
    }

    /// A point of the file.
    pub(super) fn to_local(self, point: DVec3) -> DVec3 {
        (point - self.centre) / self.size
    }

    /// A local point, where the file has it.
    pub(super) fn in_file(self, point: DVec3) -> DVec3 {
        self.centre + self.size * point
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_meshes_stay_and_others_come_to_the_origin() {
        let bounds = |middle: f64, size: f64| [DVec3::splat(middle - size), DVec3::splat(middle + size)];
        for (middle, size) in [(0.0, 1.0), (50.0, 1.0), (0.0, 0.01), (-3e4, 1e4), (2.0, 0.0)] {
            assert!(Local::around(bounds(middle, size)).is_file(), "{middle} {size}");
        }
        for (middle, size) in [(0.0, 1e-10), (0.0, 1e10), (5e6, 10.0), (0.0, 1e37), (0.0, 1e-30)] {
            let bounds = bounds(middle, size);
            let local = Local::around(bounds);
            let [low, high] = bounds.map(|corner| local.to_local(corner));
            assert!((2.0..8.0).contains(&(high - low).length()) && (low + high).length() < 1e-6, "{local:?}");
            let back = local.in_file(high);
            assert!((back - bounds[1]).length() <= 1e-15 * bounds[1].length(), "{back}");
        }
    }
}
