//! How a plan is made: level by level, then without what nothing reads.

use super::caps::{self, Around, Caps, FRAME, Known};
use super::error::AdaptiveError;
use super::feature::Shape;
use super::grids::{fill, grid, is_boundary};
use super::level::{Cell, Fate, Level};
use super::options::AdaptiveOptions;
use super::plan::{LEAF, Leaf, LeafKind, Plan, RefinedCell, Root};
use crate::blend::{Blend, Row};
use crate::limit::Stencils;
use crate::patch::Scheme;
use crate::topology::{Topology, draws_face};
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

/// The bit of a vertex, while the plan is being made, that is a ghost's number.
const GHOST: u32 = 1 << 31;

impl Plan {
    /// Plans a mesh, whose end caps are patches of `scheme`: linear in its size and, for each level, in its features.
    ///
    /// # Errors
    /// [`AdaptiveError::TooDeep`], [`AdaptiveError::NoCaps`]; [`AdaptiveError::TooLarge`] and [`AdaptiveError::Level`] if the
    /// plan or a level of it cannot be addressed.
    pub fn new(topology: &Topology, scheme: Scheme, options: &AdaptiveOptions) -> Result<Self, AdaptiveError> {
        options.check()?;
        if !scheme.has_caps() {
            return Err(AdaptiveError::NoCaps { scheme });
        }
        let mut builder = Builder::new(topology, scheme, *options);
        let mut level = builder.control_level(topology);
        loop {
            let fates = level.fates(options);
            let children = builder.add_refined(&level, &fates);
            let next = match children.is_empty() {
                true => None,
                false => Some(builder.refine(&level, &fates, &children)?),
            };
            builder.add_leaves(&level, &fates)?;
            match next {
                None => return builder.finish(),
                Some(next) => level = next,
            }
        }
    }
}

/// A plan in the making, whose vertices are numbered as they come, those too that nothing will read.
struct Builder {
    options: AdaptiveOptions,
    control_vertices: u32,
    roots: Vec<Root>,
    face_roots: Vec<u32>,
    nodes: Vec<u32>,
    leaves: Vec<Leaf>,
    grids: Vec<u32>,
    refined: Vec<RefinedCell>,
    /// Refined vertices of all levels.
    rows: Stencils,
    /// Where those of each level start, from level 1.
    level_starts: Vec<u32>,
    /// The vertices of level 1 that are the points of faces of five and more corners, by face.
    centres: HashMap<u32, u32>,
    ghosts: Vec<Row>,
    /// The ghost beyond each vertex, mirroring another.
    ghost_numbers: HashMap<(u32, u32), u32>,
    /// The control points of end caps.
    cap_points: Stencils,
    caps: Caps,
    /// Points of frames that caps share.
    frames: Vec<Row>,
}

