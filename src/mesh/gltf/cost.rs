//! What it takes to build what a file draws, before any of it is built: few bytes can name much data, any number of times.

use super::File;
use super::motion::Motion;
use super::scene::Instance;
use crate::mesh::{Limits, MeshError};
use ::gltf::json;
use std::collections::HashMap;

/// Checks the face corners of all instances, with what replaces elements of theirs, and their morph targets.
pub(super) fn check(file: &File<'_>, instances: &[Instance<'_>], limits: &Limits) -> Result<(), MeshError> {
    let mut of_meshes: HashMap<*const json::Mesh, u64> = HashMap::new();
    let of_instance = |instance: &Instance<'_>| {
        *of_meshes.entry(instance.mesh).or_insert_with(|| {
            instance.mesh.primitives.iter().map(|primitive| of_primitive(file, primitive)).fold(0, u64::saturating_add)
        })
    };
    limits.check_corners("face corners", instances.iter().map(of_instance).fold(0, u64::saturating_add))
}

/// Checks the weights of morph targets of all nodes, the joints of all instances, and the values of all animations.
pub(super) fn check_motion(
    file: &File<'_>,
    instances: &[Instance<'_>],
    motion: &Motion,
    limits: &Limits,
) -> Result<(), MeshError> {
    let primitives = |mesh: &json::Mesh| {
        let targets = mesh.primitives.iter().map(|primitive| primitive.targets.as_ref().map_or(0, Vec::len));
        mesh.primitives.len() as u64 + targets.max().unwrap_or(0) as u64
    };
    let of_meshes: Vec<u64> = file.root.meshes.iter().map(primitives).collect();
    let of_node = |node: &json::Node| node.mesh.and_then(|mesh| of_meshes.get(mesh.value()).copied());
    let weights = file.root.nodes.iter().filter_map(of_node).fold(0, u64::saturating_add);
    let values = motion.animations.iter().flat_map(|animation| animation.accessors());
    let values = values.map(|accessor| elements(file, accessor)).fold(0, u64::saturating_add);
    let skins = instances.iter().filter_map(|instance| file.root.nodes[instance.node?].skin);
    let joints = skins.map(|skin| motion.joints(skin.value()) as u64).fold(0, u64::saturating_add);
    limits.check_corners("numbers that move it", weights.saturating_add(values).saturating_add(joints))
}

fn of_primitive(file: &File<'_>, primitive: &json::mesh::Primitive) -> u64 {
    let attributes = primitive.attributes.values().map(|index| index.value());
    let targets = primitive.targets.iter().flatten().map(|target| target.positions.map(|index| index.value()));
    let sparse = attributes.chain(targets.clone().flatten()).map(|index| replaced(file, index));
    let drawn = primitive.indices.or_else(|| primitive.attributes.values().next().copied());
    let corners = drawn.map_or(0, |index| elements(file, index.value()));
    sparse.fold(1 + corners, u64::saturating_add).saturating_add(targets.count() as u64)
}

/// Elements that an accessor can have: those beyond its buffer are an error later.
fn elements(file: &File<'_>, accessor: usize) -> u64 {
    let of = |accessor: &json::Accessor| accessor.count.0.min(bytes(file)).saturating_add(sparse(file, accessor));
    file.root.accessors.get(accessor).map_or(0, of)
}

fn replaced(file: &File<'_>, accessor: usize) -> u64 {
    file.root.accessors.get(accessor).map_or(0, |accessor| sparse(file, accessor))
}

fn sparse(file: &File<'_>, accessor: &json::Accessor) -> u64 {
    accessor.sparse.as_ref().map_or(0, |sparse| sparse.count.0.min(bytes(file)))
}

fn bytes(file: &File<'_>) -> u64 {
    file.buffers.iter().map(|buffer| buffer.len() as u64).max().unwrap_or(0)
}
