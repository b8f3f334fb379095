//! What each vertex of a file follows: joints with their weights, and morph targets.

use super::accessor::Accessor;
use super::animated::vector;
use super::error::format_error;
use super::scene::Instance;
use super::{Source, check_count};
use crate::mesh::MeshError;
use crate::mesh::animation::{Binding, Influence, Part, Rig};
use ::gltf::json;
use glam::DVec3;
use json::accessor::Type;
use json::mesh::{Primitive, Semantic};
use json::validation::Checked;
use std::borrow::Cow;
use std::collections::HashMap;

/// Binds control vertices one after the other.
pub(super) struct Binder<'f, 'a> {
    root: &'f json::Root,
    buffers: &'f [Cow<'f, [u8]>],
    instances: &'a [Instance<'f>],
    rig: &'a Rig,
    /// By instance and primitive.
    attributes: HashMap<(u32, u32), Attributes<'f>>,
    binding: Binding,
    /// Vertices whose weights did not add up to one, and without any weight.
    scaled: usize,
    weightless: usize,
}

/// The accessors of a primitive.
struct Attributes<'f> {
    positions: Accessor<'f>,
    /// Joints and weights, set by set.
    sets: Vec<[Accessor<'f>; 2]>,
    targets: Vec<Option<Accessor<'f>>>,
    /// The number of joints of the skin.
    joints: usize,
}

