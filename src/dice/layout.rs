//! Who writes which vertex: every corner and every edge is owned by one facet, and the vertices of a facet lie in a row.
//!
//! ```text
//!  vertices:  | owned by facet 0            | owned by facet 1 | ..  | copies of facet 0 | copies of facet 1 | ..
//!             | corners | sides | inside    |
//! ```
//!
//! A *copy* has the position of another vertex, and a normal or texture coordinates of its own: along an infinitely sharp
//! crease, or a seam.

use super::error::DiceError;
use super::finer::Hole;
use super::sectors::{Corners, Role};
use crate::topology::Topology;

/// What a facet writes, and where what lies around it is.
#[derive(Debug)]
pub(super) struct Facet {
    /// Its number.
    pub facet: u32,
    /// It has `2^depth` segments along each side.
    pub depth: u32,
    /// The same of its edges: the greater depth of the facets on both sides.
    pub edges: [u32; 4],
    pub corners: [(Role, u32); 4],
    /// The first vertex inside each edge: from corner k on if the facet writes it, else from corner k + 1.
    pub sides: [(Role, u32); 4],
    /// The first vertex inside.
    pub inside: u32,
    /// The first vertex that it owns.
    pub first: u32,
    /// The first copy that it writes.
    pub copies: u32,
    /// Its first quad.
    pub quads: u32,
    /// Its first triangle.
    pub triangles: u32,
    pub holes: Box<[Hole]>,
}

/// Where a copy takes from what it has in common with others.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source {
    pub position: u32,
    /// The copy itself across a crease.
    pub normal: u32,
}

/// The vertices and faces of all facets.
#[derive(Debug)]
pub(super) struct Layout {
    pub facets: Vec<Facet>,
    /// Vertices that are no copies.
    pub owned: u32,
    /// Of each copy.
    pub sources: Vec<Source>,
    /// Vertices whose normal is the mean of their faces', with the half-edges from there.
    pub blunt: Vec<(u32, Vec<u32>)>,
    pub quads: u32,
    pub triangles: u32,
}

/// What lies along a half-edge inside the output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Split {
    /// Normals differ.
    pub crease: bool,
    /// Texture coordinates differ.
    pub seam: bool,
}

impl Split {
    pub(super) fn any(self) -> bool {
        self.crease || self.seam
    }
}

/// Points inside an edge with so many halvings.
fn inside(depth: u32) -> u64 {
    (1 << depth) - 1
}

/// Index in a list of those with a role, and the number of these.
fn rank(roles: [(Role, u32); 4], k: usize) -> u32 {
    roles[..k].iter().filter(|(role, _)| *role == roles[k].0).count() as u32
}

