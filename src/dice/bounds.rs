//! How far faces are from the limit surface at most.

use super::bend::bend;
use super::finer::{Cell as Part, Finer, Level, Turned};
use super::kinds::Shape;
use super::patches::{PLAIN, Patches};
use super::real::Vector;
use super::strays::{Bilinear, PLACES, Square, Stray, Strays};
use super::sums::Sums;
use crate::mesh::MeshError;
use crate::topology::Topology;
use glam::DVec3;
use rayon::prelude::*;

/// Levels of refinement within the last cells around extraordinary vertices and sharp features. What is left after them counts
/// with its whole size, about a thousandth of the cell's.
const LEVELS: u32 = 10;

/// Facets whose bounds are made together, at most.
pub(super) const PIECE: usize = 1 << 19;

/// How much work a bound is: what it says is right in any case, and less with more work.
#[derive(Clone, Copy)]
pub(super) struct Effort {
    /// How often B-spline patches are split to know their normals better.
    splits: u32,
    /// As [`LEVELS`].
    levels: u32,
}

impl Effort {
    pub(super) const SMALL: Self = Self { splits: 0, levels: 3 };
    pub(super) const FULL: Self = Self { splits: 3, levels: LEVELS };
}

/// Faces of a facet whose distance is asked for.
#[derive(Clone, Copy)]
pub(super) struct Asked {
    /// How often the facet is halved.
    pub depth: u32,
    /// Whether more points than the corners of its cells lie on its edges, as beside facets that are halved more often.
    pub has_finer_edges: bool,
}

impl Asked {
    fn of_quarter(self) -> Self {
        Self { depth: self.depth - 1, ..self }
    }
}

/// Facets whose full bounds are made together.
const TOGETHER: usize = 256;

/// Bounds of the facets of a mesh.
pub(super) struct Bounds<'f> {
    facets: Vec<u32>,
    faces: Faces<'f>,
    finer: &'f Finer,
    /// By level.
    levels: Vec<Faces<'f>>,
}

/// Faces of a mesh.
struct Faces<'f> {
    patches: Patches<f64>,
    vertices: &'f [Vector<f64>],
}

/// A cell of a facet, with its points.
#[derive(Clone, Copy)]
struct Cell<'p> {
    kind: u32,
    points: &'p [Vector<f64>],
}

impl<'f> Bounds<'f> {
    /// Of facets that are halved `deepest` times at most.
    pub(super) fn new(
        topology: &'f Topology,
        finer: &'f Finer,
        facets: &[u32],
        deepest: u32,
    ) -> Result<Self, MeshError> {
        let turned: Vec<Turned> = facets.iter().map(|&face| Turned { face, first: 0 }).collect();
        let of_level = |level: &'f Level| Faces::new(&level.topology, &level.faces, deepest);
        let levels = finer.levels.iter().map(of_level).collect::<Result<_, _>>()?;
        Ok(Self { facets: facets.to_vec(), faces: Faces::new(topology, &turned, deepest)?, finer, levels })
    }

    /// The bound of a facet, by its index.
    pub(super) fn bound(&self, index: usize, asked: Asked, effort: Effort) -> f64 {
        match self.finer.node(self.facets[index]) {
            Some(node) => self.of_part(Part::Node(node), asked, effort),
            None => self.faces.bound(index, asked, effort),
        }
    }

    /// Whether a facet is as near as this.
    pub(super) fn is_within(&self, distance: f64, index: usize, asked: Asked) -> bool {
        [Effort::SMALL, Effort::FULL].into_iter().any(|effort| self.bound(index, asked, effort) <= distance)
    }

    /// The greatest bound of all facets, by what is asked of each.
    pub(super) fn greatest(&self, asked: impl Fn(usize) -> Asked + Sync) -> f64 {
        let small = |index| (self.bound(index, asked(index), Effort::SMALL), index);
        let mut facets: Vec<(f64, usize)> = (0..self.facets.len()).into_par_iter().map(small).collect();
        facets.par_sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        let mut greatest = 0.0f64;
        // Of those whose bound is below the greatest of others with less work, too, no more is asked.
        for some in facets.chunks(TOGETHER) {
            if some[0].0 <= greatest {
                break;
            }
            let full = |&(small, index): &(f64, usize)| self.bound(index, asked(index), Effort::FULL).min(small);
            greatest = some.par_iter().map(full).reduce(|| greatest, f64::max);
        }
        greatest
    }

    fn of_part(&self, part: Part, asked: Asked, effort: Effort) -> f64 {
        match part {
            Part::Face { level, index } => self.levels[level as usize].bound(index as usize, asked, effort),
            Part::Node(node) if asked.depth > 0 => {
                let of_quarter = |quarter| self.of_part(quarter, asked.of_quarter(), effort);
                self.finer.quarters(node).map(of_quarter).into_iter().fold(0.0, f64::max)
            }
            // One face for several of a finer level: both are among the control points of these.
            Part::Node(_) => {
                let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
                self.finer.for_each_face(part, 0, &mut |level, index, _| {
                    for point in self.levels[level as usize].points(index as usize) {
                        bounds = [bounds[0].min(point.into()), bounds[1].max(point.into())];
                    }
                });
                bounds[0].distance(bounds[1])
            }
        }
    }
}

