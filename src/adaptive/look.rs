//! What the rows of end caps depend on.

use super::caps::{Around, MANY};
use rustc_hash::FxBuildHasher;
use std::collections::HashMap;

/// What was seen around some caps.
pub(super) struct Seen {
    /// The keys of their patterns.
    pub keys: Vec<Vec<u32>>,
    pub caps: Vec<SeenCap>,
    /// The vertices of the caps that have patterns.
    pub vertices: Vec<u32>,
}

/// What was seen around a cap.
pub(super) struct SeenCap {
    /// The pattern; none if the cap has rows of its own.
    pub key: Option<usize>,
    /// Number of its vertices.
    pub vertices: usize,
}

impl Seen {
    pub(super) fn new(around: &Around, quads: &[[u32; 4]]) -> Self {
        let mut look = Look { around, key: Vec::new(), vertices: Vec::new() };
        let mut numbers: HashMap<Vec<u32>, usize, FxBuildHasher> = HashMap::default();
        let (mut caps, mut vertices) = (Vec::with_capacity(quads.len()), Vec::with_capacity(32 * quads.len()));
        for &quad in quads {
            if !quad.into_iter().all(|h| look.is_plain(h)) {
                caps.push(SeenCap { key: None, vertices: 0 });
                continue;
            }
            look.at(quad);
            let next = numbers.len();
            let key = match numbers.get(&look.key) {
                Some(&known) => known,
                None => *numbers.entry(look.key.clone()).or_insert(next),
            };
            caps.push(SeenCap { key: Some(key), vertices: look.vertices.len() });
            vertices.extend_from_slice(&look.vertices);
        }
        let mut keys = vec![Vec::new(); numbers.len()];
        numbers.into_iter().for_each(|(key, number)| keys[number] = key);
        Self { keys, caps, vertices }
    }
}

/// A look around one cap.
struct Look<'t> {
    around: &'t Around<'t>,
    /// All that the rows depend on but for the vertices' numbers: the shape of the ring around each corner and the edge in it;
    /// and each vertex of the rings, its number among those that differ.
    key: Vec<u32>,
    /// The vertices that differ.
    vertices: Vec<u32>,
}

impl Look<'_> {
    /// Whether the ring in which a half-edge is has a place in a key.
    fn is_plain(&self, h: u32) -> bool {
        let topology = self.around.topology;
        let ring = &topology.rings()[topology.place(h).ring as usize];
        ring.faces <= MANY
            && (ring.quads || topology.ring_half_edges(ring).all(|h| topology.face_size(h) <= 4))
            && self.around.is_settled(h)
    }

    fn at(&mut self, quad: [u32; 4]) {
        let topology = self.around.topology;
        self.key.clear();
        self.vertices.clear();
        for place in quad.map(|h| topology.place(h)) {
            let ring = &topology.rings()[place.ring as usize];
            let shape = self.key.len();
            self.key.extend([ring.kind as u32 | u32::from(ring.open) << 2 | ring.faces << 3 | place.index << 16, 0]);
            self.see(ring.start);
            let (mut diagonals, mut last) = ([0; MANY as usize], ring.start);
            for (i, h) in topology.ring_half_edges(ring).enumerate() {
                let head = topology.next(h);
                self.see(head);
                diagonals[i] = topology.next(head);
                self.key[shape + 1] |= u32::from(topology.face_size(h) == 3) << i;
                last = h;
            }
            if ring.open {
                self.see(topology.prev(last));
            }
            diagonals[..ring.faces as usize].iter().for_each(|&h| self.see(h));
        }
    }

    /// Appends the number of the vertex from which a half-edge starts.
    fn see(&mut self, h: u32) {
        let vertex = self.around.vertex(h);
        let known = self.vertices.iter().position(|&v| v == vertex);
        self.key.push(known.unwrap_or(self.vertices.len()) as u32);
        if known.is_none() {
            self.vertices.push(vertex);
        }
    }
}
