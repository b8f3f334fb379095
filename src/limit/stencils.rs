//! Weighted sums of one step of refinement.

use crate::blend::{Blend, Row};
use rayon::prelude::*;
use std::ops::Range;

/// Rows for one thread at least: handing out fewer takes longer than making them.
pub(super) const MIN_LEN: usize = 256;

/// Weighted sums: output `i` is the sum of `weights[k] * input[indices[k]]` for k in `offsets[i]..offsets[i + 1]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Stencils {
    /// Where the terms of each output start, and after the last output their number.
    pub offsets: Vec<u32>,
    /// The input of each term.
    pub indices: Vec<u32>,
    /// The weight of each term. Those of one output add up to 1.
    pub weights: Vec<f64>,
}

/// Where outputs are written.
pub(crate) struct RowsMut<'s> {
    /// Where the terms of each output end, of those that are left.
    ends: std::slice::IterMut<'s, u32>,
    indices: &'s mut [u32],
    weights: &'s mut [f64],
    /// The number of the first term.
    first: u32,
    /// Terms that are written.
    terms: usize,
}

impl RowsMut<'_> {
    /// Writes the next outputs, some of others, with `number(i)` in the place of input i.
    pub(crate) fn push(&mut self, from: &Stencils, outputs: Range<usize>, number: impl Fn(u32) -> u32) {
        let (first, last) = (from.offsets[outputs.start], from.offsets[outputs.end]);
        let source = first as usize..last as usize;
        let place = self.terms..self.terms + source.len();
        self.weights[place.clone()].copy_from_slice(&from.weights[source.clone()]);
        for (to, &index) in self.indices[place.clone()].iter_mut().zip(&from.indices[source]) {
            *to = number(index);
        }
        let before = self.first + self.terms as u32;
        // In this order, for the one that ends first takes nothing of the other.
        for (&offset, end) in from.offsets[outputs.start + 1..=outputs.end].iter().zip(&mut self.ends) {
            *end = before + (offset - first);
        }
        self.terms = place.end;
    }
}

impl Default for Stencils {
    fn default() -> Self {
        Self::with_capacity(0, 0)
    }
}

impl Stencils {
    pub(crate) fn new(rows: Vec<Row>) -> Self {
        let mut stencils = Self::default();
        for row in rows {
            stencils.push(row.weights().iter().copied());
        }
        stencils
    }

    pub(crate) fn with_capacity(rows: usize, terms: usize) -> Self {
        let mut offsets = Vec::with_capacity(rows + 1);
        offsets.push(0);
        Self { offsets, indices: Vec::with_capacity(terms), weights: Vec::with_capacity(terms) }
    }

    /// The outputs of some parts, one after the other, each written where it belongs. `size` counts the outputs of a part, and
    /// their terms; `write` pushes as many.
    pub(crate) fn join<P: Sync>(
        parts: &[P],
        size: impl Fn(&P) -> [usize; 2],
        write: impl Fn(&P, &mut RowsMut) + Sync,
    ) -> Self {
        let [rows, terms] = parts.iter().map(&size).fold([0, 0], |[a, b], [rows, terms]| [a + rows, b + terms]);
        let mut all = Self { offsets: vec![0; rows + 1], indices: vec![0; terms], weights: vec![0.0; terms] };
        let (mut ends, mut indices, mut weights) = (&mut all.offsets[1..], &mut all.indices[..], &mut all.weights[..]);
        let mut term = 0;
        let mut places = Vec::with_capacity(parts.len());
        for part in parts {
            let [rows, terms] = size(part);
            places.push(RowsMut {
                ends: ends.split_off_mut(..rows).unwrap_or_default().iter_mut(),
                indices: indices.split_off_mut(..terms).unwrap_or_default(),
                weights: weights.split_off_mut(..terms).unwrap_or_default(),
                first: term as u32,
                terms: 0,
            });
            term += terms;
        }
        places.into_par_iter().zip(parts).for_each(|(mut place, part)| write(part, &mut place));
        all
    }

    /// Appends an output.
    pub(crate) fn push(&mut self, terms: impl IntoIterator<Item = (u32, f64)>) {
        for (index, weight) in terms {
            self.indices.push(index);
            self.weights.push(weight);
        }
        self.offsets.push(self.indices.len() as u32);
    }

    /// Input and weight of each term of an output.
    pub(crate) fn row(&self, output: usize) -> impl ExactSizeIterator<Item = (u32, f64)> + Clone + '_ {
        let terms = self.offsets[output] as usize..self.offsets[output + 1] as usize;
        self.indices[terms.clone()].iter().copied().zip(self.weights[terms].iter().copied())
    }

    /// Number of outputs.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there are no outputs.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The outputs for these inputs.
    pub fn apply<T: Blend + Send + Sync>(&self, inputs: &[T]) -> Vec<T> {
        self.offsets
            .par_windows(2)
            .with_min_len(MIN_LEN)
            .map(|range| {
                let range = range[0] as usize..range[1] as usize;
                let terms = self.weights[range.clone()].iter().zip(&self.indices[range]);
                T::sum(terms.map(|(&weight, &index)| (weight, &inputs[index as usize])))
            })
            .collect()
    }
}
