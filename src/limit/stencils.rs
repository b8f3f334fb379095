//! Weighted sums of one step of refinement.

use crate::blend::{Blend, Row};
use rayon::prelude::*;

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

impl Default for Stencils {
    fn default() -> Self {
        Self { offsets: vec![0], indices: Vec::new(), weights: Vec::new() }
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
