//! Root mean squares and maxima, summed in an order that does not depend on threads.

use super::error::Deviation;

/// What [`Deviation`] is made of.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    weight: f64,
    weighted_square: f64,
    count: usize,
    square: f64,
    max: f64,
}

impl Sums {
    pub(super) fn add(&mut self, weight: f64, value: f64) {
        let square = value * value;
        self.weight += weight;
        self.weighted_square += weight * square;
        self.count += 1;
        self.square += square;
        self.max = self.max.max(value);
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.weight += other.weight;
        self.weighted_square += other.weighted_square;
        self.count += other.count;
        self.square += other.square;
        self.max = self.max.max(other.max);
    }

    pub(super) fn deviation(&self) -> Deviation {
        let root = |sum: f64, weight: f64| if weight > 0.0 { (sum / weight).sqrt() } else { 0.0 };
        Deviation {
            rms: root(self.weighted_square, self.weight),
            rms_per_sample: root(self.square, self.count as f64),
            max: self.max,
        }
    }
}
