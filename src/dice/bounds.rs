//! How far faces are from the limit surface at most.

use super::finer::{Cell as Part, Finer, Level, Turned};
use super::kinds::Shape;
use super::patches::{PLAIN, Patches};
use super::real::Vector;
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

/// Facets whose full bounds are made together.
const TOGETHER: usize = 256;

/// The quarters of a cell, and its corners.
const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

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

/// The bilinear surface between the corners of a cell.
struct Bilinear {
    corner: DVec3,
    u: DVec3,
    v: DVec3,
    twist: DVec3,
    normal: DVec3,
}

/// How far a surface is from a bilinear one: from where to where along the normal, and altogether.
#[derive(Clone, Copy, Default)]
struct Stray {
    low: f64,
    high: f64,
    distance: f64,
}

impl Stray {
    /// Of both.
    fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            distance: self.distance.max(other.distance),
        }
    }

    fn height(&self) -> f64 {
        self.high - self.low
    }
}

impl Bilinear {
    fn new([a, b, c, d]: [DVec3; 4]) -> Self {
        let normal = (c - a).cross(d - b).normalize_or_zero();
        Self { corner: a, u: b - a, v: d - a, twist: (a - b) + (c - d), normal }
    }

    fn at(&self, u: f64, v: f64) -> DVec3 {
        self.corner + u * self.u + v * self.v + u * v * self.twist
    }

