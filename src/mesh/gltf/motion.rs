//! Animations and skins. Read only where they are asked for: nothing wrong with them stands in the way of the meshes.

use super::accessor::Accessor;
use super::error::format_error;
use crate::mesh::MeshError;
use crate::mesh::animation::{Clip, Interpolation, Keys, Path, Skin, Track};
use ::gltf::json;
use glam::DMat4;
use json::accessor::Type;
use serde::Deserialize;
use std::borrow::Cow;

/// What the JSON says about motion.
#[derive(Deserialize)]
#[serde(default)]
#[derive(Default)]
pub(super) struct Motion {
    pub animations: Vec<Animation>,
    skins: Vec<SkinJson>,
    nodes: Vec<NodeJson>,
}

#[derive(Deserialize)]
pub(super) struct Animation {
    name: Option<String>,
    channels: Vec<Channel>,
    samplers: Vec<Sampler>,
}

impl Animation {
    /// Accessors of each channel.
    pub(super) fn accessors(&self) -> impl Iterator<Item = usize> {
        let samplers = self.channels.iter().filter_map(|channel| self.samplers.get(channel.sampler));
        samplers.flat_map(|sampler| [sampler.input, sampler.output])
    }
}

#[derive(Deserialize)]
struct Channel {
    sampler: usize,
    target: Target,
}

#[derive(Deserialize)]
struct Target {
    node: Option<usize>,
    path: String,
}

#[derive(Deserialize)]
struct Sampler {
    input: usize,
    output: usize,
    #[serde(default)]
    interpolation: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct SkinJson {
    joints: Vec<usize>,
    inverse_bind_matrices: Option<usize>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct NodeJson {
    weights: Option<Vec<f64>>,
}

type Buffers<'a, 'b> = &'a [Cow<'b, [u8]>];

/// Weights of the morph targets of a node's mesh where nothing moves them.
pub(super) fn weights(root: &json::Root, motion: &Motion, node: usize) -> Vec<f64> {
    let of_node = motion.nodes.get(node).and_then(|node| node.weights.clone());
    let of_mesh = || {
        let mesh = root.meshes.get(root.nodes[node].mesh?.value())?;
        Some(mesh.weights.as_ref()?.iter().copied().map(f64::from).collect())
    };
    let mut weights = of_node.or_else(of_mesh).unwrap_or_default();
    weights.resize(target_count(root, node), 0.0);
    weights
}

/// Morph targets of a node's mesh.
fn target_count(root: &json::Root, node: usize) -> usize {
    let mesh = root.nodes[node].mesh.and_then(|mesh| root.meshes.get(mesh.value()));
    let targets = mesh.iter().flat_map(|mesh| &mesh.primitives).filter_map(|primitive| primitive.targets.as_ref());
    targets.map(Vec::len).max().unwrap_or(0)
}

impl Motion {
    /// Joints of a skin.
    pub fn joints(&self, skin: usize) -> usize {
        self.skins.get(skin).map_or(0, |skin| skin.joints.len())
    }

    pub fn parse(json: &[u8]) -> Result<Self, MeshError> {
        serde_json::from_slice(json).map_err(|error| format_error(format!("animations and skins: {error}")))
    }

    pub fn skins(&self, root: &json::Root, buffers: Buffers) -> Result<Vec<Skin>, MeshError> {
        let skin = |(number, skin): (usize, &SkinJson)| {
            let wrong = |what: String| format_error(format!("skin {number} {what}"));
            if let Some(joint) = skin.joints.iter().find(|joint| **joint >= root.nodes.len()) {
                return Err(wrong(format!("names node {joint} as a joint, but there are {}", root.nodes.len())));
            }
            let joints: Vec<u32> = skin.joints.iter().map(|&joint| joint as u32).collect();
            let Some(matrices) = skin.inverse_bind_matrices else {
                return Ok(Skin { inverse_binds: vec![DMat4::IDENTITY; joints.len()], joints });
            };
            let matrices = Accessor::open(root, buffers, matrices, Type::Mat4)?;
            if matrices.count() < joints.len() {
                let (given, needed) = (matrices.count(), joints.len());
                return Err(wrong(format!("has {given} inverse bind matrices, but {needed} joints")));
            }
            let inverse_binds = (0..joints.len()).map(|j| DMat4::from_cols_array(&matrices.get(j))).collect();
            Ok(Skin { joints, inverse_binds })
        };
        self.skins.iter().enumerate().map(skin).collect()
    }

