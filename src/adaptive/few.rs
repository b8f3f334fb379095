//! Sums of a few unknowns.

use crate::blend::Blend;

/// The most unknowns of a sum.
pub(super) const FEW: usize = 64;

/// A weighted sum of unknowns with numbers below [`FEW`], as [`Row`](crate::blend::Row) is one of any, without allocations.
#[derive(Clone)]
pub(super) struct Few {
    /// A bit for each unknown that is in the sum, if with a weight of zero.
    terms: u64,
    weights: [f64; FEW],
}

impl Few {
    /// Unknowns, each at most once, and their weights.
    pub(super) fn new(weights: impl IntoIterator<Item = (u32, f64)>) -> Self {
        let mut few = Self::default();
        for (index, weight) in weights {
            few.terms |= 1 << index;
            few.weights[index as usize] = weight;
        }
        few
    }

    /// The unknown `index` itself.
    pub(super) fn unit(index: u32) -> Self {
        Self::new([(index, 1.0)])
    }

    /// Index and weight of each unknown, by ascending index.
    pub(super) fn weights(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let next = |&terms: &u64| (terms != 0).then_some(terms & terms.wrapping_sub(1));
        let rests = std::iter::successors(Some(self.terms), next).take_while(|&terms| terms != 0);
        rests.map(|terms| (terms.trailing_zeros(), self.weights[terms.trailing_zeros() as usize]))
    }
}

impl Default for Few {
    fn default() -> Self {
        Self { terms: 0, weights: [0.0; FEW] }
    }
}

impl Blend for Few {
    fn add_scaled(&mut self, weight: f64, value: &Self) {
        value.weights().for_each(|(index, w)| self.weights[index as usize] += weight * w);
        self.terms |= value.terms;
    }
}
