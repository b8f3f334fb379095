//! The vertices of a plan as sums.

use super::caps::POINTS;
use super::error::AdaptiveError;
use super::options::Sums;
use super::plan::Plan;
use crate::blend::Blend;
use crate::limit::{Masks, Stencils};
use rayon::prelude::*;
use std::ops::Range;

/// Rows for one thread at least.
const MIN_LEN: usize = 256;

/// Vertices as weighted sums that share their weights, which are the same wherever a mesh looks the same.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rows {
    /// The masks.
    pub masks: Vec<Mask>,
    /// The weights of all masks.
    pub weights: Vec<f64>,
    /// What makes vertices, in their order: one each, but for end caps, each of which makes 20.
    pub blocks: Vec<Block>,
    /// The vertices that blocks read.
    pub vertices: Vec<u32>,
}

/// The weights by which some vertices make others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mask {
    /// Where its weights start in [`Rows::weights`]: one of each input for the first output, then for the next.
    pub weights: u32,
    /// How many vertices it reads.
    pub inputs: u32,
    /// How many it makes.
    pub outputs: u32,
}

/// Some vertices and the mask that makes others of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Block {
    /// The mask, by its number in [`Rows::masks`].
    pub mask: u32,
    /// Where the block's vertices start in [`Rows::vertices`], as many as the mask has inputs.
    pub vertices: u32,
}

/// Where some blocks are written.
pub(super) struct BlocksMut<'r> {
    blocks: std::slice::IterMut<'r, Block>,
    vertices: &'r mut [u32],
    /// The number of the first vertex.
    first: u32,
    /// Vertices that are written.
    written: usize,
}

impl BlocksMut<'_> {
    /// Writes the next block.
    pub(super) fn push(&mut self, mask: u32, vertices: impl Iterator<Item = u32>) {
        if let Some(block) = self.blocks.next() {
            *block = Block { mask, vertices: self.first + self.written as u32 };
        }
        for vertex in vertices {
            self.vertices[self.written] = vertex;
            self.written += 1;
        }
    }
}

impl Rows {
    /// Adds the mask of some sums over `inputs` numbers.
    pub(super) fn add_mask<T: IntoIterator<Item = (u32, f64)>>(
        &mut self,
        inputs: usize,
        outputs: impl ExactSizeIterator<Item = T>,
    ) {
        let (start, count) = (self.weights.len(), outputs.len());
        self.weights.resize(start + inputs * count, 0.0);
        for (weights, terms) in self.weights[start..].chunks_mut(inputs.max(1)).zip(outputs) {
            terms.into_iter().for_each(|(number, weight)| weights[number as usize] = weight);
        }
        self.masks.push(Mask { weights: start as u32, inputs: inputs as u32, outputs: count as u32 });
    }

    /// With the blocks of some parts, one after the other, each written where it belongs. `size` counts the blocks of a part, and
    /// their vertices; `write` pushes as many.
    pub(super) fn with_blocks<P: Sync>(
        self,
        parts: &[P],
        size: impl Fn(&P) -> [usize; 2],
        write: impl Fn(&P, &mut BlocksMut) + Sync,
    ) -> Self {
        let [blocks, vertices] = parts.iter().map(&size).fold([0, 0], |[a, b], [blocks, read]| [a + blocks, b + read]);
        let mut all = Self { blocks: vec![Block::default(); blocks], vertices: vec![0; vertices], ..self };
        let (mut blocks, mut vertices) = (&mut all.blocks[..], &mut all.vertices[..]);
        let mut first = 0;
        let mut places = Vec::with_capacity(parts.len());
        for part in parts {
            let [count, read] = size(part);
            places.push(BlocksMut {
                blocks: blocks.split_off_mut(..count).unwrap_or_default().iter_mut(),
                vertices: vertices.split_off_mut(..read).unwrap_or_default(),
                first,
                written: 0,
            });
            first += read as u32;
        }
        places.into_par_iter().zip(parts).for_each(|(mut place, part)| write(part, &mut place));
        all
    }
}

impl Plan {
    /// Number of vertices: control vertices, refined vertices, ghost vertices, frames, control points of end caps.
    pub fn vertex_count(&self) -> usize {
        self.cap_points.end as usize
    }

