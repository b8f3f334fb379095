//! Facets that edits reach at finer levels: their parts are faces of the mesh at these levels, of which no more is refined than is
//! around edits.

use crate::limit::{Local, Stencils, VertexEdits, refine, with_rings};
use crate::mesh::{ControlMesh, CreaseMethod, MeshData, MeshError};
use crate::topology::Topology;
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

/// The quarters of a facet, and its corners.
pub(super) const PLACES: [[u32; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];

/// A face of a mesh of quads, and the corner of it that is at the beginning of u and v.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Turned {
    pub face: u32,
    pub first: u32,
}

impl Turned {
    /// The half-edge from a corner, counted from the first.
    pub(super) fn half_edge(self, k: u32) -> u32 {
        4 * self.face + (self.first + k) % 4
    }

    /// The child at a corner, where face `self.face` has the number `face` in what is refined.
    fn child(self, face: u32, k: u32) -> Self {
        Self { face: 4 * face + (self.first + k) % 4, first: (4 - k) % 4 }
    }
}

/// A part of a facet.
#[derive(Debug, Clone, Copy)]
pub(super) enum Cell {
    /// Four quarters.
    Node(u32),
    /// One of a level's faces that are not refined, by its index.
    Face { level: u32, index: u32 },
}

/// A part of the mesh, one level finer than the one before.
pub(super) struct Level {
    /// The vertices of the level before of which this one is refined.
    sources: Vec<u32>,
    stencils: Stencils,
    edits: VertexEdits,
    pub topology: Topology,
    /// The parts of facets.
    pub faces: Vec<Turned>,
}

/// A part of a facet that is a hole: at `at` among as many parts as the facet has when it is halved so often.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Hole {
    pub halvings: u32,
    pub at: [u32; 2],
}

/// Facets in levels.
#[derive(Default)]
pub(super) struct Finer {
    /// The first is one level finer than facets are.
    pub levels: Vec<Level>,
    nodes: Vec<[Cell; 4]>,
    /// By facet.
    of_facets: FxHashMap<u32, u32>,
    holes: FxHashMap<u32, Vec<Hole>>,
}

/// A part of a facet, a face of the level that is looked at.
struct Part {
    face: Turned,
    facet: u32,
    at: [u32; 2],
    /// Where to remember what becomes of it.
    slot: (u32, u32),
}

impl Finer {
    /// Of the facets of a mesh that are drawn, which are its faces.
    pub(super) fn new(facets: &Topology, drawn: &[bool]) -> Result<Self, MeshError> {
        let mut finer = Self::default();
        if facets.mesh().edit_level() == 0 {
            return Ok(finer);
        }
        let (mut level, mut faces) = Level::around_edits(facets)?;
        let mut parts = Vec::new();
        let drawn_faces = faces.iter().filter(|(facet, _)| drawn[**facet as usize]);
        let mut drawn_faces: Vec<(u32, u32)> = drawn_faces.map(|(&facet, &face)| (facet, face)).collect();
        drawn_faces.sort_unstable();
        for (facet, face) in drawn_faces {
            let node = finer.divide(Turned { face: facet, first: 0 }, face, facet, [0, 0], &mut parts);
            finer.of_facets.insert(facet, node);
        }
        loop {
            finer.find_holes(&level.topology, &parts);
            let next = match level.topology.mesh().edit_level() {
                0 => None,
                _ => Some(Level::around_edits(&level.topology)?),
            };
            let number = finer.levels.len() as u32;
            faces = next.as_ref().map_or_else(FxHashMap::default, |next| next.1.clone());
            for Part { face, facet, at, slot } in std::mem::take(&mut parts) {
                let cell = match faces.get(&face.face) {
                    Some(&number) => Cell::Node(finer.divide(face, number, facet, at, &mut parts)),
                    None => {
                        level.faces.push(face);
                        Cell::Face { level: number, index: level.faces.len() as u32 - 1 }
                    }
                };
                finer.nodes[slot.0 as usize][slot.1 as usize] = cell;
            }
            finer.levels.push(level);
            match next {
                Some(next) => level = next.0,
                None => return Ok(finer),
            }
        }
    }

