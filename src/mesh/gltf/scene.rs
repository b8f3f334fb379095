//! Which meshes a scene shows, and where.

use super::error::format_error;
use crate::mesh::MeshError;
use crate::mesh::animation::Placement;
use ::gltf::json;
use glam::{DMat4, DQuat, DVec3};

/// Names that a message lists at most.
const MOST_NAMES: usize = 50;

/// A mesh at a place in the scene.
pub(super) struct Instance<'a> {
    pub mesh: &'a json::Mesh,
    /// From the mesh's space to the scene's.
    pub transform: DMat4,
    /// The node that it is at, if there is a scene.
    pub node: Option<usize>,
    name: Option<&'a str>,
}

/// The meshes of the default scene (or else the first), in the order of its nodes. A file without scenes is a library:
/// all its meshes, as they are.
pub(super) fn instances(root: &json::Root) -> Result<Vec<Instance<'_>>, MeshError> {
    let scene = match root.scene {
        None => root.scenes.first(),
        Some(index) => {
            let missing = || format_error(format!("scene {index} does not exist, but is the default scene"));
            Some(root.scenes.get(index.value()).ok_or_else(missing)?)
        }
    };
    let Some(scene) = scene else {
        let place = |mesh| Instance { mesh, transform: DMat4::IDENTITY, node: None, name: None };
        return Ok(root.meshes.iter().map(place).collect());
    };
    let mut instances = Vec::new();
    let mut visited = vec![false; root.nodes.len()];
    let mut stack: Vec<_> = scene.nodes.iter().rev().map(|&index| (index, DMat4::IDENTITY)).collect();
    while let Some((index, parent)) = stack.pop() {
        let missing = || format_error(format!("node {index} does not exist, but the scene names it"));
        let node = root.nodes.get(index.value()).ok_or_else(missing)?;
        // The nodes must form a tree. Otherwise they could go round for ever.
        if std::mem::replace(&mut visited[index.value()], true) {
            return Err(format_error(format!("node {index} is reached twice: give a node one parent")));
        }
        let transform = parent * placement(node).matrix();
        if let Some(mesh) = node.mesh {
            let missing = || format_error(format!("mesh {mesh} does not exist, but node {index} names it"));
            let mesh = root.meshes.get(mesh.value()).ok_or_else(missing)?;
            // What is skinned is where its joints are.
            let transform = if node.skin.is_some() { DMat4::IDENTITY } else { transform };
            instances.push(Instance { mesh, transform, node: Some(index.value()), name: node.name.as_deref() });
        }
        stack.extend(node.children.iter().flatten().rev().map(|&child| (child, transform)));
    }
    Ok(instances)
}

/// Where a node is in the space of its parent.
pub(super) fn placement(node: &json::Node) -> Placement {
    if let Some(matrix) = node.matrix {
        return Placement::Matrix(DMat4::from_cols_array(&matrix.map(f64::from)));
    }
    let vector = |vector: [f32; 3]| DVec3::from(vector.map(f64::from));
    Placement::Parts {
        translation: vector(node.translation.unwrap_or_default()),
        rotation: DQuat::from_array(node.rotation.unwrap_or_default().0.map(f64::from)),
        scale: vector(node.scale.unwrap_or([1.0; 3])),
    }
}

/// Keeps the instances whose mesh or node has this name.
pub(super) fn choose<'a>(instances: Vec<Instance<'a>>, name: &str) -> Result<Vec<Instance<'a>>, MeshError> {
    let names = |instance: &Instance<'a>| [instance.mesh.name.as_deref(), instance.name];
    let (chosen, others): (Vec<_>, Vec<_>) =
        instances.into_iter().partition(|instance| names(instance).contains(&Some(name)));
    if !chosen.is_empty() {
        return Ok(chosen);
    }
    let mut known: Vec<_> = others.iter().flat_map(names).flatten().collect();
    known.sort_unstable();
    known.dedup();
    let known = match known.as_slice() {
        [] => "its meshes have no names; leave the name out to read them all".to_owned(),
        known if known.len() > MOST_NAMES => {
            let (some, count) = (known[..MOST_NAMES].join("\", \""), known.len() - MOST_NAMES);
            format!("choose one of \"{some}\" and {count} others")
        }
        known => format!("choose one of \"{}\"", known.join("\", \"")),
    };
    Err(MeshError::UnknownMesh { name: name.to_owned(), known })
}
