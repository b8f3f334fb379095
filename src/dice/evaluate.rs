//! Facets at the points of their grids.

use super::bicubic::{self, Basis, Net, Window};
use super::finer::{Cell, Finer, PLACES};
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

impl<T: Real> Arena<T> {
    /// Makes room for a facet that is halved so often. What is there from before is overwritten.
    fn resize(&mut self, depth: u32, with_normals: bool) {
        let side = (1usize << depth) + 1;
        let zero = [T::zero(); 3];
        self.side = side;
        self.with_normals = with_normals;
        self.positions.resize(side * side, zero);
        self.normals.resize(if with_normals { side * side } else { 0 }, zero);
    }
}

/// The surface over the facets of a mesh.
pub(super) struct Surface<'s, T> {
    /// By depth.
    pub bases: &'s [Basis<T>],
    pub facets: Faces<'s, T>,
    /// The parts of facets in finer levels, by level.
    pub finer: Option<(&'s Finer, Vec<Faces<'s, T>>)>,
}

/// Faces of a mesh whose vertices are `vertices`.
pub(super) struct Faces<'s, T> {
    pub patches: &'s Patches<T>,
    pub vertices: &'s [Vector<f64>],
}

/// A part of a facet.
struct Part<'s, T> {
    patches: &'s Patches<T>,
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
    /// Evaluates a facet, given by its index and its number, at `2^depth + 1` points along each side.
    pub(super) fn evaluate(&self, index: usize, facet: u32, depth: u32, with_normals: bool, arena: &mut Arena<T>) {
        arena.resize(depth, with_normals);
        match self.finer.as_ref().and_then(|(finer, _)| finer.node(facet)) {
            Some(node) => self.cell(Cell::Node(node), depth, [0, 0], arena),
            None => self.face(&self.facets, index, depth, [0, 0], arena),
        }
    }

    /// Evaluates a part of a facet.
    fn cell(&self, cell: Cell, depth: u32, at: [usize; 2], arena: &mut Arena<T>) {
        let Some((finer, levels)) = &self.finer else { return };
        let node = match cell {
            Cell::Face { level, index } => return self.face(&levels[level as usize], index as usize, depth, at, arena),
            Cell::Node(node) => node,
        };
        if depth > 0 {
            let half = 1 << (depth - 1);
            for (quarter, place) in finer.quarters(node).into_iter().zip(PLACES) {
                let [i, j] = [0, 1].map(|axis| at[axis] + place[axis] as usize * half);
                self.cell(quarter, depth - 1, [i, j], arena);
            }
            return;
        }
        // The corners are those of the quarters there.
        let mut corner = Arena::default();
        corner.resize(0, arena.with_normals);
        for (quarter, place) in finer.quarters(node).into_iter().zip(PLACES) {
            self.cell(quarter, 0, [0, 0], &mut corner);
            let [i, j] = place.map(|i| i as usize);
            let to = (at[1] + j) * arena.side + at[0] + i;
            arena.positions[to] = corner.positions[2 * j + i];
            if arena.with_normals {
                arena.normals[to] = corner.normals[2 * j + i];
            }
        }
    }

    /// Evaluates a face.
    fn face(&self, faces: &Faces<'_, T>, index: usize, depth: u32, at: [usize; 2], arena: &mut Arena<T>) {
        let (kind, points) = faces.patches.facet(index);
        let [x, y, z] = faces.vertices[points[0] as usize];
        let [x, y, z] = [T::of(x).wide(), T::of(y).wide(), T::of(z).wide()];
        let origin = [x, y, z];
        let relative = |point: u32| {
            let point = &faces.vertices[point as usize];
            [T::of(point[0] - x), T::of(point[1] - y), T::of(point[2] - z)]
        };
        if kind == PLAIN {
            return self.regular(&Net::new(|i| relative(points[i]), origin), depth, at, arena);
        }
        arena.stack.clear();
        arena.stack.extend(points.iter().map(|&point| relative(point)));
        self.part(Part { patches: faces.patches, kind, points: 0, origin, depth, at }, arena);
    }

    fn regular(&self, net: &Net<T>, depth: u32, at: [usize; 2], arena: &mut Arena<T>) {
        let first = at[1] * arena.side + at[0];
        let normals = if arena.with_normals { &mut arena.normals[first..] } else { &mut [] };
        let window = Window { positions: &mut arena.positions[first..], normals, stride: arena.side };
        bicubic::evaluate(net, &self.bases[depth as usize], window);
    }

    fn part(&self, part: Part<'_, T>, arena: &mut Arena<T>) {
        match &part.patches.kinds[part.kind as usize].shape {
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

    fn corners(&self, rows: &Sums<T>, part: Part<'_, T>, arena: &mut Arena<T>) {
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

    fn quarters(&self, refined: &Refined<T>, part: Part<'_, T>, arena: &mut Arena<T>) {
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
            let (patches, kind, depth) = (part.patches, quarter.kind, part.depth - 1);
            self.part(Part { patches, kind, points, origin, depth, at }, arena);
            arena.stack.truncate(points);
        }
        arena.stack.truncate(start);
    }
}
