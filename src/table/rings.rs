//! The connectivity of the two-stage construction: every one-ring in order, and what its weights are.

use super::PatchPlan;
use crate::blend::{RingShape, RingValues, Row};
use crate::constants;
use crate::patch::Scheme;
use crate::topology::{Ring, RingKind, Topology};
use rayon::prelude::*;
use std::collections::HashMap;

/// Bit of a ring entry's index: the face is a triangle, and the entry stands in for the diagonal it does not have.
pub const TRIANGLE_BIT: u32 = constants::TRIANGLE_BIT;
/// Bit of a ring entry's index: the face is a pentagon, and the entry stands for the middle of its far edge. The rest is the
/// place among the entries where that edge's two vertices are.
pub const PENTAGON_BIT: u32 = constants::PENTAGON_BIT;
/// Bit of [`RingTable::headers`]`[3]`: the first and the last edge differ.
pub const OPEN_BIT: u32 = constants::OPEN_BIT;
/// Bit of [`RingTable::headers`]`[3]`: edge points go straight at the neighbours ([`RingShape::has_frame`] is false).
pub const CONE_BIT: u32 = constants::CONE_BIT;
/// Bit of [`RingTable::headers`]`[3]`: [`RingShape::fallback`].
pub const FALLBACK_BIT: u32 = constants::FALLBACK_BIT;
/// Bit of [`RingTable::headers`]`[3]`: transversals are the scheme's own, with weights in the ring's type.
pub const FITTED_BIT: u32 = constants::FITTED_BIT;

/// One-rings as the shaders read them. GLSL twin: `glsl/lib/construct/rings.glsl`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RingTable {
    /// A ring: its vertex; where its entries start; where its type starts; its number of faces and flag bits.
    pub headers: Vec<[u32; 4]>,
    /// Vertices around a ring: `a_0, d_0, a_1, d_1, ..`, and the last edge's `a` where the ring is open. After all rings the
    /// vertices of each pentagon, with the first once more at the end.
    pub entries: Vec<u32>,
    /// For each type of ring: the vertex's weights in `p`, `a` and `b` of the [`Frame`](crate::patch::Frame) and `cos_k`; for
    /// each edge, cosine and sine of its direction and the two weights of its transversal
    /// ([`Fit::transversal_weights`](crate::patch::fitted::Fit::transversal_weights)); for each entry, its weights in `p`, `a`
    /// and `b`, and nought.
    pub types: Vec<[f32; 4]>,
    /// How many types there are.
    pub type_count: usize,
    /// For each patch corner, its ring and the ring edge that is its plus edge.
    pub corners: Vec<[u32; 2]>,
}

impl RingTable {
    /// The rings of a mesh, and the corners of the patches in `plan`.
    pub fn new(topology: &Topology, plan: &PatchPlan) -> Self {
        let mut types = RingTypes { scheme: plan.scheme(), ..RingTypes::default() };
        let mut entries = 0;
        let headers: Vec<[u32; 4]> = topology
            .rings()
            .iter()
            .zip(0..)
            .map(|(ring, number)| {
                let (kind, bits) = types.of(topology, ring, plan.fallback_rings().contains(number));
                let header = [plan.vertex(topology.mesh_vertex(ring.start)), entries, kind, ring.faces | bits];
                entries += 2 * ring.faces + u32::from(ring.open);
                header
            })
            .collect();
        let corners = plan.corners(topology);
        let corners = corners.into_par_iter().map(|h| topology.place(h)).map(|place| [place.ring, place.index]);
        let pentagons = Pentagons::new(topology, plan, entries);
        let mut entries = ring_entries(topology, plan, &pentagons, entries as usize);
        entries.extend(&pentagons.vertices);
        Self { entries, headers, types: types.vectors, type_count: types.count, corners: corners.collect() }
    }
}

/// The vertices of pentagons, as they stand after the entries of all rings.
struct Pentagons {
    vertices: Vec<u32>,
    /// Where those of each face are among the entries.
    places: HashMap<u32, u32>,
}

impl Pentagons {
    fn new(topology: &Topology, plan: &PatchPlan, first: u32) -> Self {
        let mesh = topology.mesh();
        let mut pentagons = Self { vertices: Vec::new(), places: HashMap::new() };
        for face in (0..).zip(&mesh.data().face_sizes).filter(|(_, size)| **size == 5).map(|(face, _)| face) {
            pentagons.places.insert(face, first + pentagons.vertices.len() as u32);
            let vertices = mesh.face(face).iter().chain(&mesh.face(face)[..1]);
            pentagons.vertices.extend(vertices.map(|&vertex| plan.vertex(vertex)));
        }
        pentagons
    }

