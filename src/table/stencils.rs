//! The weights of the stencil construction, one set for each type of connectivity around a patch.

use super::PatchPlan;
use crate::blend::{RingShape, RingValues, Row};
use crate::mesh::MeshError;
use crate::patch::{FallbackRings, Scheme};
use crate::table::Patch;
use crate::topology::Topology;
use rayon::prelude::*;
use std::collections::HashMap;

/// Patches as weighted sums of the vertices around them. GLSL twin: `glsl/lib/construct/stencils.glsl`.
///
/// Within a group of the plan, patches are sorted by type.
///
/// What patches share (the limit point of a corner and its edge points) every one of them sums in the same order: that
/// of the corner's one-ring, from where the ring starts. The weights are stored once a type, in the order in which
/// the patch sees the ring; how far it has to be turned is stored for each patch.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StencilTable {
    /// For each patch, where its vertices start and where its type starts.
    pub patches: Vec<[u32; 2]>,
    /// For each patch, for each of its corners how many entries the corner's ring is to be turned by; then the vertices
    /// of its one-ring.
    pub vertices: Vec<u32>,
    /// For each type, in words: for each corner of the patch where its entries start (counted from the start of the
    /// type), how many there are, and how many can be turned: those after the first. Then the entries: the number of
    /// a vertex in the patch's one-ring and, as f32 bits, its weights in what is kept of the control points that the
    /// corner owns ([`Scheme::corner_slots`]; after the limit point, vectors from there and between them). First those of the corner's ring, then others that have weight.
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
        let mut shared = SharedRows { scheme: plan.scheme(), fallback: plan.fallback_rings(), known: HashMap::new() };
        let mut types: HashMap<Key, (u32, u32)> = HashMap::new();
        let mut rings: Vec<(u32, u32, PatchRing)> = Vec::with_capacity(plan.patches().len());
        for (chunk, keys) in chunks {
            let mut keys: Vec<_> = keys.into_iter().collect();
            keys.sort_unstable_by_key(|(_, (number, _))| *number);
            let places: Vec<(u32, u32)> = keys
                .into_iter()
                .map(|(key, (_, example))| {
                    let next = types.len() as u32;
                    *types.entry(key).or_insert_with(|| (next, table.push_type(topology, &mut shared, &chunk[example])))
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
            let corners = ring.patch.corners(topology);
            table.vertices.extend(corners.map(|h| CornerRing::turn(topology, h)));
            table.vertices.extend(ring.vertices.iter().map(|&vertex| plan.vertex(vertex)));
            table.largest_ring = table.largest_ring.max(ring.vertices.len());
        }
        plan.reorder(rings.into_iter().map(|(_, _, ring)| ring.patch).collect());
        Ok(table)
    }

    /// Appends the weights for patches connected like `ring`'s. Gives where they start.
    fn push_type(&mut self, topology: &Topology, shared: &mut SharedRows, ring: &PatchRing) -> u32 {
        let local: HashMap<u32, u32> = ring.vertices.iter().zip(0..).map(|(&vertex, i)| (vertex, i)).collect();
        let Patch { kind, scheme, .. } = ring.patch;
        let rows = ring.patch.control_points(topology, shared.fallback, |vertex| Row::unit(local[&vertex]));
        let start = self.types.len();
        self.types.resize(start + HEAD_WORDS * kind.corners(), 0);
        for (k, h) in ring.patch.corners(topology).enumerate() {
            let owned = scheme.corner_slots(kind, k).into_iter().map(|slot| rows[slot].clone()).collect::<Vec<_>>();
            let kept = scheme.kept(kind, &owned);
            let first = self.types.len();
            let ring_of_corner = CornerRing::of(topology, shared.fallback, h);
            let of_frame = if scheme.shares_frame(kind) { shared.of(&ring_of_corner) } else { &[] };
            // The other control points take each vertex once, wherever it is met first.
            let mut pending = vec![true; ring.vertices.len()];
            let around = ring_of_corner.entries.iter().map(|&(vertex, entry)| (local[&vertex], Some(entry)));
            for (vertex, entry) in around.chain((0..ring.vertices.len() as u32).map(|vertex| (vertex, None))) {
                let own = std::mem::replace(&mut pending[vertex as usize], false);
                let weights: Vec<f32> = (kept.iter().enumerate())
                    .map(|(i, row)| match of_frame.get(i) {
                        Some(row) => entry.map_or(0.0, |entry| row.weight(entry)),
                        None if own => row.weight(vertex),
                        None => 0.0,
                    } as f32)
                    .collect();
                if entry.is_some() || weights.iter().any(|&w| w != 0.0) {
                    self.types.push(vertex);
                    self.types.extend(weights.into_iter().map(f32::to_bits));
                }
            }
            let count = (self.types.len() - first) / (1 + kept.len());
            let head = [first - start, count, ring_of_corner.turning].map(|word| word as u32);
            self.types[start + HEAD_WORDS * k..][..HEAD_WORDS].copy_from_slice(&head);
        }
        start as u32
    }
}

/// Words at the start of a type for each corner.
const HEAD_WORDS: usize = crate::constants::HEAD_WORDS as usize;

/// The one-ring of a patch corner, as the patch sees it.
struct CornerRing {
    /// The shape of the ring, a closed one turned to begin with the corner's plus edge.
    shape: RingShape,
    /// The ring edge that is the corner's plus edge: 0 in a closed ring.
    plus: usize,
    /// Vertices in the order in which they are summed, with their numbers as in [`RingValues::unknowns`].
    entries: Vec<(u32, u32)>,
    /// How many entries, after the first, are in a circle.
    turning: usize,
}

