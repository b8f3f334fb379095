//! Facets at the points of their grids.

use super::bicubic::{self, Basis, Net, Window};
use super::kinds::{Refined, Shape};
use super::patches::{PLAIN, Patches};
use super::real::{Real, Vector, cross, subtract, unit};
use super::sums::Sums;

/// Where a thread evaluates facets. Nothing is allocated once it has seen the deepest facet.
#[derive(Default)]
pub(super) struct Arena<T> {
    /// The grid of a facet: row by row along u.
    pub positions: Vec<Vector<T>>,
    /// Of length one, zero where the surface has none. Empty if nobody asks for them.
    pub normals: Vec<Vector<T>>,
    /// Points in a grid row.
    pub side: usize,
    with_normals: bool,
    /// The points of the facet, then those of the quarter of it that is looked at, and so on.
    stack: Vec<Vector<T>>,
}

/// The surface over the facets of a mesh, whose vertices are `vertices`.
pub(super) struct Surface<'s, T> {
    pub patches: &'s Patches<T>,
    /// By depth.
    pub bases: &'s [Basis<T>],
    pub vertices: &'s [Vector<f64>],
}

/// A part of a facet.
#[derive(Clone, Copy)]
struct Part {
    kind: u32,
    /// Where its points start in the stack.
    points: usize,
    /// What they are relative to.
    origin: Vector<f64>,
    /// How often it is halved.
    depth: u32,
    /// Its first point in the grid.
    at: [usize; 2],
}

impl<T: Real> Surface<'_, T> {
    /// Evaluates a facet, given by its index, at `2^depth + 1` points along each side.
    pub(super) fn evaluate(&self, facet: usize, depth: u32, with_normals: bool, arena: &mut Arena<T>) {
        let side = (1usize << depth) + 1;
        let zero = [T::zero(); 3];
        arena.side = side;
        arena.with_normals = with_normals;
        // What is there from before is overwritten.
        arena.positions.resize(side * side, zero);
        arena.normals.resize(if with_normals { side * side } else { 0 }, zero);
        let (kind, points) = self.patches.facet(facet);
        let [x, y, z] = self.vertices[points[0] as usize];
        let [x, y, z] = [T::of(x).wide(), T::of(y).wide(), T::of(z).wide()];
        let origin = [x, y, z];
        let relative = |point: u32| {
            let point = &self.vertices[point as usize];
            [T::of(point[0] - x), T::of(point[1] - y), T::of(point[2] - z)]
        };
        if kind == PLAIN {
            return self.regular(&Net::new(|i| relative(points[i]), origin), depth, [0, 0], arena);
        }
        arena.stack.clear();
        arena.stack.extend(points.iter().map(|&point| relative(point)));
        self.part(Part { kind, points: 0, origin, depth, at: [0, 0] }, arena);
    }

    fn regular(&self, net: &Net<T>, depth: u32, at: [usize; 2], arena: &mut Arena<T>) {
        let first = at[1] * arena.side + at[0];
        let normals = if arena.with_normals { &mut arena.normals[first..] } else { &mut [] };
        let window = Window { positions: &mut arena.positions[first..], normals, stride: arena.side };
        bicubic::evaluate(net, &self.bases[depth as usize], window);
    }

    fn part(&self, part: Part, arena: &mut Arena<T>) {
        match &self.patches.kinds[part.kind as usize].shape {
            Shape::Regular(rows) => {
                let points = &arena.stack[part.points..];
                let net = Net::new(|i| rows.get(i, points), part.origin);
                self.regular(&net, part.depth, part.at, arena);
            }
            Shape::Irregular { corners: Some(rows), .. } if part.depth == 0 => self.corners(rows, part, arena),
            Shape::Irregular { refined: Some(refined), .. } if part.depth > 0 => self.quarters(refined, part, arena),
            Shape::Irregular { .. } => unreachable!("kinds are made for the depths of their facets"),
        }
    }

    fn corners(&self, rows: &Sums<T>, part: Part, arena: &mut Arena<T>) {
        for (k, [i, j]) in [[0, 0], [1, 0], [1, 1], [0, 1]].into_iter().enumerate() {
            let points = &arena.stack[part.points..];
            let position = rows.get(3 * k, points);
            let at = (part.at[1] + j) * arena.side + part.at[0] + i;
            if arena.with_normals {
                let [a, b] = [1, 2].map(|i| unit(rows.get(3 * k + i, points)));
                arena.normals[at] = unit(cross(a, b));
            }
            arena.positions[at] = std::array::from_fn(|axis| T::of(position[axis].wide() + part.origin[axis]));
        }
    }

    fn quarters(&self, refined: &Refined<T>, part: Part, arena: &mut Arena<T>) {
        let start = arena.stack.len();
        for i in 0..refined.points.len() {
            let point = refined.points.get(i, &arena.stack[part.points..start]);
            arena.stack.push(point);
        }
        let points = arena.stack.len();
        let half = 1 << (part.depth - 1);
        for (quarter, [i, j]) in refined.quarters.iter().zip([[0, 0], [1, 0], [1, 1], [0, 1]]) {
            // Relative to the corner, so that points keep their precision however small the quarter is.
            let corner = arena.stack[start + quarter.points[quarter.corner as usize] as usize];
            for &point in &quarter.points {
                let point = subtract(arena.stack[start + point as usize], corner);
                arena.stack.push(point);
            }
            let origin = std::array::from_fn(|axis| part.origin[axis] + corner[axis].wide());
            let at = [part.at[0] + i * half, part.at[1] + j * half];
            self.part(Part { kind: quarter.kind, points, origin, depth: part.depth - 1, at }, arena);
            arena.stack.truncate(points);
        }
        arena.stack.truncate(start);
    }
}
