//! The weights of the stencil construction, one set for each type of connectivity around a patch.

use super::{PatchPlan, bytes};
use crate::mesh::MeshError;
use crate::patch::{FallbackRings, Row};
use crate::table::Patch;
use crate::topology::Topology;
use rayon::prelude::*;
use std::collections::HashMap;

/// Patches as weighted sums of the vertices around them. GLSL twin: `glsl/lib/stencils.glsl`.
///
/// Within a group of the plan, patches are sorted by type.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StencilTable {
    /// For each patch, where its vertices start and where its type starts.
    pub patches: Vec<[u32; 2]>,
    /// The vertices of the one-ring of each patch.
    pub vertices: Vec<u32>,
    /// For each type, in words: for each corner of the patch where its entries start (counted from the start of the
    /// type) and how many there are; then the entries: the number of a vertex in the patch's one-ring and, as f32
    /// bits, its weights in the control points that the corner owns ([`Scheme::corner_slots`](crate::Scheme::corner_slots)). Vertices without weight are left out.
    pub types: Vec<u32>,
    /// How many types there are.
    pub type_count: usize,
    /// Vertices in the largest one-ring of a patch.
    pub largest_ring: usize,
}

/// The connectivity around a patch: what its weights depend on.
type Key = Vec<u32>;

/// The one-ring of a patch.
struct PatchRing {
    patch: Patch,
    vertices: Vec<u32>,
    /// Its type, as numbered within a chunk of patches.
    kind: u32,
}

impl StencilTable {
    /// Builds the table and sorts the patches of each group by type: `plan` becomes the order of the table.
    ///
    /// # Errors
    /// [`MeshError::TooLarge`] if the one-rings of all patches together have more vertices than can be addressed. A
    /// vertex of valence n alone takes n * n; the two-stage construction takes n.
    pub fn new(topology: &Topology, plan: &mut PatchPlan) -> Result<Self, MeshError> {
        let (count, max) = (largest_vertex_count(topology, plan), u32::MAX as usize);
        if count > max {
            return Err(MeshError::TooLarge { what: "vertices around its patches (stencil construction)", count, max });
        }
        let chunk = plan.patches().len().div_ceil(4 * rayon::current_num_threads()).max(256);
        let chunks: Vec<_> = plan
            .patches()
            .par_chunks(chunk)
            .map(|patches| {
                // Types are found chunk by chunk, then made one list.
                let mut keys: HashMap<Key, (u32, usize)> = HashMap::new();
                let mut rings = Vec::with_capacity(patches.len());
                for &patch in patches {
                    let (vertices, key) = patch_ring(topology, plan.fallback_rings(), patch);
                    let next = (keys.len() as u32, rings.len());
                    let (kind, _) = *keys.entry(key).or_insert(next);
                    rings.push(PatchRing { patch, vertices, kind });
                }
                (rings, keys)
            })
            .collect();

        let mut table = Self::default();
        let mut types: HashMap<Key, (u32, u32)> = HashMap::new();
        let mut rings: Vec<(u32, u32, PatchRing)> = Vec::with_capacity(plan.patches().len());
        for (chunk, keys) in chunks {
            let mut keys: Vec<_> = keys.into_iter().collect();
            keys.sort_unstable_by_key(|(_, (number, _))| *number);
            let places: Vec<(u32, u32)> = keys
                .into_iter()
                .map(|(key, (_, example))| {
                    let next = types.len() as u32;
                    *types
                        .entry(key)
                        .or_insert_with(|| (next, table.push_type(topology, plan.fallback_rings(), &chunk[example])))
                })
                .collect();
            rings.extend(chunk.into_iter().map(|ring| {
                let (number, start) = places[ring.kind as usize];
                (number, start, ring)
            }));
        }
        table.type_count = types.len();
        rings.sort_by_key(|(number, _, ring)| (ring.patch.group(), *number));
        for (_, start, ring) in &rings {
            table.patches.push([table.vertices.len() as u32, *start]);
            table.vertices.extend(&ring.vertices);
            table.largest_ring = table.largest_ring.max(ring.vertices.len());
        }
        plan.reorder(rings.into_iter().map(|(_, _, ring)| ring.patch).collect());
        Ok(table)
    }

    /// Bytes of all arrays together.
    pub fn bytes(&self) -> u64 {
        bytes(&self.patches) + bytes(&self.vertices) + bytes(&self.types)
    }

