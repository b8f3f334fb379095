//! Values of which weighted sums can be made.

use glam::{DVec3, Vec3};

/// A value of which control points are weighted sums. `Default` is zero.
pub trait Blend: Clone + Default {
    /// Adds `weight * value`.
    fn add_scaled(&mut self, weight: f64, value: &Self);

    /// The weighted sum of values, in the order given.
    fn sum<'a>(terms: impl IntoIterator<Item = (f64, &'a Self)>) -> Self
    where
        Self: 'a,
    {
        let mut sum = Self::default();
        for (weight, value) in terms {
            sum.add_scaled(weight, value);
        }
        sum
    }
}

impl Blend for Vec3 {
    fn add_scaled(&mut self, weight: f64, value: &Self) {
        *self += *value * weight as f32;
    }
}

impl Blend for DVec3 {
    fn add_scaled(&mut self, weight: f64, value: &Self) {
        *self += *value * weight;
    }
}

impl Blend for f64 {
    fn add_scaled(&mut self, weight: f64, value: &Self) {
        *self += value * weight;
    }
}

/// A weighted sum of numbered unknowns: the weights with which a control point sums the vertices of a ring.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    /// By ascending index; indices that are absent have weight zero.
    weights: Vec<(u32, f64)>,
}

impl Row {
    /// The unknown `index` itself.
    pub fn unit(index: u32) -> Self {
        Self { weights: vec![(index, 1.0)] }
    }

    /// Unknowns, each at most once, and their weights.
    pub fn new(mut weights: Vec<(u32, f64)>) -> Self {
        weights.sort_unstable_by_key(|w| w.0);
        Self { weights }
    }

    /// Index and weight of each unknown, by ascending index.
    pub fn weights(&self) -> &[(u32, f64)] {
        &self.weights
    }

    /// The weight of one unknown.
    pub fn weight(&self, index: u32) -> f64 {
        self.weights.binary_search_by_key(&index, |w| w.0).map_or(0.0, |at| self.weights[at].1)
    }
}

impl Blend for Row {
    fn add_scaled(&mut self, weight: f64, value: &Self) {
        for &(index, w) in &value.weights {
            // Rings are summed in ascending order, so most terms go to the end.
            match self.weights.last() {
                Some(&(last, _)) if last >= index => match self.weights.binary_search_by_key(&index, |w| w.0) {
                    Ok(at) => self.weights[at].1 += weight * w,
                    Err(at) => self.weights.insert(at, (index, weight * w)),
                },
                _ => self.weights.push((index, weight * w)),
            }
        }
    }
}
