//! Weighted sums in the precision of a tessellation.

use super::real::{Real, Vector};
use crate::blend::Row;

/// Weighted sums of points: output `i` has the terms `offsets[i]..offsets[i + 1]`.
#[derive(Debug)]
pub(super) struct Sums<T> {
    offsets: Vec<u32>,
    indices: Vec<u32>,
    weights: Vec<T>,
}

impl<T: Real> Sums<T> {
    pub(super) fn new(rows: impl IntoIterator<Item = Row>) -> Self {
        let mut sums = Self { offsets: vec![0], indices: Vec::new(), weights: Vec::new() };
        for row in rows {
            for &(index, weight) in row.weights().iter().filter(|(_, weight)| *weight != 0.0) {
                sums.indices.push(index);
                sums.weights.push(T::of(weight));
            }
            sums.offsets.push(sums.indices.len() as u32);
        }
        sums
    }

    /// Number of outputs.
    pub(super) fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Output `i` for these inputs.
    #[inline]
    pub(super) fn get(&self, i: usize, inputs: &[Vector<T>]) -> Vector<T> {
        let terms = self.offsets[i] as usize..self.offsets[i + 1] as usize;
        let [mut x, mut y, mut z] = [T::zero(); 3];
        for (&index, &weight) in self.indices[terms.clone()].iter().zip(&self.weights[terms]) {
            let point = &inputs[index as usize];
            x = x + weight * point[0];
            y = y + weight * point[1];
            z = z + weight * point[2];
        }
        [x, y, z]
    }
}