    /// The entry for the edge opposite the corner from which a half-edge starts, if its face is a pentagon.
    fn entry(&self, topology: &Topology, h: u32) -> Option<u32> {
        let face = topology.face(h);
        let corner = h - topology.mesh().face_corners(face).start as u32;
        self.places.get(&face).map(|place| (place + (corner + 2) % 5) | PENTAGON_BIT)
    }
}

fn ring_entries(topology: &Topology, plan: &PatchPlan, pentagons: &Pentagons, count: usize) -> Vec<u32> {
    let at = |h: u32| plan.vertex(topology.mesh_vertex(h));
    let mut entries = vec![0; count];
    let mut slices = Vec::with_capacity(topology.rings().len());
    let mut rest = entries.as_mut_slice();
    for ring in topology.rings() {
        let (slice, tail) = rest.split_at_mut((2 * ring.faces + u32::from(ring.open)) as usize);
        slices.push((ring, slice));
        rest = tail;
    }
    slices.into_par_iter().with_min_len(1024).for_each(|(ring, slice)| {
        let mut last = ring.start;
        for (h, pair) in topology.ring_half_edges(ring).zip(slice.chunks_mut(2)) {
            let head = topology.next(h);
            let vertex = at(topology.next(head));
            // A triangle's would-be diagonal is its minus edge's neighbour.
            let triangle = topology.face_size(h) == 3;
            let vertex = if triangle { vertex | TRIANGLE_BIT } else { vertex };
            pair.copy_from_slice(&[at(head), pentagons.entry(topology, h).unwrap_or(vertex)]);
            last = h;
        }
        if let (true, Some(end)) = (ring.open, slice.last_mut()) {
            *end = at(topology.prev(last));
        }
    });
    entries
}

/// The types of rings met so far: rings of one shape share their weights.
#[derive(Default)]
struct RingTypes {
    scheme: Scheme,
    vectors: Vec<[f32; 4]>,
    count: usize,
    /// Rings of quads only, by kind, openness, faces and fallback: no need to look at their faces one by one.
    of_quads: HashMap<(RingKind, bool, u32, bool), (u32, u32)>,
    mixed: HashMap<RingShape, (u32, u32)>,
}

impl RingTypes {
    /// Where the type of a ring starts, and the bits of its header.
    fn of(&mut self, topology: &Topology, ring: &Ring, fallback: bool) -> (u32, u32) {
        let shape = || RingShape { fallback, ..RingShape::of(topology, ring) };
        if !ring.quads {
            return self.of_shape(shape());
        }
        let key = (ring.kind, ring.open, ring.faces, fallback);
        if let Some(&found) = self.of_quads.get(&key) {
            return found;
        }
        let found = self.of_shape(shape());
        self.of_quads.insert(key, found);
        found
    }

    fn of_shape(&mut self, shape: RingShape) -> (u32, u32) {
        if let Some(&found) = self.mixed.get(&shape) {
            return found;
        }
        let start = self.vectors.len() as u32;
        let frame = self.scheme.frame(&RingValues::unknowns(shape.clone()));
        let weights = |entry, last: f64| {
            let [p, a, b] = [&frame.p, &frame.a, &frame.b].map(|row| row.weight(entry));
            [p, a, b, last].map(|x| x as f32)
        };
        self.vectors.push(weights(0, shape.cosine()));
        let mut fitted = false;
        for j in 0..shape.edges() {
            let transversal = self.scheme.transversal_weights(&shape, j);
            fitted |= transversal != [1.0, 0.0];
            let ([cosine, sine], [r, turned]) = (shape.edge_direction(j), transversal);
            self.vectors.push([cosine, sine, r, turned].map(|x| x as f32));
        }
        self.vectors.extend((1..=(shape.faces() + shape.edges()) as u32).map(|entry| weights(entry, 0.0)));
        self.count += 1;
        let bits = [
            (shape.open, OPEN_BIT),
            (!shape.has_frame(), CONE_BIT),
            (shape.fallback, FALLBACK_BIT),
            (fitted, FITTED_BIT),
        ];
        let found = (start, bits.into_iter().filter(|bit| bit.0).map(|bit| bit.1).sum());
        self.mixed.insert(shape, found);
        found
    }
}

impl RingValues<Row> {
    /// A ring whose values are unknowns, numbered as in a table: 0 for the vertex, then `a_0, d_0, a_1, d_1, ..`.
    pub(super) fn unknowns(shape: RingShape) -> Self {
        Self {
            centre: Row::unit(0),
            edges: (0..shape.edges() as u32).map(|j| Row::unit(1 + 2 * j)).collect(),
            diagonals: (0..shape.faces() as u32).map(|i| Row::unit(2 + 2 * i)).collect(),
            shape,
        }
    }
}
