//! The surface of a plan on the CPU.

use super::caps;
use super::crease::{creased_spline, spline};
use super::plan::{LEAF, LeafKind, Plan};
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
        let first = leaf.points as usize;
        let [mut in_u, mut in_v] = match leaf.kind {
            LeafKind::Cap => {
                let points = points[first..first + caps::POINTS as usize].try_into().expect("20 points");
                let [position, du, dv] = gregory_quad_derivatives(points, u, v);
                return sample(position, du, dv);
            }
            _ => [spline(u), spline(v)],
        };
        if let LeafKind::SingleCrease { edge, sharpness } = leaf.kind {
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
        let grid = &self.grids[first..first + 16];
        let sum = |in_u: &[f64; 4], in_v: &[f64; 4]| {
            let row = |i: usize| (0..4).map(|j| in_v[j] * points[grid[4 * i + j] as usize]).sum::<DVec3>();
            (0..4).map(|i| in_u[i] * row(i)).sum::<DVec3>()
        };
        sample(sum(&in_u[0], &in_v[0]), sum(&in_u[1], &in_v[0]), sum(&in_u[0], &in_v[1]))
    }
}

fn sample(position: DVec3, du: DVec3, dv: DVec3) -> LimitSample {
    LimitSample { position, du, dv, normal: du.cross(dv).normalize_or_zero() }
}