    /// The ranges of vertices that can be made one after the other, each all at once: the points of faces other than
    /// quads, level 1, the other levels, ghosts with frames, end caps; with [`Sums::Composed`] all but end caps are one. Some may be
    /// empty.
    pub fn steps(&self) -> impl Iterator<Item = Range<u32>> + '_ {
        if self.options.sums == Sums::Composed {
            return vec![self.control_vertices..self.cap_points.start, self.cap_points.clone()].into_iter();
        }
        let levels = self.levels.iter().map(|level| level.start.max(self.centres.end)..level.end);
        let rest = [self.ghosts.start..self.frames.end, self.cap_points.clone()];
        std::iter::once(self.centres.clone()).chain(levels).chain(rest).collect::<Vec<_>>().into_iter()
    }

    /// Makes all rows sums of control vertices.
    ///
    /// # Errors
    /// [`AdaptiveError::TooLarge`].
    pub(super) fn compose(&mut self) -> Result<(), AdaptiveError> {
        let all = self.composed();
        let single = (self.cap_points.start - self.control_vertices) as usize;
        let (mut rows, mut masks) = (Rows::default(), Masks::default());
        let mut terms = Vec::new();
        for row in 0..single {
            // The greatest weights first: rows that look alike have one mask.
            terms.clear();
            terms.extend(all.row(row));
            terms.sort_by(|a, b| b.1.total_cmp(&a.1));
            let mask = masks.number(terms.iter().map(|&(_, weight)| weight));
            if mask as usize == rows.masks.len() {
                rows.add_mask(terms.len(), std::iter::once((0..).zip(terms.iter().map(|&(_, weight)| weight))));
            }
            rows.blocks.push(Block { mask, vertices: rows.vertices.len() as u32 });
            rows.vertices.extend(terms.iter().map(|&(vertex, _)| vertex));
        }
        for cap in (single..all.len()).step_by(POINTS as usize) {
            let outputs = cap..cap + POINTS as usize;
            let mut read: Vec<u32> = outputs.clone().flat_map(|row| all.row(row)).map(|(vertex, _)| vertex).collect();
            read.sort_unstable();
            read.dedup();
            let number = |(vertex, weight)| (read.partition_point(|&v| v < vertex) as u32, weight);
            rows.blocks.push(Block { mask: rows.masks.len() as u32, vertices: rows.vertices.len() as u32 });
            rows.add_mask(read.len(), outputs.map(|row| all.row(row).map(number)));
            rows.vertices.extend(read);
        }
        let depth = self.options.depth.max(self.options.sharp_depth());
        for (what, count) in [("vertices read by sums", rows.vertices.len()), ("weights of masks", rows.weights.len())]
        {
            if count > u32::MAX as usize {
                return Err(AdaptiveError::TooLarge { depth, what, count, max: u32::MAX as usize });
            }
        }
        self.rows = rows;
        Ok(())
    }

    /// All vertices, by number, where the control vertices are at `positions`.
    ///
    /// # Panics
    /// If there are not as many positions as control vertices.
    pub fn points<T: Blend + Send + Sync>(&self, positions: &[T]) -> Vec<T> {
        assert_eq!(positions.len(), self.control_vertices as usize, "one position a control vertex");
        let mut points = Vec::with_capacity(self.vertex_count());
        points.extend_from_slice(positions);
        for step in self.steps() {
            let point = |vertex: u32| T::sum(self.row(vertex).map(|(index, weight)| (weight, &points[index])));
            let made: Vec<_> = step.into_par_iter().with_min_len(MIN_LEN).map(point).collect();
            points.extend(made);
        }
        points
    }

    /// The rows over control vertices alone: output i is vertex `control_vertices + i`.
    pub fn composed(&self) -> Stencils {
        let control = self.control_vertices as usize;
        let mut composed = Stencils::default();
        let mut row = Sum::new(control);
        for vertex in self.control_vertices..self.vertex_count() as u32 {
            for (index, weight) in self.row(vertex) {
                if index < control {
                    row.add(index as u32, weight);
                    continue;
                }
                for term in term_range(&composed, index - control) {
                    row.add(composed.indices[term], weight * composed.weights[term]);
                }
            }
            row.move_to(&mut composed);
        }
        composed
    }

    /// The sum that makes a vertex after the control vertices: number and weight of each vertex in it.
    ///
    /// # Panics
    /// If there is no such vertex.
    pub fn row(&self, vertex: u32) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
        assert!(vertex >= self.control_vertices, "vertex {vertex} is one of the control mesh");
        let (row, single) = (vertex - self.control_vertices, self.cap_points.start - self.control_vertices);
        let (block, output) = match row.checked_sub(single) {
            None => (row, 0),
            Some(point) => (single + point / POINTS, point % POINTS),
        };
        let Rows { masks, weights, blocks, vertices } = &self.rows;
        let block = blocks[block as usize];
        let Mask { weights: start, inputs, .. } = masks[block.mask as usize];
        let weights = &weights[(start + output * inputs) as usize..][..inputs as usize];
        let terms =
            vertices[block.vertices as usize..].iter().map(|&vertex| vertex as usize).zip(weights.iter().copied());
        terms.filter(|&(_, weight)| weight != 0.0)
    }
}

fn term_range(rows: &Stencils, row: usize) -> Range<usize> {
    rows.offsets[row] as usize..rows.offsets[row + 1] as usize
}

/// A sum of numbered unknowns, of which there are so few that each has a place.
struct Sum {
    weights: Vec<f64>,
    is_term: Vec<bool>,
    terms: Vec<u32>,
}

impl Sum {
    fn new(unknowns: usize) -> Self {
        Self { weights: vec![0.0; unknowns], is_term: vec![false; unknowns], terms: Vec::new() }
    }

    fn add(&mut self, index: u32, weight: f64) {
        if !std::mem::replace(&mut self.is_term[index as usize], true) {
            self.terms.push(index);
        }
        self.weights[index as usize] += weight;
    }

    /// Appends the sum as a row, and starts anew.
    fn move_to(&mut self, rows: &mut Stencils) {
        self.terms.sort_unstable();
        for index in self.terms.drain(..) {
            self.is_term[index as usize] = false;
            rows.indices.push(index);
            rows.weights.push(std::mem::take(&mut self.weights[index as usize]));
        }
        rows.offsets.push(rows.indices.len() as u32);
    }
}
