//! The vertices of a plan as sums.

use super::plan::Plan;
use crate::blend::Blend;
use crate::limit::Stencils;
use rayon::prelude::*;
use std::ops::Range;

/// Rows for one thread at least.
const MIN_LEN: usize = 256;

impl Plan {
    /// Number of vertices: control vertices, refined vertices, ghost vertices, frames, control points of end caps.
    pub fn vertex_count(&self) -> usize {
        self.control_vertices as usize + self.rows.len()
    }

    /// The ranges of vertices that can be made one after the other, each all at once: the points of faces other than
    /// quads, level 1, the other levels, ghosts with frames, end caps. Some may be empty.
    pub fn steps(&self) -> impl Iterator<Item = Range<u32>> + '_ {
        let levels = self.levels.iter().map(|level| level.start.max(self.centres.end)..level.end);
        let rest = [self.ghosts.start..self.frames.end, self.cap_points.clone()];
        std::iter::once(self.centres.clone()).chain(levels).chain(rest)
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
            let point = |vertex: u32| T::sum(self.terms(vertex).map(|(index, weight)| (weight, &points[index])));
            let made: Vec<_> = step.into_par_iter().with_min_len(MIN_LEN).map(point).collect();
            points.extend(made);
        }
        points
    }

    /// The rows over control vertices alone: output i is vertex `control_vertices + i`.
    pub fn composed(&self) -> Stencils {
        let control = self.control_vertices as usize;
        let mut composed = Stencils { offsets: vec![0], indices: Vec::new(), weights: Vec::new() };
        let mut row = Sum::new(control);
        for vertex in self.control_vertices..self.vertex_count() as u32 {
            for (index, weight) in self.terms(vertex) {
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

    /// Vertex and weight of each term of a vertex's row.
    fn terms(&self, vertex: u32) -> impl Iterator<Item = (usize, f64)> + '_ {
        let terms = term_range(&self.rows, (vertex - self.control_vertices) as usize);
        self.rows.indices[terms.clone()].iter().zip(&self.rows.weights[terms]).map(|(&i, &w)| (i as usize, w))
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
