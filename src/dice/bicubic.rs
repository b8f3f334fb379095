//! Bicubic B-spline patches at the points of a grid: where most vertices of a tessellation come from.

use super::real::{Real, Vector};

/// Points of a row that are computed side by side.
const LANES: usize = 4;

type Lanes<T> = [T; LANES];

/// The cubic B-spline basis and its slopes at the `2^depth + 1` points of a grid line.
pub(super) struct Basis<T> {
    /// Points of the line.
    len: usize,
    /// By group of points: the four weights.
    values: Vec<[Lanes<T>; 4]>,
    /// By group of points: the slopes of the four weights.
    slopes: Vec<[Lanes<T>; 4]>,
}

/// The weights of four B-spline control points at `t`, and their slopes.
fn weights(t: f64) -> [[f64; 4]; 2] {
    let s = 1.0 - t;
    let (t2, s2) = (t * t, s * s);
    [
        [s2 * s / 6.0, (4.0 - 6.0 * t2 + 3.0 * t2 * t) / 6.0, (4.0 - 6.0 * s2 + 3.0 * s2 * s) / 6.0, t2 * t / 6.0],
        [-s2 / 2.0, (3.0 * t - 4.0) * t / 2.0, (4.0 - 3.0 * s) * s / 2.0, t2 / 2.0],
    ]
}

impl<T: Real> Basis<T> {
    pub(super) fn new(depth: u32) -> Self {
        let segments = 1usize << depth;
        let groups = (segments + 1).div_ceil(LANES);
        let zero = [[T::zero(); LANES]; 4];
        let mut basis = Self { len: segments + 1, values: vec![zero; groups], slopes: vec![zero; groups] };
        for point in 0..=segments {
            let [values, slopes] = weights(point as f64 / segments as f64);
            for i in 0..4 {
                basis.values[point / LANES][i][point % LANES] = T::of(values[i]);
                basis.slopes[point / LANES][i][point % LANES] = T::of(slopes[i]);
            }
        }
        basis
    }

    #[inline(always)]
    fn at(groups: &[[Lanes<T>; 4]], point: usize) -> [T; 4] {
        let (group, lane) = (&groups[point / LANES], point % LANES);
        [group[0][lane], group[1][lane], group[2][lane], group[3][lane]]
    }
}

/// The control points of a patch, in the order in which rows of them are summed: by index along v the four along u, coordinate by
/// coordinate.
pub(super) struct Net<T> {
    rows: [[T; 12]; 4],
    /// Added to positions.
    base: Vector<T>,
    /// One over the square of the net's size.
    shrink: T,
}

impl<T: Real> Net<T> {
    /// Of points relative to `origin`; number `4 i + j` has index i along u and j along v.
    #[inline(always)]
    pub(super) fn new(points: impl Fn(usize) -> Vector<T>, origin: Vector<f64>) -> Self {
        let mut rows = [[T::zero(); 12]; 4];
        for i in 0..4 {
            for (j, row) in rows.iter_mut().enumerate() {
                let [x, y, z] = points(4 * i + j);
                (row[i], row[4 + i], row[8 + i]) = (x, y, z);
            }
        }
        let mut largest = [T::zero(); 12];
        for row in &rows {
            for (largest, x) in largest.iter_mut().zip(row) {
                *largest = if x.abs() > *largest { x.abs() } else { *largest };
            }
        }
        let size = largest.into_iter().fold(T::min_positive_value().sqrt(), |a, b| if a > b { a } else { b });
        let mut base = [T::zero(); 3];
        for axis in 0..3 {
            base[axis] = T::of(origin[axis]);
            // What rounding the origin takes off.
            let rest = T::of(origin[axis] - base[axis].wide());
            rows.iter_mut().flat_map(|row| &mut row[4 * axis..4 * axis + 4]).for_each(|x| *x = *x + rest);
        }
        Self { rows, base, shrink: (size * size).recip() }
    }
}

/// Where the points of a patch go in a grid.
pub(super) struct Window<'g, T> {
    pub positions: &'g mut [Vector<T>],
    /// Of length one, or zero where the tangents are parallel. Empty if nobody asks for them.
    pub normals: &'g mut [Vector<T>],
    /// From the first point to the second row's.
    pub stride: usize,
}

