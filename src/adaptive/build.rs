//! How a plan is made, level by level.

use super::caps::{Caps, FRAME};
use super::error::AdaptiveError;
use super::level::{Cell, Fate, Level};
use super::options::AdaptiveOptions;
use super::plan::{Leaf, Plan, RefinedCell, Root};
use crate::blend::Row;
use crate::limit::MaskedRows;
use crate::patch::Scheme;
use crate::topology::{Topology, draws_face};
use rustc_hash::FxBuildHasher;
use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};

/// The bit of a vertex, while the plan is being made, that is a ghost's number.
pub(super) const GHOST: u32 = 1 << 31;

impl Plan {
    /// Plans a mesh, whose end caps are patches of `scheme`: linear in its size and, for each level, in its features.
    ///
    /// # Errors
    /// [`AdaptiveError::TooDeep`], [`AdaptiveError::NoCaps`]; [`AdaptiveError::TooLarge`] and [`AdaptiveError::Level`] if the
    /// plan or a level of it cannot be addressed.
    pub fn new(topology: &Topology, scheme: Scheme, options: &AdaptiveOptions) -> Result<Self, AdaptiveError> {
        Self::of_faces(topology, scheme, options, draws_face(topology))
    }

    /// Plans faces of five and more corners and those that touch them, at depth 1, where all are quads. Others have no roots.
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub(crate) fn around_polygons(topology: &Topology, scheme: Scheme) -> Result<Self, AdaptiveError> {
        let mut touches = vec![false; topology.vertex_count()];
        let half_edges = |face: usize| topology.mesh().face_corners(face as u32).map(|h| h as u32);
        let draws = draws_face(topology);
        for face in (0..draws.len()).filter(|&face| half_edges(face).len() > 4) {
            half_edges(face).for_each(|h| touches[topology.vertex(h) as usize] = true);
        }
        let is_near = |face| half_edges(face).any(|h| touches[topology.vertex(h) as usize]);
        let faces = draws.into_iter().enumerate().map(|(face, draws)| draws && is_near(face)).collect();
        Self::of_faces(topology, scheme, &AdaptiveOptions { depth: 1, ..AdaptiveOptions::default() }, faces)
    }

    /// Plans the faces for which `own` holds.
    fn of_faces(
        topology: &Topology,
        scheme: Scheme,
        options: &AdaptiveOptions,
        own: Vec<bool>,
    ) -> Result<Self, AdaptiveError> {
        options.check()?;
        if !scheme.has_caps() {
            return Err(AdaptiveError::NoCaps { scheme });
        }
        let mut builder = Builder::new(topology, scheme, *options, own);
        let mut level = builder.control_level(topology);
        loop {
            let (classes, fates) = level.fates(options);
            let children = builder.add_refined(&level, &fates);
            let next = match children.is_empty() {
                true => None,
                false => Some(builder.refine(&level, &fates, &children)?),
            };
            builder.add_leaves(&level, &classes, &fates)?;
            match next {
                None => return builder.finish(),
                Some(next) => level = next,
            }
        }
    }
}

/// Some refined vertices of a level.
pub(super) struct Piece {
    /// How many there are before.
    pub first: usize,
    pub rows: MaskedRows,
}

/// A plan in the making, whose vertices are numbered as they come, those too that nothing will read.
pub(super) struct Builder {
    pub(super) options: AdaptiveOptions,
    pub(super) control_vertices: u32,
    pub(super) roots: Vec<Root>,
    pub(super) face_roots: Vec<u32>,
    pub(super) nodes: Vec<u32>,
    pub(super) leaves: Vec<Leaf>,
    pub(super) grids: Vec<u32>,
    pub(super) refined: Vec<RefinedCell>,
    /// The refined vertices of each level from 1, in pieces.
    pub(super) levels: Vec<Vec<Piece>>,
    /// The refined vertices of all levels.
    pub(super) row_count: usize,
    /// The vertices of level 1 that are the points of faces other than quads, by face.
    pub(super) centres: BTreeMap<u32, u32>,
    pub(super) ghosts: Vec<Row>,
    /// The ghost beyond each vertex, mirroring another.
    pub(super) ghost_numbers: HashMap<(u32, u32), u32, FxBuildHasher>,
    pub(super) caps: Caps,
    /// Points of frames that caps share.
    pub(super) frames: Vec<Row>,
    pub(super) rounded_caps: u32,
}

