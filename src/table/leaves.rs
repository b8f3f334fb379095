//! What shaders read of faces that are refined: quadtrees, leaves, and who owns edges and corners.

use super::hulls::hulls;
use super::pieces::{LeafPart, on_side};
use super::plan::PatchPlan;
use super::prepare::Prepared;
use super::wedges::Part;
use crate::adaptive::{self, DrawnBy, LEAF, LeafKind, LevelCounts};
use crate::constants::{
    APEX_IS_CENTRE, FACE_HULL, FACE_WORDS, LEAF_CAP, LEAF_CREASE, LEAF_FOURS, LEAF_REGULAR, NORMAL_OWNERS, OWNER_NONE,
    OWNER_SHIFT, OWNERS, PIECE_APEX_SHIFT, PIECE_EDGE_SHIFT, PIECE_LEVEL_SHIFT, PIECE_MASK, PIECE_PARTS,
    PIECE_TO_SHIFT, WEDGE_BIT,
};
use crate::mesh::SHARPNESS_INFINITE;
use crate::topology::{PatchKind, Topology};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;

/// The faces of a plan of adaptive subdivision, as shaders read them. GLSL twin: `glsl/lib/evaluate/leaves.glsl`.
#[derive(Debug, Clone, PartialEq)]
pub struct LeafTable {
    /// For each patch from the first that is refined on, in order: its root, of a wedge that around the start of its edge, then that
    /// around the end; by leaves its leaf, then which part of the leaf it is, and the leaf's level. Then the owners of the positions on its edges, from corner k to the next, and at its corners; likewise the owners of
    /// the normals, which differ where infinitely sharp edges part faces. Then where its hull starts in `hulls`, but for patches by leaves. An owner is a patch from bit `OWNER_SHIFT` on, with
    /// `WEDGE_BIT` where it is a wedge, and its edge or corner; or `OWNER_NONE`, where a neighbour is not refined. Of patches that are
    /// not refined zeros.
    pub faces: Vec<[u32; FACE_WORDS as usize]>,
    /// The hulls of faces: the number of entries, then for each a vertex, or with
    /// `HULL_CAP_BIT` the first of `CAP_VERTICES`. The surface of the face lies between all of these.
    pub hulls: Vec<u32>,
    /// For each leaf, its kind; a crease's sharpness or the first of the four face points f- of an end cap; two words that are not
    /// used; then 16 control points, row by row along v.
    pub leaves: Vec<[u32; 4 * LEAF_FOURS as usize]>,
    /// The quadtrees: [`adaptive::Plan::nodes`].
    pub quadtrees: Vec<u32>,
    /// The leaves and refined cells of each level: [`adaptive::Plan::counts`].
    pub counts: Vec<LevelCounts>,
    /// The number of the first patch that is refined.
    pub first_patch: u32,
    /// Sums that make the vertices which are not the mesh's.
    pub refinement: Refinement,
}

/// The vertices of adaptive subdivision as weighted sums: [`adaptive::Rows`]; before them those of steps of refinement, with
/// [`TableOptions::refine_on_device`](super::TableOptions::refine_on_device). What is counted in fours is filled up with weights of
/// zero. GLSL twin: `glsl/compute/refine.comp`.
#[derive(Debug, Clone, PartialEq)]
pub struct Refinement {
    /// The vertex that row 0 makes: vertices from this one on are made.
    pub first_vertex: u32,
    /// What can be made all at once, in the order in which the vertices read each other.
    pub steps: Vec<RefinementStep>,
    /// For each block, the first four of the weights of its mask and of its vertices; and after the last block the number of fours of
    /// all vertices.
    pub blocks: Vec<[u32; 2]>,
    /// The vertices that blocks read.
    pub vertices: Vec<[u32; 4]>,
    /// The weights of masks, output by output.
    pub weights: Vec<[f32; 4]>,
}

/// Rows that can be made all at once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RefinementStep {
    /// The rows.
    pub rows: Range<u32>,
    /// The block of the first row.
    pub first_block: u32,
    /// How many rows each block makes.
    pub rows_of_block: u32,
}

