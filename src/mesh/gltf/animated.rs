//! A mesh together with what moves it.

use super::error::format_error;
use super::motion::{self, Motion};
use super::scene::{Instance, placement};
use super::skinned::Binder;
use super::{File, GltfOptions, Source, cost};
use crate::mesh::animation::{Node, Rig, Skin};
use crate::mesh::{Animated, Animations, ControlMesh, MeshError, RepairOptions, Repairs};
use ::gltf::json;
use glam::DVec3;

impl ControlMesh {
    /// As [`ControlMesh::from_gltf_bytes`] (or, with `repair`, [`ControlMesh::from_gltf_bytes_repaired`]), with the animations of the
    /// file: skins of any number of joints and influences, morph targets, and moving nodes. They follow what the reader and the
    /// repair make of the vertices; where it joins some that the file moves differently, the first counts.
    ///
    /// Weights of joints that do not add up to one are scaled to do so; without any weight, a vertex follows the first joint that it
    /// names. [`Animations::notes`] says so.
    ///
    /// # Errors
    /// As those, and [`MeshError::Format`] for animations, skins and morph targets that are broken.
    pub fn from_gltf_bytes_animated(
        bytes: &[u8],
        options: &GltfOptions,
        repair: Option<&RepairOptions>,
    ) -> Result<Animated, MeshError> {
        let file = File::open(bytes, options)?;
        let instances = file.instances(options)?;
        let built = file.build(&instances, options)?;
        let (mesh, repairs) = match repair {
            Some(repair) => Self::repaired(built.data, repair)?,
            None => (Self::new(built.data)?, Repairs::default()),
        };
        let repairs = Repairs { rebuilt_quads: built.rebuilt_quads, ..repairs };
        let vertices = 0..mesh.vertex_count() as u32;
        let sources: Vec<Source> = vertices.map(|v| built.sources[repairs.given_vertex(v) as usize]).collect();
        let animations = animations(&file, &instances, &sources, options)?;
        Ok(Animated { mesh, repairs, animations })
    }
}

fn animations(
    file: &File<'_>,
    instances: &[Instance<'_>],
    sources: &[Source],
    options: &GltfOptions,
) -> Result<Animations, MeshError> {
    let motion = Motion::parse(file.json)?;
    if motion.animations.is_empty() {
        return Ok(Animations::default());
    }
    cost::check_motion(file, instances, &motion, &options.limits)?;
    let mut notes = Vec::new();
    let skins = motion.skins(&file.root, &file.buffers)?;
    let rig = rig(&file.root, &motion, skins)?;
    let clips = motion.clips(&file.root, &file.buffers, &mut notes)?;
    let mut binder = Binder::new(&file.root, &file.buffers, instances, &rig)?;
    for source in sources {
        binder.add(*source)?;
    }
    let binding = binder.finish(&mut notes);
    Ok(Animations { rig, clips, binding, notes })
}

/// The nodes of a file as a forest.
fn rig(root: &json::Root, motion: &Motion, skins: Vec<Skin>) -> Result<Rig, MeshError> {
    let count = root.nodes.len();
    let mut nodes: Vec<Node> = (0..count)
        .map(|node| {
            let weights = motion::weights(root, motion, node);
            Node { parent: None, rest: placement(&root.nodes[node]), weights }
        })
        .collect();
    for (parent, node) in root.nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let missing = || format_error(format!("node {child} does not exist, but is a child of node {parent}"));
            let child_node = nodes.get_mut(child.value()).ok_or_else(missing)?;
            if child_node.parent.replace(parent as u32).is_some() {
                return Err(format_error(format!("node {child} is reached twice: give a node one parent")));
            }
        }
    }
    let mut order: Vec<u32> = (0..count as u32).filter(|&node| nodes[node as usize].parent.is_none()).collect();
    let mut next = 0;
    while let Some(&node) = order.get(next) {
        order.extend(root.nodes[node as usize].children.iter().flatten().map(|child| child.value() as u32));
        next += 1;
    }
    if order.len() < count {
        return Err(format_error("nodes are each other's children: give the scene a root"));
    }
    Ok(Rig { nodes, order, skins })
}

/// Three numbers of an element.
pub(super) fn vector(accessor: &super::Accessor<'_>, index: u32) -> DVec3 {
    accessor.get(index as usize).into()
}
