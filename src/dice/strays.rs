//! How far surfaces are from bilinear ones.

use super::bend::quarters;
use glam::DVec3;

/// The quarters of a cell, and its corners.
pub(super) const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// The bilinear surface between the corners of a cell.
pub(super) struct Bilinear {
    pub corner: DVec3,
    pub u: DVec3,
    pub v: DVec3,
    pub twist: DVec3,
    pub normal: DVec3,
    /// How much triangles between the corners lean to the normal: what lies sideways counts by as much.
    pub lean: f64,
}

/// How far a surface is from a bilinear one: from where to where along the normal, and altogether.
#[derive(Clone, Copy, Default)]
pub(super) struct Stray {
    pub low: f64,
    pub high: f64,
    pub distance: f64,
}

impl Stray {
    /// Of both.
    pub fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            distance: self.distance.max(other.distance),
        }
    }
}

/// Part of a cell: a square of its parameters.
#[derive(Clone, Copy)]
pub(super) struct Square {
    pub at: [f64; 2],
    pub size: f64,
}

/// Slope of what stands upright.
const STEEP: f64 = 1e9;

/// Bins along the edges of a cell.
const BINS: usize = 32;

/// How far the parts of a cell are from the bilinear surface between its corners.
#[derive(Default)]
pub(super) struct Strays {
    parts: Vec<(Square, Stray)>,
    /// The greatest on the edges along u, and on those along v: above and below.
    edges: [[[f64; BINS]; 2]; 2],
}

impl Bilinear {
    pub fn new([a, b, c, d]: [DVec3; 4]) -> Self {
        let normal = (c - a).cross(d - b).normalize_or_zero();
        let mut flat = Self { corner: a, u: b - a, v: d - a, twist: (a - b) + (c - d), normal, lean: 0.0 };
        let triangles = [[a, b, c], [a, c, d], [a, b, d], [b, c, d]];
        let tilt = |[a, b, c]: [DVec3; 3]| {
            let across = (b - a).cross(c - a);
            let sideways = across.cross(normal).length();
            if sideways == 0.0 { 0.0 } else { sideways / across.dot(normal).abs().max(sideways / STEEP) }
        };
        flat.lean = triangles.map(tilt).into_iter().fold(0.0, f64::max);
        flat
    }

    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        self.corner + u * self.u + v * self.v + u * v * self.twist
    }

    /// The cosine of the greatest angle to these normals, or zero. Where the surface turns between faces, its distance is not
    /// along the normal of one of them, and by so much greater.
    pub fn cosine(&self, normals: [DVec3; 4]) -> f64 {
        normals.map(|normal| normal.normalize_or_zero().dot(self.normal)).into_iter().fold(1.0, f64::min).max(0.0)
    }

    /// Height along the normal; the length where there is no normal.
    pub fn height(&self, difference: DVec3) -> f64 {
        if self.normal == DVec3::ZERO { difference.length() } else { difference.dot(self.normal) }
    }

    /// Length across the normal.
    pub fn sideways(&self, difference: DVec3) -> f64 {
        difference.cross(self.normal).length()
    }

    /// Stray of one difference: its height, and what its way sideways counts to either side.
    pub fn measure(&self, difference: DVec3) -> Stray {
        let (height, distance) = (self.height(difference), difference.length());
        let sideways = self.lean * self.sideways(difference);
        Stray { low: (height - sideways).min(0.0), high: (height + sideways).max(0.0), distance }
    }
}

impl Square {
    pub fn whole() -> Self {
        Self { at: [0.0; 2], size: 1.0 }
    }

    pub fn quarter(self, [i, j]: [f64; 2]) -> Self {
        let size = self.size / 2.0;
        Self { at: [self.at[0] + size * i, self.at[1] + size * j], size }
    }

    /// The bins that a square reaches along an axis.
    fn bins(self, axis: usize) -> std::ops::Range<usize> {
        let [start, end] = [self.at[axis], self.at[axis] + self.size].map(|t| t * BINS as f64);
        start.floor() as usize..(end.ceil() as usize).min(BINS)
    }

    /// How far triangles between the corners of the whole are above a bilinear surface, and how far below it, as parts of its twist.
    fn twists(self, is_upwards: bool) -> [f64; 2] {
        let [[x0, x1], [y0, y1]] = self.at.map(|start| [start, start + self.size]);
        // Cut along either diagonal.
        let [above, below] = [x1.min(y1) * (1.0 - x0.max(y0)), (x1 * y1).min((1.0 - x0) * (1.0 - y0))];
        if is_upwards { [above, below] } else { [below, above] }
    }

    /// Whether it touches the edge where the other axis than `axis` starts, and that where it ends.
    fn touches(self, axis: usize) -> [bool; 2] {
        let across = self.at[1 - axis];
        [across == 0.0, across + self.size == 1.0]
    }
}