impl Builder {
    fn new(topology: &Topology, scheme: Scheme, options: AdaptiveOptions) -> Self {
        let mesh = topology.mesh();
        let (mut roots, mut face_roots) = (Vec::new(), vec![0]);
        for (face, drawn) in (0..).zip(draws_face(topology)) {
            match mesh.face(face).len() as u32 {
                _ if !drawn => {}
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
            rows: Stencils::default(),
            level_starts: Vec::new(),
            centres: HashMap::new(),
            ghosts: Vec::new(),
            ghost_numbers: HashMap::new(),
            cap_points: Stencils::default(),
            caps: Caps::new(scheme),
            frames: Vec::new(),
        }
    }

    /// The control mesh as level 0.
    fn control_level<'t>(&self, topology: &'t Topology) -> Level<'t> {
        let cell =
            |range: &[u32]| Cell { root: range[0], node: range[0], u: 0, v: 0, first: 0, own: range[0] < range[1] };
        let cells = self.face_roots.windows(2).map(cell).collect();
        Level { number: 0, topology: Cow::Borrowed(topology), first_vertex: 0, cells }
    }

    fn add_leaves(&mut self, level: &Level, fates: &[Fate]) -> Result<(), AdaptiveError> {
        let mut known = Known::default();
        for (face, fate) in (0..).zip(fates) {
            let Fate::Leaf(shape) = *fate else { continue };
            let cell = level.cells[face as usize];
            let half_edges = level.oriented(face);
            let bits = |is: &dyn Fn(u32) -> bool| (0..4).map(|k| u32::from(is(half_edges[k])) << k).sum::<u32>();
            let topology = &*level.topology;
            let boundary = bits(&|h| is_boundary(topology, h));
            let finer = |twin| matches!(fates[topology.face(twin) as usize], Fate::Refined(_));
            let kind = match shape {
                Shape::Regular => LeafKind::Regular,
                Shape::SingleCrease { half_edge, sharpness } => {
                    let edge = half_edges.iter().position(|&h| h == half_edge).unwrap_or(0) as u32;
                    LeafKind::SingleCrease { edge, sharpness }
                }
                Shape::Irregular => LeafKind::Cap,
            };
            let points = match kind {
                LeafKind::Cap => self.add_cap(level, half_edges, &mut known)?,
                _ => self.add_grid(level, half_edges, boundary),
            };
            let Root { face, part, .. } = self.roots[cell.root as usize];
            let (root, u, v) = (cell.root, cell.u, cell.v);
            let transition = bits(&|h| topology.twin(h).is_some_and(finer));
            self.nodes[cell.node as usize] = self.leaves.len() as u32 | LEAF;
            self.leaves.push(Leaf { root, face, part, level: level.number, u, v, kind, boundary, transition, points });
        }
        Ok(())
    }

    fn add_cap(&mut self, level: &Level, half_edges: [u32; 4], known: &mut Known) -> Result<u32, AdaptiveError> {
        let Self { caps, cap_points, frames, centres, .. } = self;
        let first = cap_points.len() as u32;
        let around = Around { topology: &level.topology, first_vertex: level.first_vertex, centres };
        let pushed = caps.push(&around, half_edges, known, frames, cap_points);
        pushed.map_err(|error| AdaptiveError::Level { level: level.number, error })?;
        Ok(first)
    }

    fn add_grid(&mut self, level: &Level, half_edges: [u32; 4], boundary: u32) -> u32 {
        let first = self.grids.len() as u32;
        let mut points = grid(&level.topology, half_edges).map(|vertex| vertex.map(|v| v + level.first_vertex));
        fill(&mut points, boundary, |on, inner| self.ghost(on, inner));
        self.grids.extend(points.map(|vertex| vertex.expect("a regular face has all its neighbours")));
        first
    }

    /// The vertex `2 on - inner`.
    fn ghost(&mut self, on: u32, inner: u32) -> u32 {
        let Self { ghosts, ghost_numbers, .. } = self;
        *ghost_numbers.entry((on, inner)).or_insert_with(|| {
            let row = |vertex: u32| match vertex & GHOST {
                0 => Row::unit(vertex),
                _ => ghosts[(vertex & !GHOST) as usize].clone(),
            };
            let ghost = Row::sum([(2.0, &row(on)), (-1.0, &row(inner))]);
            ghosts.push(ghost);
            (ghosts.len() - 1) as u32 | GHOST
        })
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
        let first_vertex = self.control_vertices + self.rows.len() as u32;
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
        self.level_starts.push(self.rows.len() as u32);
        self.rows = std::mem::take(&mut self.rows).chain(rows);
        self.check_vertices(self.rows.len())?;
        Ok(next)
    }

    fn check(&self, what: &'static str, count: usize, max: usize) -> Result<(), AdaptiveError> {
        let depth = self.options.depth.max(self.options.sharp_depth());
        if count > max { Err(AdaptiveError::TooLarge { depth, what, count, max }) } else { Ok(()) }
    }

    fn check_vertices(&self, rows: usize) -> Result<(), AdaptiveError> {
        self.check("vertices", self.control_vertices as usize + rows, FRAME as usize)
    }

    /// Which refined vertices are read, by leaves or by others that are.
    fn used(&self) -> Vec<bool> {
        let mut used = vec![false; self.rows.len()];
        let control = self.control_vertices;
        let mark = |used: &mut Vec<bool>, vertex: u32| {
            if vertex & (GHOST | FRAME) == 0 && vertex >= control {
                used[(vertex - control) as usize] = true;
            }
        };
        self.grids.iter().for_each(|&vertex| mark(&mut used, vertex));
        for row in self.ghosts.iter().chain(&self.frames) {
            row.weights().iter().for_each(|&(vertex, _)| mark(&mut used, vertex));
        }
        self.cap_points.indices.iter().for_each(|&vertex| mark(&mut used, vertex));
        for row in (0..self.rows.len()).rev() {
            if used[row] {
                self.rows.row(row).for_each(|(vertex, _)| mark(&mut used, vertex));
            }
        }
        used
    }

    fn finish(self) -> Result<Plan, AdaptiveError> {
        let used = self.used();
        let control = self.control_vertices;
        // The number of each vertex among those that are read.
        let mut next = control;
        let count = |&used: &bool| {
            next += u32::from(used);
            next - u32::from(used)
        };
        let numbers: Vec<u32> = used.iter().map(count).collect();
        let kept = next;
        let number = |vertex: u32| if vertex < control { vertex } else { numbers[(vertex - control) as usize] };
        let shared = self.ghosts.len() + self.frames.len();
        let all = kept as usize - control as usize + shared + self.cap_points.len();
        self.check_vertices(all)?;

        let of_shared = self.ghosts.iter().chain(&self.frames).map(|row| row.weights().len()).sum::<usize>();
        let terms = self.rows.indices.len() + of_shared + self.cap_points.indices.len();
        self.check("terms", terms, u32::MAX as usize)?;
        let mut rows = Stencils::with_capacity(all, terms);
        let ghosts = kept..kept + self.ghosts.len() as u32;
        let frames = ghosts.end..ghosts.end + self.frames.len() as u32;
        let in_sum = |vertex: u32| if vertex & FRAME == 0 { number(vertex) } else { frames.start + (vertex & !FRAME) };
        let renumber = |(vertex, weight)| (in_sum(vertex), weight);
        for row in (0..self.rows.len()).filter(|&row| used[row]) {
            rows.push(self.rows.row(row).map(renumber));
        }
        for row in self.ghosts.iter().chain(&self.frames) {
            rows.push(row.weights().iter().copied().map(renumber));
        }
        for row in 0..self.cap_points.len() {
            rows.push(self.cap_points.row(row).map(renumber));
        }
        let centres = control..control + used[..self.centres.len()].iter().filter(|used| **used).count() as u32;
        let start_of = |start: u32| numbers.get(start as usize).copied().unwrap_or(kept);
        let starts: Vec<u32> = self.level_starts.iter().map(|&s| start_of(s)).chain([kept]).collect();
        let cap_points: Range<u32> = frames.end..frames.end + self.cap_points.len() as u32;
        let in_grid = |vertex: u32| if vertex & GHOST == 0 { number(vertex) } else { ghosts.start + (vertex & !GHOST) };
        let place = |leaf: Leaf| match leaf.kind {
            LeafKind::Cap => Leaf { points: cap_points.start + leaf.points, ..leaf },
            _ => leaf,
        };
        debug_assert!(cap_points.len().is_multiple_of(caps::POINTS as usize));
        Ok(Plan {
            options: self.options,
            control_vertices: control,
            rows,
            levels: starts.windows(2).map(|pair| pair[0]..pair[1]).collect(),
            grids: self.grids.iter().map(|&vertex| in_grid(vertex)).collect(),
            leaves: self.leaves.into_iter().map(place).collect(),
            centres,
            ghosts,
            frames,
            cap_points,
            roots: self.roots,
            face_roots: self.face_roots,
            nodes: self.nodes,
            refined: self.refined,
        })
    }
}