impl Refinement {
    fn new(plan: &adaptive::Plan, vertex: impl Fn(u32) -> u32 + Sync) -> Self {
        let row = |vertex: u32| vertex - plan.control_vertices;
        let step = |step: Range<u32>| {
            // Those before end caps have a block each.
            let first_block = row(step.start).min(row(plan.cap_points.start));
            let rows_of_block = if step.start < plan.cap_points.start { 1 } else { CAP_ORDER.len() as u32 };
            RefinementStep { rows: row(step.start)..row(step.end), first_block, rows_of_block }
        };
        let (weights, starts) = mask_fours(&plan.rows);
        let blocks = &plan.rows.blocks;
        let ends = blocks.iter().skip(1).map(|block| block.vertices).chain([plan.rows.vertices.len() as u32]);
        let ranges: Vec<Range<u32>> = blocks.iter().zip(ends).map(|(block, end)| block.vertices..end).collect();
        let mut four = 0;
        let place = |(block, range): (&adaptive::Block, &Range<u32>)| {
            let first = four;
            four += range.len().div_ceil(4) as u32;
            [starts[block.mask as usize], first]
        };
        let mut blocks: Vec<[u32; 2]> = blocks.iter().zip(&ranges).map(place).collect();
        blocks.push([0, four]);
        let vertices = ranges.into_par_iter().flat_map_iter(|range| {
            let read = &plan.rows.vertices[range.start as usize..range.end as usize];
            read.chunks(4).map(|four| std::array::from_fn(|i| vertex(*four.get(i).unwrap_or(&read[0]))))
        });
        Self {
            first_vertex: vertex(plan.control_vertices),
            steps: plan.steps().filter(|step| !step.is_empty()).map(step).collect(),
            vertices: vertices.collect(),
            blocks,
            weights,
        }
    }

    /// Number of vertices that are made.
    pub fn vertices(&self) -> usize {
        self.steps.iter().map(|step| step.rows.end as usize).max().unwrap_or(0)
    }
}

impl LeafTable {
    /// The corners of a patch by leaves, in (u, v) of its cell.
    pub(super) fn cell_corners(&self, patch: usize, kind: PatchKind) -> Vec<[f64; 2]> {
        let word = self.faces[patch][1];
        let on = |edge, part| on_side([0, 0], PIECE_PARTS, edge, part).map(|t| f64::from(t) / f64::from(PIECE_PARTS));
        if kind != PatchKind::Triangle {
            return (0..4).map(|k| on(k, 0)).collect();
        }
        let [from, to] = [word, word >> PIECE_TO_SHIFT].map(|at| at & PIECE_MASK);
        let edge = word >> PIECE_EDGE_SHIFT & 3;
        let apex = match word >> PIECE_APEX_SHIFT {
            APEX_IS_CENTRE => [0.5; 2],
            edge => on(edge, PIECE_PARTS / 2),
        };
        vec![on(edge, from), on(edge, to), apex]
    }

    /// For the patches in `patches` of a mesh that was planned.
    pub(super) fn new(prepared: &Prepared, patches: &PatchPlan, plan: adaptive::Plan) -> Self {
        let topology = prepared.topology();
        let first_patch = patches.patches().iter().position(|patch| patch.refined).unwrap_or(patches.patches().len());
        let owners = Owners::new(topology, patches);
        let (hulls, starts) = match plan.options.drawn_by {
            DrawnBy::Faces => hulls(prepared, patches, &plan, &owners),
            DrawnBy::Leaves => (Vec::new(), vec![0; patches.patches().len() - first_patch]),
        };
        let faces = patches.patches()[first_patch..].par_iter().zip(starts);
        let faces = faces.map(|(patch, hull)| {
            let mut words = [0; FACE_WORDS as usize];
            if patch.refined {
                words[..2].copy_from_slice(&match prepared.cut_face(patch.face).map(|cut| cut.part) {
                    Some(Part::Leaf(leaf)) => leaf_piece(&plan, leaf, LeafPart::default()),
                    Some(Part::OfLeaf(leaf, part)) => leaf_piece(&plan, leaf, part),
                    _ => prepared.roots(&plan, patch),
                });
                words[FACE_HULL as usize] = hull;
                let (edges, normals) = (OWNERS as usize, NORMAL_OWNERS as usize);
                for (k, h) in patch.corners(topology).enumerate() {
                    [words[edges + k], words[normals + k]] = owners.edge(h);
                    [words[edges + 4 + k], words[normals + 4 + k]] = owners.corner(h);
                }
            }
            words
        });
        let faces = faces.collect();
        let leaves =
            plan.leaves.par_iter().map(|leaf| leaf_words(&plan, leaf, |vertex| patches.vertex(vertex))).collect();
        let refinement = Refinement::new(&plan, |vertex| patches.vertex(vertex));
        Self {
            faces,
            hulls,
            leaves,
            first_patch: first_patch as u32,
            refinement,
            counts: plan.counts(),
            quadtrees: plan.nodes,
        }
    }
}

