//! What a geometry shader needs to subdivide a face on its own: the vertices around each corner, and what the rules make of
//! them.

use super::PatchPlan;
use super::bytes::bytes;
use crate::blend::Row;
use crate::constants;
use crate::limit::{EdgeProfile, Fan, FanRows, Fans, LEVELS};
use crate::mesh::{CreaseMethod, MeshError, SHARPNESS_INFINITE};
use crate::topology::Topology;
use std::collections::HashMap;

/// Bit of [`SubdivisionTable::headers`]`[3]`: the first and the last edge differ.
pub const FAN_OPEN_BIT: u32 = constants::FAN_OPEN_BIT;
/// Words of a type before its weights. GLSL twin: `TYPE_HEAD` in `glsl/lib/constants.glsl`.
const TYPE_HEAD: usize = constants::TYPE_HEAD as usize;

/// All faces around each vertex of a mesh of quads (a fan), and the weights of what refinement makes of the vertex and its
/// neighbours. GLSL twin: `glsl/lib/subdivide/subdivision.glsl`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SubdivisionTable {
    /// A fan: its vertex; where its entries start; where its type starts; its number of faces and flag bits.
    pub headers: Vec<[u32; 4]>,
    /// For each edge of a fan, counter-clockwise: the vertex at its other end, the vertex of the face to its left opposite the
    /// fan's (or at the last edge of an open fan any), and where the edge's profile starts.
    pub entries: Vec<[u32; 3]>,
    /// Types of fans and profiles of edges. Numbers that are no offsets are the bits of an `f32`.
    ///
    /// A type has a head of 10 words: where the row of edge 0 starts, and how far it is to that of the next; then for levels 0 to
    /// 3 where the tangents of face 0 start, and how far it is to those of the next. Weights follow, of the vertices around, `a_0, d_0, a_1, d_1, ..` as seen from the fan's vertex, three for each: in that vertex
    /// at levels 1 to 3. Rows have two for each, in the next vertex along the edge at levels 2 and 3; tangents two, in both of
    /// them. Where nothing is sharp that is some 30 n words for n faces, else some 8 n².
    ///
    /// A profile: 7 weights of edges, 4 of vertices, and bits (`EdgeProfile` in `src/limit/sharpness.rs`).
    pub words: Vec<u32>,
    /// How many types there are.
    pub type_count: usize,
    /// For each corner of each patch, in the order of the plan, its fan and the edge of it that leads to the next corner.
    pub corners: Vec<[u32; 2]>,
}

impl SubdivisionTable {
    /// The fans of a mesh of quads, and the corners of the patches in `plan`.
    ///
    /// # Errors
    /// [`MeshError::TooLarge`] if there are more weights than can be addressed: with sharp edges at vertices of thousands of
    /// faces.
    pub fn new(topology: &Topology, plan: &PatchPlan) -> Result<Self, MeshError> {
        let all = Fans::new(topology);
        let at = |h: u32| plan.vertex(topology.mesh_vertex(h));
        let corner_count = topology.mesh().corner_count();
        let mut places = vec![[u32::MAX; 2]; corner_count];
        let mut fans = Vec::new();
        // What is left of sharp edges where a half-edge starts.
        let mut sharp_ends = HashMap::new();
        for start in 0..corner_count as u32 {
            if places[start as usize][0] != u32::MAX {
                continue;
            }
            let fan = all.around(start);
            for (place, &h) in (0..).zip(&fan.half_edges) {
                places[h as usize] = [fans.len() as u32, place];
            }
            if fan.sharpness.iter().any(|&s| s > 0.0) {
                sharp_ends.extend(fan.half_edges.iter().copied().zip(fan.evolution()));
            }
            fans.push(fan);
        }
        let mut words = Words { method: topology.mesh().data().crease_method, ..Words::default() };
        let mut table = Self::default();
        for fan in &fans {
            let bits = fan.half_edges.len() as u32 | if fan.open { FAN_OPEN_BIT } else { 0 };
            let vertex = at(fan.half_edges[0]);
            table.headers.push([vertex, table.entries.len() as u32, words.of_fan(&all, fan)?, bits]);
            for (&h, &sharpness) in fan.half_edges.iter().zip(&fan.sharpness) {
                let end = |h| sharp_ends.get(&h).copied().unwrap_or([0.0; LEVELS]);
                let profile = match topology.twin(h) {
                    Some(twin) => words.of_edge(sharpness, [end(h), end(twin)]),
                    None => words.of_boundary(),
                };
                let head = topology.next(h);
                table.entries.push([at(head), at(topology.next(head)), profile]);
            }
            if let (true, Some(&last)) = (fan.open, fan.half_edges.last()) {
                let end = at(topology.prev(last));
                table.entries.push([end, end, words.of_boundary()]);
            }
        }
        table.corners = plan.corners(topology).into_iter().map(|h| places[h as usize]).collect();
        (table.type_count, table.words) = (words.type_count, words.words);
        Ok(table)
    }