    /// Appends the weights for patches connected like `ring`'s. Gives where they start.
    fn push_type(&mut self, topology: &Topology, fallback: &FallbackRings, ring: &PatchRing) -> u32 {
        let local: HashMap<u32, u32> = ring.vertices.iter().zip(0..).map(|(&vertex, i)| (vertex, i)).collect();
        let patch = ring.patch;
        let rows = patch.control_points(topology, fallback, |vertex| Row::unit(local[&vertex]));
        let corners = patch.kind.corners();
        let start = self.types.len();
        self.types.resize(start + 2 * corners, 0);
        let mut weights = Vec::with_capacity(patch.scheme.owned(patch.kind));
        for k in 0..corners {
            let owned = patch.scheme.corner_slots(patch.kind, k);
            let first = self.types.len();
            for vertex in 0..ring.vertices.len() as u32 {
                weights.clear();
                weights.extend(owned.iter().map(|&slot| rows[slot].weight(vertex) as f32));
                if weights.iter().any(|&w| w != 0.0) {
                    self.types.push(vertex);
                    self.types.extend(weights.iter().map(|w| w.to_bits()));
                }
            }
            self.types[start + 2 * k] = (first - start) as u32;
            self.types[start + 2 * k + 1] = ((self.types.len() - first) / (1 + owned.len())) as u32;
        }
        start as u32
    }
}

/// An upper bound of the vertices in all one-rings: what two corners of a patch share is counted twice.
fn largest_vertex_count(topology: &Topology, plan: &PatchPlan) -> usize {
    let around = |h: &u32| {
        let ring = &topology.rings()[topology.place(*h).ring as usize];
        // Pentagons have one vertex more.
        let others = if ring.quads { ring.faces } else { 2 * ring.faces };
        1 + others as usize + ring.edges() as usize
    };
    plan.corners(topology).iter().map(around).sum()
}

/// The vertices of a patch's one-ring and its connectivity, from a walk around it that starts at its first corner.
/// Patches with the same connectivity are of one type.
fn patch_ring(topology: &Topology, fallback: &FallbackRings, patch: Patch) -> (Vec<u32>, Key) {
    let half_edges = patch.corners(topology);
    let mut walk = Walk { vertices: Vec::with_capacity(16), numbers: HashMap::new(), key: Vec::with_capacity(48) };
    walk.key.extend([patch.kind as u32, patch.scheme as u32]);
    for h in half_edges.clone() {
        walk.visit(topology.mesh_vertex(h));
    }
    for h in half_edges {
        let place = topology.place(h);
        let ring = &topology.rings()[place.ring as usize];
        let from = if ring.open { 0 } else { place.index };
        let rule = [ring.kind as u32, ring.open.into(), fallback.contains(place.ring).into()];
        walk.key.extend(rule.into_iter().chain([ring.faces, place.index - from]));
        // From the patch itself around a closed ring; along an open one.
        let (mut at, mut faces) = (if ring.open { ring.start } else { h }, ring.faces);
        loop {
            let head = topology.next(at);
            walk.key.push(topology.face_size(at));
            walk.visit(topology.mesh_vertex(head));
            let opposite = topology.next(head);
            walk.visit(topology.mesh_vertex(opposite));
            if topology.face_size(at) == 5 {
                walk.visit(topology.mesh_vertex(topology.next(opposite)));
            }
            faces -= 1;
            let back = topology.prev(at);
            match topology.twin(back) {
                Some(next) if faces > 0 => at = next,
                _ => {
                    walk.visit(topology.mesh_vertex(back));
                    break;
                }
            }
        }
    }
    (walk.vertices, walk.key)
}

/// The vertices met around a patch, numbered as they come.
struct Walk {
    vertices: Vec<u32>,
    /// Numbers of the vertices, once there are too many to search.
    numbers: HashMap<u32, u32>,
    key: Key,
}

impl Walk {
    fn visit(&mut self, vertex: u32) {
        const SEARCHED: usize = 48;
        let next = self.vertices.len() as u32;
        let number = if self.vertices.len() <= SEARCHED {
            self.vertices.iter().position(|&v| v == vertex).map_or(next, |i| i as u32)
        } else {
            if self.numbers.is_empty() {
                self.numbers = self.vertices.iter().zip(0..).map(|(&v, i)| (v, i)).collect();
            }
            *self.numbers.entry(vertex).or_insert(next)
        };
        if number == next {
            self.vertices.push(vertex);
        }
        self.key.push(number);
    }
}