/// Whether a face is refined: it is not if it has no root, or one regular leaf covers it.
pub(super) fn is_refined(plan: &adaptive::Plan, face: u32) -> bool {
    let roots = plan.face_roots[face as usize]..plan.face_roots[face as usize + 1];
    let whole = |root: u32| match plan.nodes[root as usize] {
        node if node & LEAF == 0 => false,
        node => plan.leaves[(node & !LEAF) as usize].kind == LeafKind::Regular,
    };
    !(roots.is_empty() || roots.len() == 1 && whole(roots.start))
}

/// The leaf that a patch is of; its level from bit [`PIECE_LEVEL_SHIFT`] on, and of a triangle the edge, its ends and the apex.
fn leaf_piece(plan: &adaptive::Plan, leaf: u32, part: LeafPart) -> [u32; 2] {
    let (level, LeafPart { edge, ends: [from, to], apex }) = (plan.leaves[leaf as usize].level, part);
    let triangle = from | to << PIECE_TO_SHIFT | edge << PIECE_EDGE_SHIFT | apex << PIECE_APEX_SHIFT;
    [leaf, triangle | level << PIECE_LEVEL_SHIFT]
}

fn leaf_words(
    plan: &adaptive::Plan,
    leaf: &adaptive::Leaf,
    vertex: impl Fn(u32) -> u32,
) -> [u32; 4 * LEAF_FOURS as usize] {
    let mut words = [0; 4 * LEAF_FOURS as usize];
    let first = leaf.points;
    let (kind, word) = match leaf.kind {
        LeafKind::Regular => (LEAF_REGULAR, 0),
        LeafKind::SingleCrease { edge, sharpness } => (LEAF_CREASE + edge, sharpness.to_bits()),
        LeafKind::Cap => (LEAF_CAP, vertex(first + 16)),
    };
    words[..2].copy_from_slice(&[kind, word]);
    for (word, i) in words[4..].iter_mut().zip(first..) {
        *word = vertex(if leaf.kind == LeafKind::Cap { i } else { plan.grids[i as usize] });
    }
    words
}

/// Where the points of a Gregory quad stand: a grid like that of a regular leaf, then the face points f- of the corners.
const CAP_ORDER: [usize; 20] = [0, 5, 10, 3, 4, 12, 18, 11, 7, 14, 16, 8, 1, 6, 9, 2, 13, 15, 17, 19];

/// The weights of masks, those of end caps in [`CAP_ORDER`], and the first four of each mask.
fn mask_fours(rows: &adaptive::Rows) -> (Vec<[f32; 4]>, Vec<u32>) {
    let (mut fours, mut starts) = (Vec::new(), Vec::with_capacity(rows.masks.len()));
    for &adaptive::Mask { weights, inputs, outputs } in &rows.masks {
        starts.push(fours.len() as u32);
        for &output in if outputs == 1 { &[0][..] } else { &CAP_ORDER } {
            let weights = &rows.weights[weights as usize + output * inputs as usize..][..inputs as usize];
            let four = |four: &[f64]| std::array::from_fn(|i| four.get(i).map_or(0.0, |&weight| weight as f32));
            fours.extend(weights.chunks(4).map(four));
        }
    }
    (fours, starts)
}

