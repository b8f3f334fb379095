//! Root mean squares and maxima, summed in an order that does not depend on threads.

/// Size of a deviation over many samples. All are zero if there are no samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviation {
    /// Root mean square, every sample weighted by the area of the limit surface that it stands for.
    pub rms: f64,
    /// Root mean square over the samples as they are.
    pub rms_per_sample: f64,
    /// The largest.
    pub max: f64,
}

impl Deviation {
    pub(super) fn scaled(self, scale: f64) -> Self {
        Self { rms: scale * self.rms, rms_per_sample: scale * self.rms_per_sample, max: scale * self.max }
    }
}

/// Sums that [`Deviation`] is made of.
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
