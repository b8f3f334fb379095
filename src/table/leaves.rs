//! What shaders read of faces that are refined: quadtrees, leaves, and who owns edges and corners.

use super::plan::PatchPlan;
use crate::adaptive::{self, LEAF, LeafKind};
use crate::blend::Row;
use crate::constants::{
    FACE_WORDS, LEAF_BIT, LEAF_CAP, LEAF_CREASE, LEAF_FOURS, LEAF_REGULAR, MAX_DEPTH, OWNER_COARSE, OWNER_SHARP_BIT,
    OWNER_SHIFT,
};
use crate::mesh::SHARPNESS_INFINITE;
use crate::patch::Scheme;
use crate::topology::{PatchKind, Topology};
use glam::DVec3;
use rayon::prelude::*;

const _: () = assert!(MAX_DEPTH == adaptive::MAX_DEPTH && LEAF_BIT == LEAF);

/// The faces of a plan of adaptive subdivision, as shaders read them. GLSL twin: `glsl/lib/evaluate/leaves.glsl`.
#[derive(Debug, Clone, PartialEq)]
pub struct LeafTable {
    /// For each irregular quad, in the order of the patches: its root; the owners of its edges, from corner k to the next; the
    /// owners of its corners. An owner is a patch from bit `OWNER_SHIFT` on, `OWNER_SHARP_BIT` if each face has a normal of its own
    /// there, and the owner's edge or corner; or `OWNER_COARSE`, where a neighbour is not refined.
    pub faces: Vec<[u32; FACE_WORDS as usize]>,
    /// For each leaf, its kind; a crease's sharpness or the first control point of an end cap; then its 16 control points, row by row
    /// along v.
    pub leaves: Vec<[u32; 4 * LEAF_FOURS as usize]>,
    /// The plan. Control points of end caps are as [`Scheme::kept`] has them.
    pub(super) plan: adaptive::Plan,
    /// The number of the first irregular quad among all patches.
    pub first_patch: u32,
}

impl LeafTable {
    /// For the patches in `patches` of the mesh that was planned.
    pub(super) fn new(topology: &Topology, patches: &PatchPlan, mut plan: adaptive::Plan) -> Self {
        keep_caps(&mut plan);
        let range = patches.range(PatchKind::IrregularQuad);
        let owners = Owners::new(topology, patches);
        let faces = patches.patches()[range.clone()].par_iter();
        let faces = faces.map(|patch| {
            let first = topology.mesh().face_corners(patch.face).start as u32;
            let mut words = [0; FACE_WORDS as usize];
            words[0] = plan.face_roots[patch.face as usize];
            for k in 0..4 {
                words[1 + k as usize] = owners.edge(first + k);
                words[5 + k as usize] = owners.corner(first + k);
            }
            words
        });
        let faces = faces.collect();
        let leaves = plan.leaves.par_iter().map(|leaf| leaf_words(&plan, leaf, |vertex| patches.vertex(vertex)));
        Self { faces, leaves: leaves.collect(), plan, first_patch: range.start as u32 }
    }

    /// The quadtrees: [`adaptive::Plan::nodes`].
    pub fn quadtrees(&self) -> &[u32] {
        &self.plan.nodes
    }

    /// Number of vertices that shaders read besides those of the mesh.
    pub(super) fn added_vertices(&self) -> usize {
        self.plan.rows.len()
    }

    /// Those vertices, where the vertices of the mesh are at `positions`.
    pub(super) fn added_points(&self, positions: &[DVec3]) -> Vec<DVec3> {
        self.plan.points(positions).split_off(positions.len())
    }
}

/// Whether a face is no leaf itself, which a bicubic patch draws.
pub(super) fn is_refined(plan: &adaptive::Plan, face: u32) -> bool {
    let roots = plan.face_roots[face as usize]..plan.face_roots[face as usize + 1];
    let whole = |root: u32| match plan.nodes[root as usize] {
        node if node & LEAF == 0 => false,
        node => plan.leaves[(node & !LEAF) as usize].kind == LeafKind::Regular,
    };
    !(roots.len() == 1 && whole(roots.start))
}