impl Strays {
    /// Adds a B-spline patch, by its control points after it was split so often.
    pub fn add(&mut self, flat: &Bilinear, points: &[DVec3; 16], square: Square, splits: u32) {
        if splits > 0 {
            for (quarter, place) in quarters(points).iter().zip(PLACES) {
                self.add(flat, quarter, square.quarter(place), splits - 1);
            }
            return;
        }
        let Square { at, size } = square;
        let off: [DVec3; 16] = std::array::from_fn(|i| {
            let [u, v] = [i / 4, i % 4].map(|i| i as f64 - 1.0);
            points[i] - flat.at(at[0] + size * u, at[1] + size * v)
        });
        let stray = off.iter().map(|&off| flat.measure(off)).fold(Stray::default(), Stray::with);
        self.parts.push((square, stray));
        for axis in [0, 1] {
            for end in [0, 1].into_iter().filter(|&end| square.touches(axis)[end]) {
                // Control points of the curve on the edge.
                let on_edge = |i: usize| {
                    let across = |j: usize| if axis == 0 { off[4 * i + j] } else { off[4 * j + i] };
                    (across(end) + 4.0 * across(end + 1) + across(end + 2)) / 6.0
                };
                let stray = (0..4).map(|i| flat.measure(on_edge(i))).fold(Stray::default(), Stray::with);
                self.raise_edge(axis, square, stray);
            }
        }
    }

    /// Adds a part of which nothing else is known.
    pub fn add_whole(&mut self, square: Square, stray: Stray) {
        self.parts.push((square, stray));
        for axis in (0..2).filter(|&axis| square.touches(axis).contains(&true)) {
            self.raise_edge(axis, square, stray);
        }
    }

    fn raise_edge(&mut self, axis: usize, square: Square, stray: Stray) {
        for (side, most) in [stray.high, -stray.low].into_iter().enumerate() {
            self.edges[axis][side][square.bins(axis)].iter_mut().for_each(|bin| *bin = bin.max(most));
        }
    }

    pub fn distance(&self) -> f64 {
        self.parts.iter().map(|(_, stray)| stray.distance).fold(0.0, f64::max)
    }

    /// How far the surface is along the normal from triangles between the corners, cut along either diagonal, of a bilinear surface with
    /// such a twist: along the normal, and what it has sideways.
    pub fn height(&self, [twist, sideways]: [f64; 2]) -> f64 {
        let of_part = |&(square, stray): &(Square, Stray)| {
            let [part_above, part_below] = square.twists(twist >= 0.0);
            let [above, below] = [part_above, part_below].map(|part| part * twist.abs());
            (above - stray.low).max(below + stray.high) + sideways * part_above.max(part_below)
        };
        self.parts.iter().map(of_part).fold(0.0, f64::max)
    }

    /// Likewise from triangles whose corners are on the surface anywhere along the edges.
    ///
    /// What is between such corners is, at most, what a concave function is there that is nowhere below them. Here that is the sum of
    /// one along u and one along v.
    pub fn height_beside_finer(&self, [twist, sideways]: [f64; 2]) -> f64 {
        let of_side = |side: usize| {
            let bounds = [0, 1].map(|axis| concave(&self.edges[axis][side]));
            let of_part = |&(square, stray): &(Square, Stray)| {
                let along = |axis: usize| {
                    let bins = square.bins(axis);
                    bounds[axis][bins.start..=bins.end].iter().copied().fold(0.0, f64::max)
                };
                along(0) + along(1) + [-stray.low, stray.high][side]
            };
            self.parts.iter().map(of_part).fold(0.0, f64::max)
        };
        of_side(0).max(of_side(1)) + (twist.abs() + sideways) / 4.0
    }
}

/// A concave function that is nowhere below the bins, where these start and end.
fn concave(bins: &[f64; BINS]) -> [f64; BINS + 1] {
    let at: [f64; BINS + 1] = std::array::from_fn(|i| {
        let [before, after] = [i.checked_sub(1), Some(i)].map(|bin| bin.and_then(|bin| bins.get(bin)).copied());
        before.unwrap_or(0.0).max(after.unwrap_or(0.0))
    });
    // The upper hull.
    let mut hull: Vec<usize> = Vec::new();
    for i in 0..=BINS {
        while let &[.., a, b] = &hull[..]
            && (at[b] - at[a]) * ((i - a) as f64) <= (at[i] - at[a]) * ((b - a) as f64)
        {
            hull.pop();
        }
        hull.push(i);
    }
    let mut values = at;
    for pair in hull.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let slope = (at[b] - at[a]) / (b - a) as f64;
        (a..=b).for_each(|i| values[i] = at[a] + slope * (i - a) as f64);
    }
    values
}