#[inline(always)]
fn sum<T: Real>(weights: [T; 4], rows: &[[T; 12]; 4]) -> [T; 12] {
    let mut sum = [T::zero(); 12];
    for (k, sum) in sum.iter_mut().enumerate() {
        *sum =
            (weights[0] * rows[0][k] + weights[1] * rows[1][k]) + (weights[2] * rows[2][k] + weights[3] * rows[3][k]);
    }
    sum
}

#[inline(always)]
fn along<T: Real>(weights: &[Lanes<T>; 4], points: &[T; 12], axis: usize) -> Lanes<T> {
    let [a, b, c, d] = [points[4 * axis], points[4 * axis + 1], points[4 * axis + 2], points[4 * axis + 3]];
    let mut sum = [T::zero(); LANES];
    for (l, sum) in sum.iter_mut().enumerate() {
        *sum = (weights[0][l] * a + weights[1][l] * b) + (weights[2][l] * c + weights[3][l] * d);
    }
    sum
}

/// The points of a group, each with its coordinates beside each other.
#[inline(always)]
fn write<T: Real>(out: &mut [Vector<T>], [x, y, z]: [Lanes<T>; 3]) {
    if let Ok(out) = <&mut [Vector<T>; LANES]>::try_from(&mut *out) {
        for l in 0..LANES {
            out[l] = [x[l], y[l], z[l]];
        }
    } else {
        out.iter_mut().enumerate().for_each(|(l, out)| *out = [x[l], y[l], z[l]]);
    }
}

/// Evaluates a patch at the points of a basis.
pub(super) fn evaluate<T: Real>(net: &Net<T>, basis: &Basis<T>, window: Window<'_, T>) {
    for j in 0..basis.len {
        let points = sum(Basis::at(&basis.values, j), &net.rows);
        let start = j * window.stride;
        let positions = &mut window.positions[start..start + basis.len];
        for (values, out) in basis.values.iter().zip(positions.chunks_mut(LANES)) {
            let mut p = [[T::zero(); LANES]; 3];
            for (axis, p) in p.iter_mut().enumerate() {
                *p = along(values, &points, axis);
                p.iter_mut().for_each(|x| *x = *x + net.base[axis]);
            }
            write(out, p);
        }
        if window.normals.is_empty() {
            continue;
        }
        // Scaled, so that the squared length of the cross product is of the order of one.
        let mut across = sum(Basis::at(&basis.slopes, j), &net.rows);
        across.iter_mut().for_each(|x| *x = *x * net.shrink);
        let normals = &mut window.normals[start..start + basis.len];
        for ((values, slopes), out) in basis.values.iter().zip(&basis.slopes).zip(normals.chunks_mut(LANES)) {
            write(out, unit_normals(values, slopes, &points, &across));
        }
    }
}

#[inline(always)]
fn unit_normals<T: Real>(
    values: &[Lanes<T>; 4],
    slopes: &[Lanes<T>; 4],
    points: &[T; 12],
    across: &[T; 12],
) -> [Lanes<T>; 3] {
    let u = [along(slopes, points, 0), along(slopes, points, 1), along(slopes, points, 2)];
    let v = [along(values, across, 0), along(values, across, 1), along(values, across, 2)];
    let mut n = [[T::zero(); LANES]; 3];
    for l in 0..LANES {
        n[0][l] = u[1][l] * v[2][l] - u[2][l] * v[1][l];
        n[1][l] = u[2][l] * v[0][l] - u[0][l] * v[2][l];
        n[2][l] = u[0][l] * v[1][l] - u[1][l] * v[0][l];
    }
    for l in 0..LANES {
        let squared = (n[0][l] * n[0][l] + n[1][l] * n[1][l]) + n[2][l] * n[2][l];
        // Where the tangents are parallel nothing is left but zero.
        let scale = if squared > T::min_positive_value() { squared.sqrt().recip() } else { T::zero() };
        for n in &mut n {
            n[l] = n[l] * scale;
        }
    }
    n
}