    /// How much triangles between the corners lean to the normal: what lies sideways counts by as much.
    fn lean(&self) -> f64 {
        let sides = [self.u, self.v, self.u + self.twist, self.v + self.twist];
        self.height(self.twist).abs() / sides.map(DVec3::length).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The cosine of the greatest angle to these normals, or zero. Where the surface turns between faces, its distance is not
    /// along the normal of one of them, and by so much greater.
    fn cosine(&self, normals: [DVec3; 4]) -> f64 {
        normals.map(|normal| normal.normalize_or_zero().dot(self.normal)).into_iter().fold(1.0, f64::min).max(0.0)
    }

    /// Along the normal; without one nothing is known but the distance.
    fn height(&self, difference: DVec3) -> f64 {
        if self.normal == DVec3::ZERO { difference.length() } else { difference.dot(self.normal) }
    }

    fn measure(&self, difference: DVec3) -> Stray {
        let height = self.height(difference);
        Stray { low: height.min(0.0), high: height.max(0.0), distance: difference.length() }
    }

    /// Of a B-spline patch, by its control points after it was split so often.
    fn stray(&self, points: &[DVec3; 16], at: [f64; 2], size: f64, splits: u32) -> Stray {
        if splits > 0 {
            let half = size / 2.0;
            let of_quarter = |(quarter, [i, j]): (&[DVec3; 16], [f64; 2])| {
                self.stray(quarter, [at[0] + half * i, at[1] + half * j], half, splits - 1)
            };
            return quarters(points).iter().zip(PLACES).map(of_quarter).fold(Stray::default(), Stray::with);
        }
        let of_point = |i: usize| {
            let [u, v] = [i / 4, i % 4].map(|i| i as f64 - 1.0);
            self.measure(points[i] - self.at(at[0] + size * u, at[1] + size * v))
        };
        (0..16).map(of_point).fold(Stray::default(), Stray::with)
    }
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

    /// The bound of a facet, by its index, that is halved so often.
    pub(super) fn bound(&self, index: usize, depth: u32, effort: Effort) -> f64 {
        match self.finer.node(self.facets[index]) {
            Some(node) => self.of_part(Part::Node(node), depth, effort),
            None => self.faces.bound(index, depth, effort),
        }
    }

    /// Whether a facet that is halved so often is as near as this.
    pub(super) fn is_within(&self, distance: f64, index: usize, depth: u32) -> bool {
        [Effort::SMALL, Effort::FULL].into_iter().any(|effort| self.bound(index, depth, effort) <= distance)
    }

    /// The greatest bound of all facets, each halved as often as `depth` says.
    pub(super) fn greatest(&self, depth: impl Fn(usize) -> u32 + Sync) -> f64 {
        let small = |index| (self.bound(index, depth(index), Effort::SMALL), index);
        let mut facets: Vec<(f64, usize)> = (0..self.facets.len()).into_par_iter().map(small).collect();
        facets.par_sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        let mut greatest = 0.0f64;
        // Of those whose bound is below the greatest of others with less work, too, no more is asked.
        for some in facets.chunks(TOGETHER) {
            if some[0].0 <= greatest {
                break;
            }
            let full = |&(small, index): &(f64, usize)| self.bound(index, depth(index), Effort::FULL).min(small);
            greatest = some.par_iter().map(full).reduce(|| greatest, f64::max);
        }
        greatest
    }

    fn of_part(&self, part: Part, depth: u32, effort: Effort) -> f64 {
        match part {
            Part::Face { level, index } => self.levels[level as usize].bound(index as usize, depth, effort),
            Part::Node(node) if depth > 0 => {
                let of_quarter = |quarter| self.of_part(quarter, depth - 1, effort);
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

    /// The bound of a face that is halved so often.
    fn bound(&self, index: usize, depth: u32, effort: Effort) -> f64 {
        let kind = self.patches.facet(index).0;
        let points: Vec<Vector<f64>> = self.points(index).collect();
        if kind == PLAIN {
            return bend(&std::array::from_fn(|i| points[i].into()), depth, effort.splits);
        }
        self.of_cell(Cell { kind, points: &points }, depth, effort)
    }

    fn of_cell(&self, cell: Cell, depth: u32, effort: Effort) -> f64 {
        match &self.patches.kinds[cell.kind as usize].shape {
            Shape::Regular(rows) => {
                bend(&std::array::from_fn(|i| rows.get(i, cell.points).into()), depth, effort.splits)
            }
            Shape::Irregular { corners: Some(rows), .. } if depth == 0 => self.of_last(cell, rows, effort),
            _ => {
                let mut most = 0.0f64;
                self.for_each_quarter(cell, |quarter, _| most = most.max(self.of_cell(quarter, depth - 1, effort)));
                most
            }
        }
    }

    /// Of a cell that is one face, or cut into triangles.
    fn of_last(&self, cell: Cell, rows: &Sums<f64>, effort: Effort) -> f64 {
        let [a, b, c, d] = [0, 3, 6, 9].map(|i| DVec3::from(rows.get(i, cell.points)));
        let flat = Bilinear::new([a, b, c, d]);
        let stray = self.stray(cell, &flat, ([0.0, 0.0], 1.0), effort, effort.levels);
        // Corners of triangles may be on the surface anywhere along the cell's edges: it counts how far these and what is between
        // them are from the bilinear surface, and a quarter of the twist, which is how far this is from triangles.
        let distance = 2.0 * stray.distance + flat.twist.length() / 4.0;
        let height = stray.height() + 2.0 * flat.lean() * stray.distance + flat.height(flat.twist).abs() / 4.0;
        let normals = [0, 3, 6, 9].map(|i| {
            let [a, b] = [i + 1, i + 2].map(|i| DVec3::from(rows.get(i, cell.points)));
            a.cross(b)
        });
        distance.min(height / flat.cosine(normals))
    }

    /// How far the surface of a cell, by where it begins and its size, is from a bilinear one; `levels` are left.
    fn stray(&self, cell: Cell, flat: &Bilinear, (at, size): ([f64; 2], f64), effort: Effort, levels: u32) -> Stray {
        let from = |point: Vector<f64>, u: f64, v: f64| {
            flat.measure(DVec3::from(point) - flat.at(at[0] + size * u, at[1] + size * v))
        };
        match &self.patches.kinds[cell.kind as usize].shape {
            Shape::Regular(rows) => {
                let points = std::array::from_fn(|i| rows.get(i, cell.points).into());
                // Cells become smaller towards the vertex, and are split less.
                flat.stray(&points, at, size, (effort.splits + levels).saturating_sub(effort.levels - 1))
            }
            Shape::Irregular { refined: Some(_), .. } if levels > 0 => {
                let mut most = Stray::default();
                let half = size / 2.0;
                self.for_each_quarter(cell, |quarter, [i, j]| {
                    let at = [at[0] + half * i, at[1] + half * j];
                    most = most.with(self.stray(quarter, flat, (at, half), effort, levels - 1));
                });
                most
            }
            Shape::Irregular { .. } => {
                let middle = flat.at(at[0] + size / 2.0, at[1] + size / 2.0);
                let most = |stray: Stray, other: Stray| stray.with(other);
                let extent = PLACES.map(|[u, v]| from(middle.into(), u, v)).into_iter().fold(Stray::default(), most);
                let points = cell.points.iter().map(|&point| from(point, 0.5, 0.5)).fold(Stray::default(), most);
                let (low, high) = (points.low + extent.low, points.high + extent.high);
                Stray { low, high, distance: extent.distance + points.distance }
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

/// Four B-spline control points of a curve become five of its halves.
fn halve(p: [DVec3; 4]) -> [DVec3; 5] {
    let middle = |i: usize| 0.5 * (p[i] + p[i + 1]);
    let corner = |i: usize| 0.125 * (p[i - 1] + 6.0 * p[i] + p[i + 1]);
    [middle(0), corner(1), middle(1), corner(2), middle(2)]
}

/// The control points of the quarters of a B-spline patch.
fn quarters(points: &[DVec3; 16]) -> [[DVec3; 16]; 4] {
    let along_v: [[DVec3; 5]; 4] = std::array::from_fn(|i| halve(std::array::from_fn(|j| points[4 * i + j])));
    let along_u: [[DVec3; 5]; 5] = std::array::from_fn(|j| halve(std::array::from_fn(|i| along_v[i][j])));
    [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| std::array::from_fn(|k| along_u[j + k % 4][i + k / 4]))
}

/// The distance between a B-spline patch that is halved `depth` times and the faces of its cells, by second differences of its
/// control points: along the normals of such faces if these are known well enough, else altogether.
fn bend(points: &[DVec3; 16], depth: u32, splits: u32) -> f64 {
    if depth > 0 && splits > 0 {
        return quarters(points).iter().map(|quarter| bend(quarter, depth - 1, splits - 1)).fold(0.0, f64::max);
    }
    let at = |i: usize, j: usize| points[4 * i + j];
    let second = |measure: &dyn Fn(DVec3) -> f64| {
        let [mut uu, mut uv, mut vv] = [0.0f64; 3];
        for i in 0..4 {
            for j in 0..2 {
                uu = uu.max(measure(at(j, i) - 2.0 * at(j + 1, i) + at(j + 2, i)));
                vv = vv.max(measure(at(i, j) - 2.0 * at(i, j + 1) + at(i, j + 2)));
            }
        }
        for i in 0..3 {
            for j in 0..3 {
                uv = uv.max(measure(at(i, j) - at(i + 1, j) - at(i, j + 1) + at(i + 1, j + 1)));
            }
        }
        [uu, uv, vv]
    };
    let bound = |[uu, uv, vv]: [f64; 3]| (uu + 2.0 * uv + vv) / 8.0;
    let distance = bound(second(&DVec3::length));
    if depth == 0 {
        let along_u = |i: usize, j: usize| at(i, j) + 4.0 * at(i + 1, j) + at(i + 2, j);
        let corner = |[i, j]: [usize; 2]| (along_u(i, j) + 4.0 * along_u(i, j + 1) + along_u(i, j + 2)) / 36.0;
        let flat = Bilinear::new([[0, 0], [1, 0], [1, 1], [0, 1]].map(corner));
        let heights = second(&|difference| flat.height(difference).abs());
        let side = |i: usize, j: usize| at(i + 2, j) - at(i, j);
        let across = |i: usize, j: usize| at(i, j + 2) - at(i, j);
        let normals = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| {
            let along = side(i, j) + 4.0 * side(i, j + 1) + side(i, j + 2);
            along.cross(across(i, j) + 4.0 * across(i + 1, j) + across(i + 2, j))
        });
        return distance.min((bound(heights) + flat.lean() * distance) / flat.cosine(normals));
    }
    let along_normals = |cone: Cone| {
        bound(second(&|d| d.dot(cone.axis).abs() + cone.sine * d.length())) / (1.0 - cone.sine * cone.sine).sqrt()
    };
    Cone::new(points).map_or(distance, |cone| distance.min(along_normals(cone))) / f64::from(1 << (2 * depth))
}

/// All normals of a patch, and of faces with points of it.
struct Cone {
    axis: DVec3,
    /// Of the greatest angle to the axis.
    sine: f64,
}

impl Cone {
    /// Tangents are sums of first differences of control points with weights above zero, so normals are of their cross products.
    /// `None` if these are not all on one side.
    fn new(points: &[DVec3; 16]) -> Option<Self> {
        let at = |i: usize, j: usize| points[4 * i + j];
        let mut along = [[DVec3::ZERO; 2]; 12];
        for i in 0..3 {
            for j in 0..4 {
                along[4 * i + j] = [at(i + 1, j) - at(i, j), at(j, i + 1) - at(j, i)];
            }
        }
        let axis = (at(2, 2) - at(1, 1)).cross(at(1, 2) - at(2, 1)).try_normalize()?;
        let mut least_cosine = 1.0f64;
        for [du, _] in along {
            for [_, dv] in along {
                least_cosine = least_cosine.min(du.cross(dv).normalize_or_zero().dot(axis));
            }
        }
        let is_narrow = least_cosine > 0.0;
        is_narrow.then(|| Self { axis, sine: (1.0 - least_cosine * least_cosine).max(0.0).sqrt() })
    }
}