    /// Bytes of all arrays together.
    pub fn bytes(&self) -> u64 {
        bytes(&self.headers) + bytes(&self.entries) + bytes(&self.words) + bytes(&self.corners)
    }
}

/// Types and profiles met so far.
#[derive(Default)]
struct Words {
    method: CreaseMethod,
    words: Vec<u32>,
    type_count: usize,
    /// Types of fans that do not look further, by what their weights depend on: whether they are open, and the bits of the
    /// sharpness of the vertex and of each edge.
    types: HashMap<(bool, Vec<u32>), u32>,
    /// All types and profiles, by their words.
    known: HashMap<Vec<u32>, u32>,
    /// Profiles by the bits of the sharpness they are made from.
    profiles: HashMap<[u32; 1 + 2 * LEVELS], u32>,
}

impl Words {
    /// Where the type of a fan starts.
    fn of_fan(&mut self, all: &Fans, fan: &Fan) -> Result<u32, MeshError> {
        if fan.looks_further() {
            return self.add_type(fan, &all.rows(fan)?);
        }
        let sharpness = std::iter::once(fan.vertex_sharpness).chain(fan.sharpness.iter().copied());
        let key = (fan.open, sharpness.map(f32::to_bits).collect());
        if let Some(&start) = self.types.get(&key) {
            return Ok(start);
        }
        let start = self.add_type(fan, &all.rows(fan)?)?;
        self.types.insert(key, start);
        Ok(start)
    }

    fn add_type(&mut self, fan: &Fan, rows: &FanRows) -> Result<u32, MeshError> {
        let entries = 1..=(fan.half_edges.len() + fan.edges()) as u32;
        let weights = |rows: &[&Row]| -> Vec<u32> {
            let of_entry = |entry| rows.iter().map(move |row| (row.weight(entry) as f32).to_bits());
            entries.clone().flat_map(of_entry).collect()
        };
        let mut words = vec![0; TYPE_HEAD];
        words.extend(weights(&rows.vertex.iter().collect::<Vec<_>>()));
        let row = |j: usize| weights(&[&rows.spokes[0][j], &rows.spokes[1][j]]);
        let of_edge = row(0);
        if fan.is_rotational() {
            // The row of edge j is that of edge 0 turned by two entries an edge: it starts before the middle of the same twice.
            [words[0], words[1]] = [(words.len() + of_edge.len()) as u32, 4u32.wrapping_neg()];
            words.extend_from_slice(&of_edge);
            words.extend_from_slice(&of_edge);
        } else {
            [words[0], words[1]] = [words.len(), of_edge.len()].map(|x| x as u32);
            (0..fan.edges()).for_each(|j| words.extend(row(j)));
        }
        for (level, tangents) in rows.tangents.iter().enumerate() {
            let step = if tangents.len() == 1 { 0 } else { of_edge.len() };
            [words[2 + 2 * level], words[3 + 2 * level]] = [words.len(), step].map(|x| x as u32);
            tangents.iter().for_each(|[a, b]| words.extend(weights(&[a, b])));
        }
        let known = self.known.len();
        let start = self.add(words);
        self.type_count += self.known.len() - known;
        let (count, max) = (self.words.len(), i32::MAX as usize);
        if count > max { Err(MeshError::TooLarge { what: "weights", count, max }) } else { Ok(start) }
    }

    /// Where the profile of an edge starts, of which this is left at both ends.
    fn of_edge(&mut self, sharpness: f32, ends: [[f32; LEVELS]; 2]) -> u32 {
        let mut key = [sharpness.to_bits(); 1 + 2 * LEVELS];
        key[1..].iter_mut().zip(ends.as_flattened()).for_each(|(bits, end)| *bits = end.to_bits());
        if let Some(&start) = self.profiles.get(&key) {
            return start;
        }
        let EdgeProfile { edges, vertices, creased } = EdgeProfile::new(self.method, sharpness, ends);
        let weights = edges.iter().chain(&vertices).map(|weight| weight.to_bits());
        let start = self.add(weights.chain([creased]).collect());
        self.profiles.insert(key, start);
        start
    }

    fn of_boundary(&mut self) -> u32 {
        self.of_edge(SHARPNESS_INFINITE, [[SHARPNESS_INFINITE; LEVELS]; 2])
    }

    fn add(&mut self, words: Vec<u32>) -> u32 {
        let start = self.words.len() as u32;
        *self.known.entry(words).or_insert_with_key(|words| {
            self.words.extend_from_slice(words);
            start
        })
    }
}
