//! What each control vertex follows.

use super::rig::{Pose, Rig};
use crate::mesh::MeshError;
use glam::{DMat4, DVec3};
use rayon::prelude::*;

/// A joint, by its place in the skin, and its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Influence {
    pub joint: u32,
    pub weight: f64,
}

/// A mesh at a node: its vertices share skin and morph weights.
#[derive(Debug, Clone, Default)]
pub(crate) struct Part {
    pub node: Option<u32>,
    pub skin: Option<u32>,
    /// By morph target: the control vertices that it moves, and by how much.
    pub targets: Vec<Vec<(u32, DVec3)>>,
}

/// What all control vertices follow.
#[derive(Debug, Clone, Default)]
pub(crate) struct Binding {
    parts: Vec<Part>,
    /// The part of each vertex.
    part_of: Vec<u32>,
    /// In the space of the part's mesh.
    positions: Vec<DVec3>,
    /// Of all vertices, one after the other. A skinned vertex without any stays.
    influences: Vec<Influence>,
    /// Where those of each vertex end.
    ends: Vec<usize>,
}

impl Binding {
    pub(crate) fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    pub(crate) fn add_part(&mut self, part: Part) {
        self.parts.push(part);
    }

    /// The part of this number, which was added.
    pub(crate) fn part_mut(&mut self, part: u32) -> &mut Part {
        &mut self.parts[part as usize]
    }

    /// Adds the next control vertex. The weights of its influences add up to one.
    pub(crate) fn add_vertex(&mut self, part: u32, position: DVec3, influences: &[Influence]) {
        self.part_of.push(part);
        self.positions.push(position);
        self.influences.extend_from_slice(influences);
        self.ends.push(self.influences.len());
    }

    /// Morphs and skins all vertices.
    pub(crate) fn positions<T: Send>(
        &self,
        rig: &Rig,
        pose: &Pose,
        out: &mut [T],
        of: impl Fn(DVec3) -> T + Sync,
    ) -> Result<(), MeshError> {
        let morphed = self.morphed(pose);
        let matrices: Vec<Vec<DMat4>> = self.parts.iter().map(|part| part.matrices(rig, pose)).collect();
        let move_to = |(vertex, out): (usize, &mut T)| {
            let part = self.part_of[vertex] as usize;
            let matrices = &matrices[part];
            let position = match self.parts[part].skin {
                None => matrices.iter().fold(morphed[vertex], |position, matrix| matrix.transform_point3(position)),
                Some(_) => self.skinned(vertex, morphed[vertex], matrices),
            };
            *out = of(position);
            // As the GPU sees it.
            match position.as_vec3().is_finite() {
                true => Ok(()),
                false => Err(MeshError::NotFinite { vertex: vertex as u32, position: position.into() }),
            }
        };
        out.par_iter_mut().enumerate().map(move_to).collect()
    }

    pub(super) fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The influences of each vertex, by the numbers of all parts' matrices in a row.
    pub(super) fn influences(&self, rig: &Rig) -> impl Iterator<Item = Vec<Influence>> {
        let count = |next: &mut u32, part: &Part| {
            let first = *next;
            *next += part.matrix_count(rig) as u32;
            Some(first)
        };
        let firsts: Vec<u32> = self.parts.iter().scan(0, count).collect();
        self.part_of.iter().enumerate().map(move |(vertex, &part)| {
            let (part, first) = (&self.parts[part as usize], firsts[part as usize]);
            match part.skin {
                None if part.node.is_none() => Vec::new(),
                None => vec![Influence { joint: first, weight: 1.0 }],
                Some(_) => self.of_joints(vertex).iter().map(|i| Influence { joint: first + i.joint, ..*i }).collect(),
            }
        })
    }

    /// The influences of a skinned vertex.
    fn of_joints(&self, vertex: usize) -> &[Influence] {
        let first = vertex.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.influences[first..self.ends[vertex]]
    }

    pub(super) fn morphed(&self, pose: &Pose) -> Vec<DVec3> {
        let mut positions = self.positions.clone();
        for part in &self.parts {
            let weights = part.node.map_or(&[][..], |node| &pose.weights[node as usize]);
            for (target, &weight) in part.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
                target.iter().for_each(|&(vertex, offset)| positions[vertex as usize] += weight * offset);
            }
        }
        positions
    }

    fn skinned(&self, vertex: usize, position: DVec3, matrices: &[DMat4]) -> DVec3 {
        let influences = self.of_joints(vertex);
        if influences.is_empty() {
            return position;
        }
        let moved = |i: &Influence| i.weight * matrices[i.joint as usize].transform_point3(position);
        influences.iter().map(moved).sum()
    }
}

impl Part {
    /// Number of [`Part::matrices`].
    fn matrix_count(&self, rig: &Rig) -> usize {
        self.skin.map_or(usize::from(self.node.is_some()), |skin| rig.skins[skin as usize].joints.len())
    }

    /// One a joint; without a skin that of the node, if there is one.
    pub(super) fn matrices(&self, rig: &Rig, pose: &Pose) -> Vec<DMat4> {
        let Some(skin) = self.skin else {
            return self.node.map(|node| pose.globals[node as usize]).into_iter().collect();
        };
        let skin = &rig.skins[skin as usize];
        skin.joints.iter().zip(&skin.inverse_binds).map(|(&joint, bind)| pose.globals[joint as usize] * bind).collect()
    }
}