    pub fn clips(&self, root: &json::Root, buffers: Buffers, notes: &mut Vec<String>) -> Result<Vec<Clip>, MeshError> {
        let mut clips = Vec::with_capacity(self.animations.len());
        for (number, animation) in self.animations.iter().enumerate() {
            let mut tracks = Vec::with_capacity(animation.channels.len());
            for (channel, Channel { sampler, target }) in animation.channels.iter().enumerate() {
                let wrong = |what: String| format_error(format!("animation {number}, channel {channel}: {what}"));
                // Without a node it is for extensions.
                let Some(node) = target.node else { continue };
                let path = match target.path.as_str() {
                    "translation" => Path::Translation,
                    "rotation" => Path::Rotation,
                    "scale" => Path::Scale,
                    "weights" => Path::Weights,
                    other => {
                        notes.push(format!(
                            "animation {number}, channel {channel} moves \"{other}\" and is passed over"
                        ));
                        continue;
                    }
                };
                if node >= root.nodes.len() {
                    return Err(wrong(format!("node {node} does not exist")));
                }
                let missing = || wrong(format!("sampler {sampler} does not exist"));
                let sampler = animation.samplers.get(*sampler).ok_or_else(missing)?;
                let width = match path {
                    Path::Weights => target_count(root, node),
                    Path::Rotation => 4,
                    Path::Translation | Path::Scale => 3,
                };
                if width > 0 {
                    let keys = sampler.keys(root, buffers, path, width, &wrong)?;
                    tracks.push(Track { node: node as u32, path, keys });
                }
            }
            clips.push(Clip { name: animation.name.clone(), tracks });
        }
        Ok(clips)
    }
}

impl Sampler {
    fn keys(
        &self,
        root: &json::Root,
        buffers: Buffers,
        path: Path,
        width: usize,
        wrong: &dyn Fn(String) -> MeshError,
    ) -> Result<Keys, MeshError> {
        let interpolation = match self.interpolation.as_deref() {
            None | Some("LINEAR") => Interpolation::Linear,
            Some("STEP") => Interpolation::Step,
            Some("CUBICSPLINE") => Interpolation::CubicSpline,
            Some(other) => {
                return Err(wrong(format!("interpolation \"{other}\" is unknown: use LINEAR, STEP or CUBICSPLINE")));
            }
        };
        let input = Accessor::open(root, buffers, self.input, Type::Scalar)?;
        let kind = match path {
            Path::Weights => Type::Scalar,
            Path::Rotation => Type::Vec4,
            Path::Translation | Path::Scale => Type::Vec3,
        };
        let output = Accessor::open(root, buffers, self.output, kind)?;
        // Elements without data cost no bytes in the file, so there could be any number of them.
        if !input.is_backed() || !output.is_backed() {
            return Err(wrong("times and values need a buffer view: write the file again".into()));
        }
        let elements_a_value = if path == Path::Weights { width } else { 1 };
        let (given, keys) = (output.count(), input.count());
        let needed = keys.checked_mul(interpolation.values_a_key() * elements_a_value);
        if Some(given) != needed {
            return Err(wrong(format!(
                "{given} values do not go with {keys} times and {} values a key",
                interpolation.values_a_key() * elements_a_value
            )));
        }
        let times = (0..keys).map(|key| input.get::<1>(key)[0]).collect();
        let values: Vec<f64> = match kind {
            Type::Vec4 => (0..given).flat_map(|i| output.get::<4>(i)).collect(),
            Type::Vec3 => (0..given).flat_map(|i| output.get::<3>(i)).collect(),
            _ => (0..given).flat_map(|i| output.get::<1>(i)).collect(),
        };
        if values.iter().any(|value| !value.is_finite()) {
            return Err(wrong("a value is not a finite number".into()));
        }
        Keys::new(interpolation, times, values, width)
            .ok_or_else(|| wrong("its times must be finite numbers that increase, one at least".into()))
    }
}