impl Layout {
    /// `depths` tells how often each facet is halved, `None` of those that are left out; `holes` their holes; `splits` what lies along
    /// each half-edge.
    pub(super) fn new<'h>(
        topology: &Topology,
        depths: &[Option<u32>],
        holes: impl Fn(u32) -> &'h [Hole],
        splits: impl Fn(u32) -> Split,
    ) -> Result<Self, DiceError> {
        let corners = Corners::new(topology, depths, &splits);
        let mut places = vec![u32::MAX; depths.len()];
        let mut facets: Vec<Facet> = Vec::with_capacity(depths.len());
        let [mut owned, mut copies, mut quads, mut triangles] = [0u64; 4];
        for (number, depth) in (0..).zip(depths) {
            let Some(depth) = *depth else { continue };
            places[number as usize] = facets.len() as u32;
            let mut facet = Facet::new(topology, &corners, depths, &splits, number, depth);
            facet.holes = holes(number).into();
            [facet.first, facet.copies] = [owned, copies].map(|count| count as u32);
            [facet.quads, facet.triangles] = [quads, triangles].map(|count| count as u32);
            let [of_owned, of_copies] = facet.place();
            owned += of_owned;
            copies += of_copies;
            let [of_quads, of_triangles] = facet.face_counts();
            quads += of_quads;
            triangles += of_triangles;
            facets.push(facet);
        }
        for (what, count) in [("vertices", owned + copies), ("quads", quads), ("triangles", triangles)] {
            let max = u64::from(u32::MAX);
            if count > max {
                return Err(DiceError::TooLarge { what, count, max });
            }
        }
        let mut layout = Self {
            facets,
            owned: owned as u32,
            sources: Vec::with_capacity(copies as usize),
            blunt: Vec::new(),
            quads: quads as u32,
            triangles: triangles as u32,
        };
        layout.join(topology, &corners, &places, &splits);
        Ok(layout)
    }

    /// Number of vertices.
    pub(super) fn vertices(&self) -> usize {
        self.owned as usize + self.sources.len()
    }

    /// Tells facets the vertices that others write, and copies where they take from.
    fn join(&mut self, topology: &Topology, corners: &Corners, places: &[u32], splits: &impl Fn(u32) -> Split) {
        let owned = self.owned;
        for facet in &mut self.facets {
            facet.copies += owned;
            for (role, first) in facet.corners.iter_mut().chain(&mut facet.sides) {
                *first += if *role == Role::Copy { owned } else { 0 };
            }
        }
        let written = |facets: &[Facet], h: u32| facets[places[h as usize / 4] as usize].corners[h as usize % 4].1;
        for i in 0..self.facets.len() {
            for k in 0..4 {
                let h = 4 * self.facets[i].facet + k as u32;
                if self.facets[i].corners[k].0 == Role::Other {
                    self.facets[i].corners[k].1 = written(&self.facets, corners.writers[h as usize]);
                }
                if self.facets[i].sides[k].0 == Role::Other {
                    let twin = topology.twin(h).expect("another facet owns the edge");
                    let other = &self.facets[places[twin as usize / 4] as usize];
                    self.facets[i].sides[k].1 = other.sides[twin as usize % 4].1;
                }
            }
        }
        let mut sources = std::mem::take(&mut self.sources);
        for facet in &self.facets {
            for k in (0..4).filter(|&k| facet.corners[k].0 == Role::Copy) {
                let [position, normal] = corners.sources[&(4 * facet.facet + k as u32)];
                sources
                    .push(Source { position: written(&self.facets, position), normal: written(&self.facets, normal) });
            }
            for k in (0..4).filter(|&k| facet.sides[k].0 == Role::Copy) {
                let h = 4 * facet.facet + k as u32;
                let twin = topology.twin(h).expect("another facet owns the edge");
                let first = self.facets[places[twin as usize / 4] as usize].sides[twin as usize % 4].1;
                for i in (0..inside(facet.edges[k]) as u32).rev() {
                    let own = owned + sources.len() as u32;
                    let normal = if splits(h).crease { own } else { first + i };
                    sources.push(Source { position: first + i, normal });
                }
            }
        }
        self.sources = sources;
        self.blunt = corners.blunt.iter().map(|fan| (written(&self.facets, fan[0]), fan.clone())).collect();
    }
}

impl Facet {
    fn new(
        topology: &Topology,
        corners: &Corners,
        depths: &[Option<u32>],
        splits: &impl Fn(u32) -> Split,
        facet: u32,
        depth: u32,
    ) -> Self {
        let mut edges = [depth; 4];
        let mut sides = [(Role::Own, 0); 4];
        for k in 0..4 {
            let h = 4 * facet + k as u32;
            let across = topology.twin(h).and_then(|twin| Some((twin, depths[twin as usize / 4]?)));
            let Some((twin, other)) = across else { continue };
            edges[k] = depth.max(other);
            // The deeper facet has all vertices of the edge.
            let owns = if other == depth { h < twin } else { other < depth };
            sides[k].0 = match owns {
                true => Role::Own,
                false if splits(h).any() => Role::Copy,
                false => Role::Other,
            };
        }
        let corners = std::array::from_fn(|k| (corners.roles[4 * facet as usize + k], 0));
        Self {
            facet,
            depth,
            edges,
            corners,
            sides,
            inside: 0,
            first: 0,
            copies: 0,
            quads: 0,
            triangles: 0,
            holes: [].into(),
        }
    }

