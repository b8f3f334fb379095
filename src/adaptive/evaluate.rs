//! The surface of a plan on the CPU.

use super::caps;
use super::crease::{creased_spline, spline};
use super::plan::{LEAF, Leaf, LeafKind, Plan};
use crate::blend::{Point, scalar};
use crate::limit::LimitSample;
use crate::patch::gregory::gregory_quad_derivatives;
use glam::DVec3;

impl Plan {
    /// The leaf at (u, v) of a root, which are clamped to 0..=1, and the parameters there.
    ///
    /// # Panics
    /// If there is no such root.
    pub fn locate(&self, root: u32, u: f64, v: f64) -> (u32, f64, f64) {
        assert!((root as usize) < self.roots.len(), "there are {} roots, not {root}", self.roots.len());
        let (mut u, mut v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        let mut node = self.nodes[root as usize];
        let half = |t: f64| if t < 0.5 { (0, 2.0 * t) } else { (1, 2.0 * t - 1.0) };
        while node & LEAF == 0 {
            let ((i, in_u), (j, in_v)) = (half(u), half(v));
            (u, v) = (in_u, in_v);
            node = self.nodes[(node + i + 2 * j) as usize];
        }
        (node & !LEAF, u, v)
    }

    /// The leaves of a root, in the order of its quadtree.
    ///
    /// # Panics
    /// If there is no such root.
    pub fn leaves_of(&self, root: u32) -> Vec<u32> {
        let (mut leaves, mut nodes) = (Vec::new(), vec![self.nodes[root as usize]]);
        while let Some(node) = nodes.pop() {
            match node & LEAF {
                0 => nodes.extend((0..4).rev().map(|child| self.nodes[(node + child) as usize])),
                _ => leaves.push(node & !LEAF),
            }
        }
        leaves
    }

    /// The surface at (u, v) of a root, which are clamped to 0..=1, with [`Plan::points`]. `du` and `dv` are derivatives by
    /// the root's parameters.
    ///
    /// # Panics
    /// If there is no such root, or `points` are not as many as the plan has vertices.
    pub fn evaluate(&self, root: u32, u: f64, v: f64, points: &[DVec3]) -> LimitSample {
        let (leaf, u, v) = self.locate(root, u, v);
        let mut sample = self.evaluate_leaf(leaf, u, v, points);
        let scale = f64::from(1 << (self.leaves[leaf as usize].level - self.roots[root as usize].level));
        sample.du *= scale;
        sample.dv *= scale;
        sample
    }

    /// The surface at (u, v) of a leaf. `du` and `dv` are derivatives by the leaf's parameters.
    ///
    /// # Panics
    /// If there is no such leaf, or `points` are not as many as the plan has vertices.
    pub fn evaluate_leaf(&self, leaf: u32, u: f64, v: f64, points: &[DVec3]) -> LimitSample {
        assert_eq!(points.len(), self.vertex_count(), "one point a vertex of the plan");
        let leaf = &self.leaves[leaf as usize];
        let [position, du, dv] = match leaf.kind {
            LeafKind::Cap => leaf.kind.evaluate(&points[leaf.points as usize..][..leaf.kind.points()], u, v),
            _ => leaf.kind.evaluate(&self.grid(leaf).map(|vertex| points[vertex as usize]), u, v),
        };
        LimitSample { position, du, dv, normal: du.cross(dv).normalize_or_zero() }
    }

    /// The control points of a leaf, in order, with [`Plan::points`].
    pub fn control_points<T: Clone>(&self, leaf: &Leaf, points: &[T]) -> Vec<T> {
        match leaf.kind {
            LeafKind::Cap => points[leaf.points as usize..][..leaf.kind.points()].to_vec(),
            _ => self.grid(leaf).map(|vertex| points[vertex as usize].clone()).to_vec(),
        }
    }

    /// The vertices of a regular or single-crease leaf.
    fn grid(&self, leaf: &Leaf) -> [u32; 16] {
        std::array::from_fn(|point| self.grids[leaf.points as usize + point])
    }
}

impl LeafKind {
    /// Number of control points: 16 of a bicubic B-spline patch, 20 of a Gregory patch.
    pub fn points(self) -> usize {
        match self {
            Self::Regular | Self::SingleCrease { .. } => 16,
            Self::Cap => caps::POINTS as usize,
        }
    }

    /// Position and derivatives by u and v of a leaf with these control points, at its own parameters.
    ///
    /// # Panics
    /// If there are not [`LeafKind::points`] of them.
    pub fn evaluate<P: Point>(self, points: &[P], u: f64, v: f64) -> [P; 3] {
        let [mut in_u, mut in_v] = match self {
            Self::Cap => {
                let points = points.try_into().expect("20 points");
                return gregory_quad_derivatives(points, scalar::<P>(u), scalar::<P>(v));
            }
            _ => [spline(u), spline(v)],
        };
        if let Self::SingleCrease { edge, sharpness } = self {
            let (along, t) = if edge % 2 == 1 { (&mut in_u, u) } else { (&mut in_v, v) };
            let is_far = edge == 1 || edge == 2;
            let [mut value, mut slope] = creased_spline(if is_far { t } else { 1.0 - t }, f64::from(sharpness));
            if !is_far {
                value.reverse();
                slope.reverse();
                slope = slope.map(|w| -w);
            }
            *along = [value, slope];
        }
        let points: &[P; 16] = points.try_into().expect("16 points");
        let sum = |weights: &[f64; 4], points: [P; 4]| {
            let terms = weights.iter().zip(points).map(|(&weight, point)| point * scalar::<P>(weight));
            terms.fold(P::default(), |sum, term| sum + term)
        };
        let at = |in_u: &[f64; 4], in_v: &[f64; 4]| {
            sum(in_u, [0, 1, 2, 3].map(|i| sum(in_v, [0, 1, 2, 3].map(|j| points[4 * i + j]))))
        };
        [at(&in_u[0], &in_v[0]), at(&in_u[1], &in_v[0]), at(&in_u[0], &in_v[1])]
    }
}