impl Builder {
    fn new(topology: &Topology, scheme: Scheme, options: AdaptiveOptions, own: Vec<bool>) -> Self {
        let mesh = topology.mesh();
        let (mut roots, mut face_roots) = (Vec::new(), vec![0]);
        for (face, own) in (0..).zip(own) {
            match mesh.face(face).len() as u32 {
                _ if !own => {}
                4 => roots.push(Root { face, part: 0, level: 0 }),
                size => roots.extend((0..size).map(|part| Root { face, part, level: 1 })),
            }
            face_roots.push(roots.len() as u32);
        }
        Self {
            options,
            control_vertices: mesh.vertex_count() as u32,
            nodes: vec![0; roots.len()],
            roots,
            face_roots,
            leaves: Vec::new(),
            grids: Vec::new(),
            refined: Vec::new(),
            levels: Vec::new(),
            row_count: 0,
            centres: BTreeMap::new(),
            ghosts: Vec::new(),
            ghost_numbers: HashMap::default(),
            caps: Caps::new(scheme),
            frames: Vec::new(),
            rounded_caps: 0,
        }
    }

    /// The control mesh as level 0.
    fn control_level<'t>(&self, topology: &'t Topology) -> Level<'t> {
        let cell =
            |range: &[u32]| Cell { root: range[0], node: range[0], u: 0, v: 0, first: 0, own: range[0] < range[1] };
        let cells = self.face_roots.windows(2).map(cell).collect();
        Level { number: 0, topology: Cow::Borrowed(topology), first_vertex: 0, cells }
    }

    /// Notes what is refined, and makes four nodes for each quad. Gives the first of them, by refined face.
    fn add_refined(&mut self, level: &Level, fates: &[Fate]) -> Vec<(u32, u32)> {
        let mut children = Vec::new();
        for (face, fate) in (0..).zip(fates) {
            let Fate::Refined(reason) = *fate else { continue };
            let cell = level.cells[face as usize];
            let Root { face: of, part, level: of_root } = self.roots[cell.root as usize];
            self.refined.push(RefinedCell { face: of, part, level: level.number, u: cell.u, v: cell.v, reason });
            // The parts of a face that is no quad are roots already.
            if of_root > level.number {
                children.push((face, cell.root));
                continue;
            }
            let first = self.nodes.len() as u32;
            self.nodes[cell.node as usize] = first;
            self.nodes.extend([0; 4]);
            children.push((face, first));
        }
        children
    }

    fn refine(
        &mut self,
        level: &Level,
        fates: &[Fate],
        children: &[(u32, u32)],
    ) -> Result<Level<'static>, AdaptiveError> {
        let mut first_nodes = vec![0; fates.len()];
        children.iter().for_each(|&(face, first)| first_nodes[face as usize] = first);
        let first_vertex = self.control_vertices + self.row_count as u32;
        let child = |face: u32, corner: u32| {
            let (cell, first) = (level.cells[face as usize], first_nodes[face as usize]);
            if level.number == 0 && level.topology.mesh().face(face).len() != 4 {
                return Cell { root: first + corner, node: first + corner, ..cell };
            }
            let quadrant = (cell.first + corner) % 4;
            let [u, v] = [[0, 0], [1, 0], [1, 1], [0, 1]][quadrant as usize];
            Cell { node: first + u + 2 * v, u: 2 * cell.u + u, v: 2 * cell.v + v, first: quadrant, ..cell }
        };
        let number = level.number + 1;
        let refined = level.refine(fates, first_vertex, child);
        let (next, rows, centres) = refined.map_err(|error| AdaptiveError::Level { level: number, error })?;
        // After one step all faces are quads.
        self.centres.extend(centres.into_iter().zip(first_vertex..));
        let mut pieces = Vec::with_capacity(rows.len());
        for rows in rows {
            let first = self.row_count;
            self.row_count += rows.len();
            pieces.push(Piece { first, rows });
        }
        self.levels.push(pieces);
        self.check_vertices(self.row_count)?;
        Ok(next)
    }

    pub(super) fn check(&self, what: &'static str, count: usize, max: usize) -> Result<(), AdaptiveError> {
        let depth = self.options.depth.max(self.options.sharp_depth());
        if count > max { Err(AdaptiveError::TooLarge { depth, what, count, max }) } else { Ok(()) }
    }

    pub(super) fn check_vertices(&self, rows: usize) -> Result<(), AdaptiveError> {
        self.check("vertices", self.control_vertices as usize + rows, FRAME as usize)
    }
}