    /// Places what the facet writes. Gives the numbers of vertices that it owns, and of copies.
    fn place(&mut self) -> [u64; 2] {
        let [mut owned, mut copies] = [0u64; 2];
        let corners = self.corners;
        for (k, (role, vertex)) in self.corners.iter_mut().enumerate() {
            let (start, count) = match role {
                Role::Own => (self.first, &mut owned),
                Role::Copy => (self.copies, &mut copies),
                Role::Other => continue,
            };
            *vertex = start.wrapping_add(rank(corners, k));
            *count += 1;
        }
        for ((role, vertex), edge) in self.sides.iter_mut().zip(self.edges) {
            let (start, count) = match role {
                Role::Own => (self.first, &mut owned),
                Role::Copy => (self.copies, &mut copies),
                Role::Other => continue,
            };
            *vertex = start.wrapping_add(*count as u32);
            *count += inside(edge);
        }
        self.inside = self.first.wrapping_add(owned as u32);
        [owned + inside(self.depth) * inside(self.depth), copies]
    }

    /// Whether an edge has more segments than the facet.
    pub(super) fn is_finer(&self, k: usize) -> bool {
        self.edges[k] > self.depth
    }

    /// The edges whose vertices are written, but not by grids of the facet's own depth.
    pub(super) fn finer_copies(&self) -> impl Iterator<Item = usize> + '_ {
        (0..4).filter(|&k| self.sides[k].0 == Role::Copy && self.is_finer(k))
    }

    /// How often the sides of a cell of the grid are halved, from the one at its corner; `None` if it is a hole.
    pub(super) fn cell(&self, i: usize, j: usize) -> Option<[u32; 4]> {
        if self.holes.iter().any(|hole| hole.has([i as u32, j as u32], self.depth)) {
            return None;
        }
        let last = (1usize << self.depth) - 1;
        let on_edge = [j == 0, i == last, j == last, i == 0];
        Some(std::array::from_fn(|k| if on_edge[k] { self.edges[k] - self.depth } else { 0 }))
    }

    /// Numbers of quads and of triangles.
    pub(super) fn face_counts(&self) -> [u64; 2] {
        let segments = 1u64 << self.depth;
        if !self.holes.is_empty() {
            let cells = (0..segments * segments).map(|cell| [cell % segments, cell / segments].map(|i| i as usize));
            return cells.filter_map(|[i, j]| self.cell(i, j)).fold([0, 0], |[quads, triangles], halvings| {
                let points: u64 = halvings.iter().map(|&halvings| 1u64 << halvings).sum();
                if points == 4 { [quads + 1, triangles] } else { [quads, triangles + points - 2] }
            });
        }
        let finer: Vec<usize> = (0..4).filter(|&k| self.is_finer(k)).collect();
        let added: u64 = finer.iter().map(|&k| (1 << self.edges[k]) - segments).sum();
        let cells = match segments {
            1 => finer.len().min(1) as u64,
            _ => {
                let shared = (0..4).filter(|&k| self.is_finer(k) && self.is_finer((k + 1) % 4)).count();
                finer.len() as u64 * segments - shared as u64
            }
        };
        [segments * segments - cells, 2 * cells + added]
    }

    /// The vertex at a point of an edge, counted from corner k.
    pub(super) fn on_edge(&self, k: usize, point: u32) -> u32 {
        let last = 1 << self.edges[k];
        let (role, first) = self.sides[k];
        match point {
            0 => self.corners[k].1,
            _ if point == last => self.corners[(k + 1) % 4].1,
            _ if role == Role::Other => first + (last - 1 - point),
            _ => first + point - 1,
        }
    }
}
