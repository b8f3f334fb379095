//! Nodes, skins, and the pose at a time.

use super::keys::{Keys, unit};
use glam::{DMat4, DQuat, DVec3};

/// A node's transform into the space of its parent.
#[cfg_attr(not(feature = "gltf"), allow(dead_code, reason = "only files have matrices"))]
#[derive(Debug, Clone, Copy)]
pub(crate) enum Placement {
    Matrix(DMat4),
    Parts { translation: DVec3, rotation: DQuat, scale: DVec3 },
}

impl Placement {
    pub(crate) fn matrix(self) -> DMat4 {
        match self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                DMat4::from_scale_rotation_translation(scale, unit(rotation), translation)
            }
        }
    }

    /// In parts, of which one is to move.
    fn parts(self) -> (DVec3, DQuat, DVec3) {
        match self {
            Self::Matrix(matrix) => {
                let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
                (translation, rotation, scale)
            }
            Self::Parts { translation, rotation, scale } => (translation, rotation, scale),
        }
    }
}

/// A node of the scene, or a joint of a skeleton.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub parent: Option<u32>,
    /// Where nothing moves it.
    pub rest: Placement,
    /// Weights of the morph targets of its mesh, where nothing moves them.
    pub weights: Vec<f64>,
}

/// Joints, and the matrices into their spaces.
#[derive(Debug, Clone)]
pub(crate) struct Skin {
    /// Nodes.
    pub joints: Vec<u32>,
    pub inverse_binds: Vec<DMat4>,
}

/// What a track moves.
#[cfg_attr(not(feature = "gltf"), allow(dead_code, reason = "only files move all of them"))]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Path {
    Translation,
    Rotation,
    Scale,
    Weights,
}

/// One moving property of a node.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    pub node: u32,
    pub path: Path,
    pub keys: Keys,
}

/// An animation.
#[derive(Debug, Clone)]
pub(crate) struct Clip {
    pub name: Option<String>,
    pub tracks: Vec<Track>,
}

impl Clip {
    pub(crate) fn duration(&self) -> f64 {
        self.tracks.iter().map(|track| track.keys.end()).fold(0.0, f64::max)
    }
}

/// Nodes and skins.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rig {
    pub nodes: Vec<Node>,
    /// All nodes, each after its parent.
    pub order: Vec<u32>,
    pub skins: Vec<Skin>,
}

/// Nodes at a time.
pub(crate) struct Pose {
    /// From each node's space to the scene's.
    pub globals: Vec<DMat4>,
    /// Of the morph targets of each node's mesh.
    pub weights: Vec<Vec<f64>>,
}

impl Rig {
    /// All nodes at a time.
    pub(crate) fn pose(&self, clip: &Clip, seconds: f64) -> Pose {
        let mut placements: Vec<Placement> = self.nodes.iter().map(|node| node.rest).collect();
        let mut weights: Vec<Vec<f64>> = self.nodes.iter().map(|node| node.weights.clone()).collect();
        for Track { node, path, keys } in &clip.tracks {
            let node = *node as usize;
            if *path == Path::Weights {
                weights[node].resize(keys.width(), 0.0);
                keys.sample(seconds, &mut weights[node]);
                continue;
            }
            let (mut translation, mut rotation, mut scale) = placements[node].parts();
            let vector = || {
                let mut value = [0.0; 3];
                keys.sample(seconds, &mut value);
                DVec3::from(value)
            };
            match path {
                Path::Translation => translation = vector(),
                Path::Rotation => rotation = keys.rotation(seconds),
                Path::Scale => scale = vector(),
                Path::Weights => {}
            }
            placements[node] = Placement::Parts { translation, rotation, scale };
        }
        let mut globals = vec![DMat4::IDENTITY; self.nodes.len()];
        for &node in &self.order {
            let node = node as usize;
            let parent = self.nodes[node].parent.map_or(DMat4::IDENTITY, |parent| globals[parent as usize]);
            globals[node] = parent * placements[node].matrix();
        }
        Pose { globals, weights }
    }
}