fn leaf_words(
    plan: &adaptive::Plan,
    leaf: &adaptive::Leaf,
    vertex: impl Fn(u32) -> u32,
) -> [u32; 4 * LEAF_FOURS as usize] {
    let mut words = [0; 4 * LEAF_FOURS as usize];
    let (kind, word) = match leaf.kind {
        LeafKind::Regular => (LEAF_REGULAR, 0),
        LeafKind::SingleCrease { edge, sharpness } => (LEAF_CREASE + edge, sharpness.to_bits()),
        LeafKind::Cap => (LEAF_CAP, vertex(leaf.points)),
    };
    words[..2].copy_from_slice(&[kind, word]);
    if leaf.kind != LeafKind::Cap {
        let grid = &plan.grids[leaf.points as usize..][..16];
        words[4..].iter_mut().zip(grid).for_each(|(word, &point)| *word = vertex(point));
    }
    words
}

/// Has the control points of end caps as shaders keep them, corner by corner.
fn keep_caps(plan: &mut adaptive::Plan) {
    let first = (plan.cap_points.start - plan.control_vertices) as usize;
    let kind = PatchKind::IrregularQuad;
    let points = Scheme::Gregory.points(kind);
    let rows: Vec<Vec<Row>> = (first..plan.rows.len())
        .into_par_iter()
        .step_by(points)
        .map(|cap| {
            let rows: Vec<Row> = (cap..cap + points).map(|row| Row::new(plan.rows.row(row).collect())).collect();
            let owned = |k| Scheme::Gregory.corner_slots(kind, k).into_iter().map(|slot| rows[slot].clone());
            (0..4).flat_map(|k| Scheme::Gregory.kept(kind, &owned(k).collect::<Vec<_>>())).collect()
        })
        .collect();
    plan.rows.truncate(first);
    rows.into_iter().flatten().for_each(|row| plan.rows.push(row.weights().iter().copied()));
}

/// Who makes what patches share.
struct Owners<'t> {
    topology: &'t Topology,
    /// The number of each face's patch, if it is an irregular quad.
    refined: Vec<u32>,
    /// Whether each face is drawn, but not refined.
    coarse: Vec<bool>,
}

const NONE: u32 = u32::MAX;

impl<'t> Owners<'t> {
    fn new(topology: &'t Topology, patches: &PatchPlan) -> Self {
        let faces = topology.mesh().face_count();
        let (mut refined, mut coarse) = (vec![NONE; faces], vec![false; faces]);
        for (patch, number) in patches.patches().iter().zip(0..) {
            match patch.kind {
                PatchKind::IrregularQuad => refined[patch.face as usize] = number,
                _ => coarse[patch.face as usize] = true,
            }
        }
        Self { topology, refined, coarse }
    }

    fn word(&self, h: u32, is_sharp: bool) -> u32 {
        let face = self.topology.face(h);
        let k = h - self.topology.mesh().face_corners(face).start as u32;
        let sharp = if is_sharp { OWNER_SHARP_BIT } else { 0 };
        self.refined[face as usize] << OWNER_SHIFT | sharp | k
    }

    fn is_sharp(&self, h: u32) -> bool {
        self.topology.sharpness(h) >= SHARPNESS_INFINITE
    }

    fn edge(&self, h: u32) -> u32 {
        let face = |h: u32| self.topology.face(h) as usize;
        match self.topology.twin(h) {
            Some(twin) if self.coarse[face(twin)] => OWNER_COARSE,
            Some(twin) if (self.refined[face(twin)], twin) < (self.refined[face(h)], h) => {
                self.word(twin, self.is_sharp(h))
            }
            _ => self.word(h, false),
        }
    }

    fn corner(&self, h: u32) -> u32 {
        let (fan, _) = self.topology.fan(h);
        let face = |h: u32| self.topology.face(h) as usize;
        if fan.iter().any(|&h| self.coarse[face(h)]) {
            return OWNER_COARSE;
        }
        let inside = |&h: &u32| self.topology.twin(h).is_some();
        let is_sharp = self.topology.vertex_sharpness(self.topology.mesh_vertex(h)) >= SHARPNESS_INFINITE
            || fan.iter().filter(|h| inside(h)).any(|&h| self.is_sharp(h));
        let owner = fan.iter().copied().min_by_key(|&h| (self.refined[face(h)], h)).unwrap_or(h);
        self.word(owner, is_sharp)
    }
}