impl CornerRing {
    /// In a closed ring first the vertex itself, then around it from the plus edge of half-edge `h`. In an open ring the ends
    /// come first, as in `ring_frame` of `glsl/lib/construct/rings.glsl`: the ring on the other side of a crease has them the other
    /// way round.
    fn of(topology: &Topology, fallback: &FallbackRings, h: u32) -> Self {
        let place = topology.place(h);
        let ring = &topology.rings()[place.ring as usize];
        let at = |h: u32| topology.mesh_vertex(h);
        let RingValues { mut shape, centre, mut edges, mut diagonals } = RingValues::collect(topology, ring, at, at);
        shape.fallback = fallback.contains(place.ring);
        let (faces, index) = (shape.faces(), place.index as usize);
        if !shape.open {
            shape.triangles.rotate_left(index);
            edges.rotate_left(index);
            diagonals.rotate_left(index);
        }
        let edge = |j: usize| (edges[j], 1 + 2 * j as u32);
        let diagonal = |i: usize| (!shape.triangles[i]).then(|| (diagonals[i], 2 + 2 * i as u32));
        let ends = if shape.open { vec![edge(0), edge(faces)] } else { Vec::new() };
        let mut entries = [ends, vec![(centre, 0)]].concat();
        let before = entries.len();
        for i in 0..faces {
            if i > 0 || !shape.open {
                entries.push(edge(i));
            }
            entries.extend(diagonal(i));
        }
        let turning = if shape.open { 0 } else { entries.len() - before };
        Self { plus: if shape.open { index } else { 0 }, shape, entries, turning }
    }

    /// By how many entries a corner's ring has to be turned for it to begin where the ring itself does.
    fn turn(topology: &Topology, h: u32) -> u32 {
        let place = topology.place(h);
        let ring = &topology.rings()[place.ring as usize];
        if ring.open || place.index == 0 {
            0
        } else if ring.quads {
            2 * (ring.faces - place.index)
        } else {
            // From the patch on to the end of the ring.
            let after = topology.ring_half_edges(ring).skip(place.index as usize);
            after.map(|h| if topology.face_size(h) == 3 { 1 } else { 2 }).sum()
        }
    }
}

/// The limit point of a corner and, as seen from there, its edge points at the plus and the minus edge: what patches share.
///
/// All faces around a vertex get weights with the same bits: each row is made with the ring turned in a way that does not
/// depend on the face that asks.
struct SharedRows<'p> {
    scheme: Scheme,
    fallback: &'p FallbackRings,
    /// By the shape of the ring and its plus edge.
    known: HashMap<(RingShape, usize), [Row; 3]>,
}

impl SharedRows<'_> {
    fn of(&mut self, ring: &CornerRing) -> &[Row] {
        let key = (ring.shape.clone(), ring.plus);
        let scheme = self.scheme;
        self.known.entry(key).or_insert_with(|| {
            if ring.shape.open { open_rows(scheme, &ring.shape, ring.plus) } else { closed_rows(scheme, &ring.shape) }
        })
    }
}

fn open_rows(scheme: Scheme, shape: &RingShape, plus: usize) -> [Row; 3] {
    let ring = RingValues::unknowns(shape.clone());
    let frame = scheme.frame(&ring);
    [frame.p.clone(), ring.edge_vector(&frame, plus), ring.edge_vector(&frame, plus + 1)]
}

fn closed_rows(scheme: Scheme, shape: &RingShape) -> [Row; 3] {
    let faces = shape.faces();
    let turned = |by: usize| {
        let mut shape = shape.clone();
        shape.triangles.rotate_left(by % faces);
        shape
    };
    // From the numbers of the turned ring to those of the ring; the vertex itself stays 0.
    let back = |row: &Row, by: usize| {
        let number = |entry: u32| if entry == 0 { 0 } else { 1 + (entry - 1 + 2 * by as u32) % (2 * faces as u32) };
        Row::new(row.weights().iter().map(|&(entry, weight)| (number(entry), weight)).collect())
    };
    let edge = |j: usize| {
        let ring = RingValues::unknowns(turned(j));
        back(&ring.edge_vector(&scheme.frame(&ring), 0), j)
    };
    // The limit point from the least of all turned shapes; turns that do not change it must not change the weights.
    let least = (0..faces).min_by_key(|&by| turned(by).triangles).unwrap_or(0);
    let canonical = turned(least);
    let period = (1..=faces).find(|&by| turned(least + by) == canonical).unwrap_or(faces) as u32;
    let p = scheme.frame(&RingValues::unknowns(canonical)).p;
    let alike = |entry: u32| if entry == 0 { 0 } else { 1 + (entry - 1) % (2 * period) };
    let p = Row::new((0..=2 * faces as u32).map(|entry| (entry, p.weight(alike(entry)))).collect());
    [back(&p, least), edge(0), edge(1)]
}

/// An upper bound of [`StencilTable::vertices`]: what two corners of a patch share is counted twice.
fn largest_vertex_count(topology: &Topology, plan: &PatchPlan) -> usize {
    let around = |h: &u32| {
        let ring = &topology.rings()[topology.place(*h).ring as usize];
        // Pentagons have one vertex more.
        let others = if ring.quads { ring.faces } else { 2 * ring.faces };
        2 + others as usize + ring.edges() as usize
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