impl<'f> Faces<'f> {
    fn new(topology: &'f Topology, faces: &[Turned], deepest: u32) -> Result<Self, MeshError> {
        let deepen = |builder: &mut super::kinds::Builder, _, kind| builder.deepen_all(kind, deepest + LEVELS);
        let patches = Patches::new(topology, faces, deepen)?;
        Ok(Self { patches, vertices: &topology.mesh().data().positions })
    }

    /// The points around a face.
    fn points(&self, index: usize) -> impl Iterator<Item = Vector<f64>> {
        self.patches.facet(index).1.iter().map(|&vertex| self.vertices[vertex as usize])
    }

    /// The bound of a face.
    fn bound(&self, index: usize, asked: Asked, effort: Effort) -> f64 {
        let kind = self.patches.facet(index).0;
        let points: Vec<Vector<f64>> = self.points(index).collect();
        if kind == PLAIN {
            return bend(&std::array::from_fn(|i| points[i].into()), asked.depth, effort.splits);
        }
        self.of_cell(Cell { kind, points: &points }, asked, effort)
    }

    fn of_cell(&self, cell: Cell, asked: Asked, effort: Effort) -> f64 {
        match &self.patches.kinds[cell.kind as usize].shape {
            Shape::Regular(rows) => {
                bend(&std::array::from_fn(|i| rows.get(i, cell.points).into()), asked.depth, effort.splits)
            }
            Shape::Irregular { corners: Some(rows), .. } if asked.depth == 0 => {
                self.of_last(cell, rows, (asked.has_finer_edges, effort))
            }
            _ => {
                let mut most = 0.0f64;
                self.for_each_quarter(cell, |quarter, _| {
                    most = most.max(self.of_cell(quarter, asked.of_quarter(), effort))
                });
                most
            }
        }
    }

    /// Of a cell that is one face, or cut into triangles.
    fn of_last(&self, cell: Cell, rows: &Sums<f64>, (has_finer_edges, effort): (bool, Effort)) -> f64 {
        let [a, b, c, d] = [0, 3, 6, 9].map(|i| DVec3::from(rows.get(i, cell.points)));
        let flat = Bilinear::new([a, b, c, d]);
        let mut strays = Strays::default();
        self.add_strays(cell, &flat, Square::whole(), (effort, effort.levels), &mut strays);
        let twist = [flat.height(flat.twist), flat.lean * flat.sideways(flat.twist)];
        let [of_corners, height] = match has_finer_edges {
            true => [strays.distance(), strays.height_beside_finer(twist)],
            false => [0.0, strays.height(twist)],
        };
        let distance = of_corners + strays.distance() + flat.twist.length() / 4.0;
        let normals = [0, 3, 6, 9].map(|i| {
            let [a, b] = [i + 1, i + 2].map(|i| DVec3::from(rows.get(i, cell.points)));
            a.cross(b)
        });
        distance.min(height / flat.cosine(normals))
    }

    /// Adds how far the surface of a cell is from a bilinear one; `levels` are left.
    fn add_strays(
        &self,
        cell: Cell,
        flat: &Bilinear,
        square: Square,
        (effort, levels): (Effort, u32),
        strays: &mut Strays,
    ) {
        match &self.patches.kinds[cell.kind as usize].shape {
            Shape::Regular(rows) => {
                let points = std::array::from_fn(|i| rows.get(i, cell.points).into());
                // Cells become smaller towards the vertex, and are split less.
                strays.add(flat, &points, square, (effort.splits + levels).saturating_sub(effort.levels - 1));
            }
            Shape::Irregular { refined: Some(_), .. } if levels > 0 => self.for_each_quarter(cell, |quarter, place| {
                self.add_strays(quarter, flat, square.quarter(place), (effort, levels - 1), strays);
            }),
            Shape::Irregular { .. } => {
                let Square { at, size } = square;
                let on_flat = |u: f64, v: f64| flat.at(at[0] + size * u, at[1] + size * v);
                let middle = on_flat(0.5, 0.5);
                let extent = PLACES.map(|[u, v]| flat.measure(middle - on_flat(u, v)));
                let extent = extent.into_iter().fold(Stray::default(), Stray::with);
                let points = cell.points.iter().map(|&point| flat.measure(DVec3::from(point) - middle));
                let points = points.fold(Stray::default(), Stray::with);
                let (low, high) = (points.low + extent.low, points.high + extent.high);
                strays.add_whole(square, Stray { low, high, distance: extent.distance + points.distance });
            }
        }
    }

    /// The quarters of a cell, each with its place.
    fn for_each_quarter(&self, cell: Cell, mut visit: impl FnMut(Cell, [f64; 2])) {
        let Shape::Irregular { refined: Some(refined), .. } = &self.patches.kinds[cell.kind as usize].shape else {
            unreachable!("kinds are made for all depths")
        };
        let fine: Vec<Vector<f64>> = (0..refined.points.len()).map(|i| refined.points.get(i, cell.points)).collect();
        for (quarter, place) in refined.quarters.iter().zip(PLACES) {
            let points: Vec<Vector<f64>> = quarter.points.iter().map(|&point| fine[point as usize]).collect();
            visit(Cell { kind: quarter.kind, points: &points }, place);
        }
    }
}
