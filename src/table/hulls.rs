//! The hulls of faces that are refined: points between which the surface of a face lies, for culling.

use super::leaves::Owners;
use super::plan::{Patch, PatchPlan};
use super::prepare::Prepared;
use crate::adaptive::{LEAF, Leaf, LeafKind, Plan};
use crate::constants::{CAP_VERTICES, HULL_CAP_BIT, OWNER_NONE, OWNER_SHIFT, WEDGE_BIT};
use crate::topology::Topology;
use rayon::prelude::*;

const _: () = assert!(CAP_VERTICES == crate::adaptive::CAP_POINTS);

/// The children of nodes that a walk follows, a bit each: all; those along each edge; at each corner; along the diagonal.
const ALL: u32 = 15;
const ALONG: [u32; 4] = [3, 10, 12, 5];
const AT: [u32; 4] = [1, 2, 8, 4];
const DIAGONAL: u32 = 9;

/// The hulls of the patches from the first that is refined on, one after the other, and where that of each patch starts.
///
/// The surface of a face lies between the vertices of all faces around it, whatever is sharp there, for refinement makes means of
/// vertices; and between the control points of its leaves, which are fewer next to faces of many corners or a vertex of many faces. End
/// caps only come near it: of these, the control points.
pub(super) fn hulls(prepared: &Prepared, patches: &PatchPlan, plan: &Plan, owners: &Owners) -> (Vec<u32>, Vec<u32>) {
    let first = patches.patches().iter().position(|patch| patch.refined).unwrap_or(patches.patches().len());
    let of_patches = patches.patches()[first..].par_iter();
    let of_patch = |&patch: &Patch| match patch.refined {
        true => hull(prepared, patches, plan, owners, patch),
        false => Vec::new(),
    };
    let all: Vec<Vec<u32>> = of_patches.map(of_patch).collect();
    let (mut words, mut starts) = (Vec::new(), Vec::with_capacity(all.len()));
    for (i, hull) in all.iter().enumerate() {
        if i > 0 && *hull == all[i - 1] {
            starts.push(starts[i - 1]);
            continue;
        }
        starts.push(words.len() as u32);
        words.push(hull.len() as u32);
        words.extend(hull);
    }
    (words, starts)
}

fn hull(prepared: &Prepared, patches: &PatchPlan, plan: &Plan, owners: &Owners, patch: Patch) -> Vec<u32> {
    let [root, next] = prepared.roots(plan, &patch);
    let mut leaves = leaves_of(plan, root, ALL);
    if next != root {
        leaves.extend(leaves_of(plan, next, ALL));
    }
    // Edges and corners of neighbours are those of the face, too, but where a cap rounds a crease.
    if plan.rounded_caps > 0 {
        for h in patch.corners(prepared.topology()) {
            let [[edge, _], [corner, _]] = [owners.edge(h), owners.corner(h)];
            let owned = [(edge, true), (corner, false)].into_iter().filter(|&(owner, _)| owner != OWNER_NONE);
            leaves.extend(owned.flat_map(|(owner, is_edge)| leaves_owned(prepared, patches, plan, owner, is_edge)));
        }
    }
    let (mut caps, mut of_leaves) = (Vec::new(), Vec::new());
    for leaf in leaves {
        let points = leaf.points as usize;
        match leaf.kind {
            LeafKind::Cap => caps.push(leaf.points),
            _ => of_leaves.extend(&plan.grids[points..points + 16]),
        }
    }
    for points in [&mut caps, &mut of_leaves] {
        points.sort_unstable();
        points.dedup();
    }
    let (whole_face, _) = prepared.whole_face(patch.face);
    let around = vertices_around(prepared.whole(), whole_face, of_leaves.len()).unwrap_or(of_leaves);
    let vertices = around.into_iter().map(|vertex| patches.vertex(vertex));
    vertices.chain(caps.into_iter().map(|cap| patches.vertex(cap) | HULL_CAP_BIT)).collect()
}

/// The vertices of a face and of all faces around it, in order, unless they are more than so many.
fn vertices_around(topology: &Topology, face: u32, most: usize) -> Option<Vec<u32>> {
    let mesh = topology.mesh();
    let mut vertices: Vec<u32> = Vec::new();
    for h in mesh.face_corners(face) {
        let around = topology.fan(h as u32).0;
        if around.len() > most || around.iter().any(|&h| topology.face_size(h) as usize > most) {
            return None;
        }
        vertices.extend(around.iter().flat_map(|&h| mesh.face(topology.face(h))));
        vertices.sort_unstable();
        vertices.dedup();
        if vertices.len() > most {
            return None;
        }
    }
    Some(vertices)
}

/// The leaves of a root that are reached by some children of each node only.
fn leaves_of(plan: &Plan, root: u32, children: u32) -> Vec<&Leaf> {
    let (mut leaves, mut pending) = (Vec::new(), vec![plan.nodes[root as usize]]);
    while let Some(node) = pending.pop() {
        if node & LEAF == 0 {
            let followed = (0..4).filter(|child| children >> child & 1 != 0);
            pending.extend(followed.map(|child| plan.nodes[(node + child) as usize]));
            continue;
        }
        leaves.push(&plan.leaves[(node & !LEAF) as usize]);
    }
    leaves
}

/// The leaves along an edge, or at a corner, of its owner. GLSL twin: `spot_of` in `glsl/lib/evaluate/leaves.glsl`.
fn leaves_owned<'p>(
    prepared: &Prepared,
    patches: &PatchPlan,
    plan: &'p Plan,
    owner: u32,
    is_edge: bool,
) -> impl Iterator<Item = &'p Leaf> {
    let k = (owner & 3) as usize;
    let [root, next] = prepared.roots(plan, &patches.patches()[(owner >> OWNER_SHIFT) as usize]);
    let walks = match (owner & WEDGE_BIT != 0, is_edge) {
        (false, true) => vec![(root, ALONG[k])],
        (false, false) => vec![(root, AT[k])],
        // The edge of the face goes along both roots, the others from there to the centre.
        (true, true) if k == 0 => vec![(root, ALONG[0]), (next, ALONG[3])],
        (true, true) => vec![(if k == 1 { next } else { root }, DIAGONAL)],
        (true, false) => vec![(if k == 1 { next } else { root }, if k == 2 { AT[2] } else { AT[0] })],
    };
    walks.into_iter().flat_map(|(root, children)| leaves_of(plan, root, children))
}