    /// Makes a node of a part, which has the number `number` in what is refined.
    fn divide(&mut self, face: Turned, number: u32, facet: u32, at: [u32; 2], parts: &mut Vec<Part>) -> u32 {
        let node = self.nodes.len() as u32;
        self.nodes.push([Cell::Node(node); 4]);
        parts.extend((0..4).map(|k| {
            let [i, j] = PLACES[k as usize];
            Part { face: face.child(number, k), facet, at: [2 * at[0] + i, 2 * at[1] + j], slot: (node, k) }
        }));
        node
    }

    fn find_holes(&mut self, topology: &Topology, parts: &[Part]) {
        let holes: FxHashSet<u32> = topology.mesh().data().holes.iter().copied().collect();
        let halvings = self.levels.len() as u32 + 1;
        for part in parts.iter().filter(|part| holes.contains(&part.face.face)) {
            let of_facet = self.holes.entry(part.facet).or_default();
            if !of_facet.iter().any(|hole| hole.has(part.at, halvings)) {
                of_facet.push(Hole { halvings, at: part.at });
            }
        }
    }

    /// The node of a facet.
    pub(super) fn node(&self, facet: u32) -> Option<u32> {
        self.of_facets.get(&facet).copied()
    }

    /// The quarters of a node.
    pub(super) fn quarters(&self, node: u32) -> [Cell; 4] {
        self.nodes[node as usize]
    }

    /// The holes of a facet.
    pub(super) fn holes(&self, facet: u32) -> &[Hole] {
        self.holes.get(&facet).map_or(&[], Vec::as_slice)
    }

    /// Calls `visit` for each face of a part that is halved `depth` times: with its level, its index and how often it is halved itself.
    /// Where the part is not halved to a face, one corner of the face is left.
    pub(super) fn for_each_face(&self, cell: Cell, depth: u32, visit: &mut impl FnMut(u32, u32, u32)) {
        match cell {
            Cell::Node(node) => self.quarters(node).into_iter().for_each(|quarter| {
                self.for_each_face(quarter, depth.saturating_sub(1), visit);
            }),
            Cell::Face { level, index } => visit(level, index, depth),
        }
    }

    /// The vertices of all levels, where those of the facets are these.
    pub(super) fn vertices(&self, facets: &[DVec3]) -> Vec<Vec<DVec3>> {
        let mut all: Vec<Vec<DVec3>> = Vec::with_capacity(self.levels.len());
        for level in &self.levels {
            let coarse = all.last().map_or(facets, Vec::as_slice);
            let sources: Vec<DVec3> = level.sources.iter().map(|&vertex| coarse[vertex as usize]).collect();
            let mut vertices = level.stencils.apply(&sources);
            level.edits.apply(&mut vertices);
            all.push(vertices);
        }
        all
    }
}

impl Hole {
    /// Whether a part of the facet, of those at so many halvings, lies in the hole.
    pub(super) fn has(&self, at: [u32; 2], halvings: u32) -> bool {
        halvings >= self.halvings && at.map(|i| i >> (halvings - self.halvings)) == self.at
    }
}

impl Level {
    /// Refines what edits of a mesh reach. Gives the number in what was refined of each such face.
    fn around_edits(topology: &Topology) -> Result<(Self, FxHashMap<u32, u32>), MeshError> {
        // An edit reaches as far as a vertex of the refined mesh does. Around that are the faces that have a say.
        let reach = 1;
        let rim = match topology.mesh().data().crease_method {
            CreaseMethod::Uniform => 1,
            // Whether an edge is sharp depends on the creases at its far end.
            CreaseMethod::Chaikin => 2,
        };
        let mut edited: Vec<u32> = topology.mesh().data().edits.iter().map(|edit| edit.face).collect();
        edited.sort_unstable();
        edited.dedup();
        let reached = with_rings(topology, edited, reach);
        let count = reached.len();
        let part = with_rings(topology, reached, rim);
        let numbers: FxHashMap<u32, u32> = part.iter().copied().zip(0..).collect();
        let Local { data, vertices, .. } = Local::of_faces(topology, &part, DVec3::ZERO);
        let mut edits = topology.mesh().data().edits.clone();
        edits.iter_mut().for_each(|edit| edit.face = numbers[&edit.face]);
        let refined = refine(&Topology::new(&ControlMesh::new(MeshData { edits, ..data })?))?;
        let level = Self {
            sources: vertices,
            stencils: refined.stencils,
            edits: refined.edits,
            topology: Topology::new(&refined.mesh),
            faces: Vec::new(),
        };
        Ok((level, numbers.into_iter().filter(|(_, number)| (*number as usize) < count).collect()))
    }
}
