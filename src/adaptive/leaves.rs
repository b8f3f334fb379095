//! The leaves of a level.

use super::build::{Builder, GHOST};
use super::caps::{Around, POINTS};
use super::error::AdaptiveError;
use super::feature::{Class, Shape};
use super::grids::{NONE, fill, grid, is_boundary};
use super::level::{Fate, Level, MIN_LEN};
use super::plan::{LEAF, Leaf, LeafKind, Root};
use crate::blend::{Blend, Row};
use rayon::prelude::*;

/// A leaf in the making.
struct Place {
    face: u32,
    shape: Shape,
    /// As [`Leaf::points`]; of caps, among those of caps.
    points: u32,
}

impl Builder {
    pub(super) fn add_leaves(&mut self, level: &Level, classes: &[Class], fates: &[Fate]) -> Result<(), AdaptiveError> {
        let (first, first_grid) = (self.leaves.len(), self.grids.len());
        let (mut places, mut grids, mut caps) = (Vec::new(), Vec::new(), Vec::new());
        for (face, fate) in (0..).zip(fates) {
            let Fate::Leaf(shape) = *fate else { continue };
            let half_edges = level.oriented(face);
            let points = if shape == Shape::Irregular {
                let is_finite = |&h: &u32| classes[level.topology.vertex(h) as usize].is_finite();
                self.rounded_caps += u32::from(half_edges.iter().any(is_finite));
                caps.push(half_edges);
                POINTS * (self.caps.len() + caps.len() - 1) as u32
            } else {
                grids.push(half_edges);
                (first_grid + 16 * (grids.len() - 1)) as u32
            };
            self.nodes[level.cells[face as usize].node as usize] = (first + places.len()) as u32 | LEAF;
            places.push(Place { face, shape, points });
        }
        let roots = &self.roots;
        let leaves = places.par_iter().with_min_len(MIN_LEN).map(|place| leaf(roots, level, fates, place));
        self.leaves.par_extend(leaves);
        self.add_grids(level, first, &grids);
        let topology = &*level.topology;
        let around = Around { topology, first_vertex: level.first_vertex, classes, centres: &self.centres };
        let added = self.caps.add(&around, &caps, &mut self.frames);
        added.map_err(|error| AdaptiveError::Level { level: level.number, error })
    }

    /// Adds the grids of leaves from the first on that are no caps.
    fn add_grids(&mut self, level: &Level, first_leaf: usize, half_edges: &[[u32; 4]]) {
        let start = self.grids.len();
        self.grids.resize(start + 16 * half_edges.len(), NONE);
        let grids = self.grids[start..].par_chunks_exact_mut(16).zip(half_edges).with_min_len(MIN_LEN);
        grids.for_each(|(points, &half_edges)| {
            for (point, vertex) in points.iter_mut().zip(grid(&level.topology, half_edges)) {
                *point = if vertex == NONE { NONE } else { level.first_vertex + vertex };
            }
        });
        for leaf in first_leaf..self.leaves.len() {
            let Leaf { kind, boundary, points, .. } = self.leaves[leaf];
            if kind != LeafKind::Cap && boundary != 0 {
                let range = points as usize..points as usize + 16;
                let mut points: [u32; 16] = std::array::from_fn(|i| self.grids[range.start + i]);
                fill(&mut points, boundary, |on, inner| self.ghost(on, inner));
                self.grids[range].copy_from_slice(&points);
            }
        }
        debug_assert!(!self.grids[start..].contains(&NONE), "a regular face has all its neighbours");
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
}

fn leaf(roots: &[Root], level: &Level, fates: &[Fate], place: &Place) -> Leaf {
    let topology = &*level.topology;
    let cell = level.cells[place.face as usize];
    let half_edges = level.oriented(place.face);
    let bits = |is: &dyn Fn(u32) -> bool| (0..4).map(|k| u32::from(is(half_edges[k])) << k).sum::<u32>();
    let finer = |twin| matches!(fates[topology.face(twin) as usize], Fate::Refined(_));
    let kind = match place.shape {
        Shape::Regular => LeafKind::Regular,
        Shape::SingleCrease { half_edge, sharpness } => {
            let edge = half_edges.iter().position(|&h| h == half_edge).unwrap_or(0) as u32;
            LeafKind::SingleCrease { edge, sharpness }
        }
        Shape::Irregular => LeafKind::Cap,
    };
    let Root { face, part, .. } = roots[cell.root as usize];
    Leaf {
        root: cell.root,
        face,
        part,
        level: level.number,
        u: cell.u,
        v: cell.v,
        kind,
        boundary: bits(&|h| is_boundary(topology, h)),
        transition: bits(&|h| topology.twin(h).is_some_and(finer)),
        points: place.points,
    }
}