/// Who makes what patches share.
pub(super) struct Owners<'t> {
    topology: &'t Topology,
    /// The number of each face's patch, if it is refined.
    refined: Vec<u32>,
    /// Whether each face is drawn, but not refined.
    coarse: Vec<bool>,
    /// The half-edges from each vertex in which several fans of faces touch.
    touching: HashMap<u32, Vec<u32>>,
}

const NONE: u32 = u32::MAX;

impl<'t> Owners<'t> {
    fn new(topology: &'t Topology, patches: &PatchPlan) -> Self {
        let faces = topology.mesh().face_count();
        let (mut refined, mut coarse) = (vec![NONE; faces], vec![false; faces]);
        for (patch, number) in patches.patches().iter().zip(0..) {
            match patch.refined {
                true => refined[patch.face as usize] = number,
                false => coarse[patch.face as usize] = true,
            }
        }
        let mut touching: HashMap<u32, Vec<u32>> = HashMap::new();
        if topology.split_count() > 0 {
            let half_edges = 0..topology.mesh().corner_count() as u32;
            for h in half_edges.filter(|&h| topology.touches(topology.mesh_vertex(h))) {
                touching.entry(topology.mesh_vertex(h)).or_default().push(h);
            }
        }
        Self { topology, refined, coarse, touching }
    }

    /// The owner that a half-edge, or its start, is of.
    fn word(&self, h: u32) -> u32 {
        let face = self.topology.face(h);
        let k = h - self.topology.mesh().face_corners(face).start as u32;
        let wedge = if self.topology.face_size(h) == 3 { WEDGE_BIT } else { 0 };
        self.refined[face as usize] << OWNER_SHIFT | wedge | k
    }

    fn is_sharp(&self, h: u32) -> bool {
        self.topology.sharpness(h) >= SHARPNESS_INFINITE
    }

    fn is_coarse(&self, h: u32) -> bool {
        self.coarse[self.topology.face(h) as usize]
    }

    /// The owners of position and normal along the edge of a half-edge.
    pub(super) fn edge(&self, h: u32) -> [u32; 2] {
        let twin = self.topology.twin(h);
        if twin.is_some_and(|twin| self.is_coarse(twin)) {
            return [OWNER_NONE; 2];
        }
        let drawn = [h].into_iter().chain(twin.filter(|&twin| self.refined[self.topology.face(twin) as usize] != NONE));
        // The lower half-edge, as in every order of the patches.
        let owner = drawn.min().unwrap_or(h);
        [owner, if self.is_sharp(h) { h } else { owner }].map(|h| self.word(h))
    }

    /// The owners of position and normal where a half-edge starts.
    pub(super) fn corner(&self, h: u32) -> [u32; 2] {
        let (fan, _) = self.topology.fan(h);
        let around = self.touching.get(&self.topology.mesh_vertex(h)).unwrap_or(&fan);
        if around.iter().any(|&h| self.is_coarse(h)) {
            return [OWNER_NONE; 2];
        }
        let drawn = |h: &u32| self.refined[self.topology.face(*h) as usize] != NONE;
        let owner = around.iter().copied().filter(drawn).min().unwrap_or(h);
        // The faces on the same side of all sharp edges. Half-edges of a fan follow each other around the vertex.
        let start = fan.iter().position(|&h| self.is_sharp(h)).unwrap_or(0);
        let around = (0..fan.len()).map(|i| fan[(start + i) % fan.len()]);
        let mut sides: Vec<Vec<u32>> = vec![vec![]];
        for each in around {
            if self.is_sharp(each) && !sides[0].is_empty() {
                sides.push(vec![]);
            }
            sides.last_mut().expect("one at least").push(each);
        }
        let own = sides.into_iter().find(|side| side.contains(&h)).unwrap_or_default();
        let of_normal = own.into_iter().filter(drawn).min().unwrap_or(h);
        [owner, of_normal].map(|h| self.word(h))
    }
}