impl<'f, 'a> Binder<'f, 'a> {
    /// A part for each instance.
    pub fn new(
        root: &'f json::Root,
        buffers: &'f [Cow<'f, [u8]>],
        instances: &'a [Instance<'f>],
        rig: &'a Rig,
    ) -> Result<Self, MeshError> {
        let mut binding = Binding::default();
        for instance in instances {
            let skin = instance.node.and_then(|node| root.nodes[node].skin).map(|skin| skin.value());
            if let Some(skin) = skin.filter(|skin| *skin >= rig.skins.len()) {
                return Err(format_error(format!("skin {skin} does not exist, but a node names it")));
            }
            let (node, skin) = (instance.node.map(|node| node as u32), skin.map(|skin| skin as u32));
            let targets =
                instance.mesh.primitives.iter().filter_map(|primitive| Some(primitive.targets.as_ref()?.len()));
            let targets = vec![Vec::new(); targets.max().unwrap_or(0)];
            binding.add_part(Part { node, skin, targets });
        }
        let (attributes, scaled, weightless) = (HashMap::new(), 0, 0);
        Ok(Self { root, buffers, instances, rig, attributes, binding, scaled, weightless })
    }

    /// Binds the next control vertex.
    pub fn add(&mut self, source: Source) -> Result<(), MeshError> {
        let Source { instance, primitive, index } = source;
        if !self.attributes.contains_key(&(instance, primitive)) {
            let opened = self.open(instance, primitive)?;
            self.attributes.insert((instance, primitive), opened);
        }
        let attributes = &self.attributes[&(instance, primitive)];
        let vertex = self.binding.vertex_count() as u32;
        let mut influences = attributes.influences(index)?;
        let nonzero = influences.iter().filter(|influence| influence.weight > 0.0).count();
        let sum: f64 = influences.iter().map(|influence| influence.weight).sum();
        match influences.first_mut() {
            Some(first) if nonzero == 0 => {
                first.weight = 1.0;
                self.weightless += 1;
            }
            _ => {
                // As the validator of Khronos has it.
                self.scaled += usize::from(nonzero > 0 && (sum - 1.0).abs() > 2e-7 * nonzero as f64);
                influences.iter_mut().for_each(|influence| influence.weight /= sum);
            }
        }
        influences.retain(|influence| influence.weight > 0.0);
        for (target, accessor) in attributes.targets.iter().enumerate() {
            let offset = accessor.as_ref().map_or(DVec3::ZERO, |accessor| vector(accessor, index));
            if offset != DVec3::ZERO {
                self.binding.part_mut(instance).targets[target].push((vertex, offset));
            }
        }
        self.binding.add_vertex(instance, vector(&attributes.positions, index), &influences);
        Ok(())
    }

    /// What is bound; says what was odd.
    pub fn finish(self, notes: &mut Vec<String>) -> Binding {
        let several = |count: usize| if count == 1 { "vertex has" } else { "vertices have" };
        if self.scaled > 0 {
            let has = several(self.scaled);
            notes.push(format!("{} {has} weights of joints that do not add up to one: they are scaled", self.scaled));
        }
        if self.weightless > 0 {
            let has = several(self.weightless);
            notes.push(format!("{} {has} joints without weight: the first is followed", self.weightless));
        }
        self.binding
    }

    fn open(&self, instance: u32, primitive: u32) -> Result<Attributes<'f>, MeshError> {
        let Instance { mesh, node, .. } = &self.instances[instance as usize];
        let primitive: &'f Primitive = &mesh.primitives[primitive as usize];
        let open = |index: usize, kind| Accessor::open(self.root, self.buffers, index, kind);
        let attribute = |semantic: Semantic| primitive.attributes.get(&Checked::Valid(semantic)).map(|i| i.value());
        let Some(positions) = attribute(Semantic::Positions) else {
            return Err(format_error("a primitive has no POSITION"));
        };
        let positions = open(positions, Type::Vec3)?;
        let skin = node.and_then(|node| self.root.nodes[node].skin);
        let joints = skin.map_or(0, |skin| self.rig.skins[skin.value()].joints.len());
        let mut sets = Vec::new();
        while let (true, Some(of_joints), Some(of_weights)) = (
            skin.is_some(),
            attribute(Semantic::Joints(sets.len() as u32)),
            attribute(Semantic::Weights(sets.len() as u32)),
        ) {
            let set = [open(of_joints, Type::Vec4)?, open(of_weights, Type::Vec4)?];
            let names = [format!("JOINTS_{}", sets.len()), format!("WEIGHTS_{}", sets.len())];
            for (name, accessor) in names.iter().zip(&set) {
                check_count(name, accessor, &positions)?;
            }
            if !set[0].is_unsigned() {
                return Err(format_error(format!("{} are not unsigned integers", names[0])));
            }
            sets.push(set);
        }
        let mut targets = Vec::new();
        for target in primitive.targets.iter().flatten() {
            let offsets = target.positions.map(|index| open(index.value(), Type::Vec3)).transpose()?;
            offsets
                .as_ref()
                .map_or(Ok(()), |offsets| check_count("POSITION of a morph target", offsets, &positions))?;
            targets.push(offsets);
        }
        Ok(Attributes { positions, sets, targets, joints })
    }
}

impl Attributes<'_> {
    /// All that the file has for a vertex, those without weight too.
    fn influences(&self, index: u32) -> Result<Vec<Influence>, MeshError> {
        let mut influences = Vec::with_capacity(4 * self.sets.len());
        for [of_joints, of_weights] in &self.sets {
            let (joints, weights): ([f64; 4], [f64; 4]) =
                (of_joints.get(index as usize), of_weights.get(index as usize));
            for (joint, weight) in joints.into_iter().zip(weights) {
                if !(weight >= 0.0 && weight.is_finite()) {
                    return Err(format_error(format!(
                        "vertex {index} has a joint's weight {weight}: weights are numbers from 0 to 1"
                    )));
                }
                // Where there is no weight, any number may stand.
                if joint as usize >= self.joints && weight > 0.0 {
                    let count = self.joints;
                    return Err(format_error(format!("vertex {index} names joint {joint}, but the skin has {count}")));
                }
                let joint = if weight > 0.0 || (joint as usize) < self.joints { joint as u32 } else { 0 };
                influences.push(Influence { joint, weight });
            }
        }
        if self.joints == 0 {
            influences.clear();
        }
        Ok(influences)
    }
}
