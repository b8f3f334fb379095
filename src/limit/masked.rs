//! Weighted sums that share their weights.

use crate::blend::Row;
use rustc_hash::FxBuildHasher;
use std::collections::HashMap;
use std::ops::Range;

/// Lists of weights, each of which is there once.
pub(crate) struct Masks {
    /// Where each list starts, and after the last list their number.
    starts: Vec<u32>,
    weights: Vec<f64>,
    /// The lists by the bits of their weights.
    numbers: HashMap<Vec<u64>, u32, FxBuildHasher>,
    bits: Vec<u64>,
}

impl Default for Masks {
    fn default() -> Self {
        Self { starts: vec![0], weights: Vec::new(), numbers: HashMap::default(), bits: Vec::new() }
    }
}

impl Masks {
    /// The number of a list, which is added if there is none like it.
    pub(crate) fn number(&mut self, weights: impl IntoIterator<Item = f64>) -> u32 {
        self.bits.clear();
        self.bits.extend(weights.into_iter().map(f64::to_bits));
        if let Some(&number) = self.numbers.get(&self.bits) {
            return number;
        }
        let number = self.len() as u32;
        self.weights.extend(self.bits.iter().copied().map(f64::from_bits));
        self.starts.push(self.weights.len() as u32);
        self.numbers.insert(self.bits.clone(), number);
        number
    }

    pub(crate) fn weights(&self, number: u32) -> &[f64] {
        let [start, end] = [0, 1].map(|i| self.starts[number as usize + i] as usize);
        &self.weights[start..end]
    }

    /// Number of lists.
    pub(crate) fn len(&self) -> usize {
        self.starts.len() - 1
    }
}

/// Weighted sums, as [`Stencils`](super::Stencils) are, whose weights are in [`Masks`].
#[derive(Default)]
pub(crate) struct MaskedRows {
    /// Where the terms of each row end.
    ends: Vec<u32>,
    pub(crate) indices: Vec<u32>,
    /// The mask of each row.
    masks: Vec<u32>,
    pub(crate) weights: Masks,
}

impl MaskedRows {
    /// Appends the sum of some vertices with a mask.
    pub(crate) fn push(&mut self, vertices: impl IntoIterator<Item = u32>, mask: u32) {
        self.indices.extend(vertices);
        self.ends.push(self.indices.len() as u32);
        self.masks.push(mask);
    }

    /// Appends a sum, the greatest weights first: so those of places that look alike have the same mask, whatever the numbers of
    /// their vertices.
    pub(crate) fn push_row(&mut self, row: &Row) {
        let mut terms = row.weights().to_vec();
        terms.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mask = self.weights.number(terms.iter().map(|&(_, weight)| weight));
        self.push(terms.into_iter().map(|(vertex, _)| vertex), mask);
    }

    /// Number of rows.
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    /// Number of terms of some rows.
    pub(crate) fn term_count(&self, rows: Range<usize>) -> usize {
        self.start(rows.end) - self.start(rows.start)
    }

    /// The mask of a row, and the vertices of its terms.
    pub(crate) fn masked(&self, row: usize) -> (u32, &[u32]) {
        (self.masks[row], &self.indices[self.start(row)..self.start(row + 1)])
    }

    /// Vertex and weight of each term of a row.
    pub(crate) fn row(&self, row: usize) -> impl Iterator<Item = (u32, f64)> + Clone + '_ {
        let (mask, vertices) = self.masked(row);
        vertices.iter().copied().zip(self.weights.weights(mask).iter().copied())
    }

    fn start(&self, row: usize) -> usize {
        row.checked_sub(1).map_or(0, |before| self.ends[before] as usize)
    }
}
