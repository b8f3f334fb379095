//! Numbers for a few of many vertices.

/// Vertices in the order in which they came first.
pub(super) struct Numbering {
    pub vertices: Vec<u32>,
    /// The vertices in ascending order, with where they first came.
    firsts: Vec<(u32, u32)>,
    /// The number of each of those.
    numbers: Vec<u32>,
}

impl Numbering {
    pub(super) fn new(vertices: impl Iterator<Item = u32>) -> Self {
        let mut firsts: Vec<(u32, u32)> = vertices.zip(0..).collect();
        firsts.sort_unstable();
        firsts.dedup_by_key(|&mut (vertex, _)| vertex);
        let mut order: Vec<u32> = (0..firsts.len() as u32).collect();
        order.sort_unstable_by_key(|&i| firsts[i as usize].1);
        let mut numbers = vec![0; firsts.len()];
        order.iter().zip(0..).for_each(|(&i, number)| numbers[i as usize] = number);
        let vertices = order.iter().map(|&i| firsts[i as usize].0).collect();
        Self { vertices, firsts, numbers }
    }

    /// The number of a vertex that came.
    pub(super) fn number(&self, vertex: u32) -> u32 {
        self.numbers[self.firsts.partition_point(|&(v, _)| v < vertex)]
    }
}
