//! Pm-patches for triangles, quads and pentagons: Myles, Ni and Peters, *Fast Parallel Construction of Smooth Surfaces from Meshes with
//! Tri/Quad/Pent Facets* (2008), and c-patches, which are those of quads: Ni, Yeo, Myles, Goel and Peters, *GPU smoothing of
//! quad meshes* (2008). As corrected in patch_maths D and E; the centre of a pentagon is ours (patch_maths D).
//!
//! A face of m corners is m triangular pieces of degree four around its centre, C1 inside and G1 across the edges of the
//! face; sector i lies between corners i and i + 1. 6 m control points: the corners `v_0..`; the edge points `t_0+, t_0-,
//! t_1+, ..`; then for each sector its inner points `b211_i` (near corner i), then all `b121_i` (near corner i + 1), then all
//! `b112_i` (near the centre). Everything else follows from them.
//!
//! A patch is a whole face, or one sector of a pentagon: the first, where the corners begin with those of the sector.
//!
//! There is no rule at boundaries, creases and corners.

use super::gregory::edge_name;
use crate::blend::{Blend, Frame, PatchCorner, Point, RingValues, Sample, scalar, tangent_scale, unit_normal};
use crate::topology::RingKind;
use std::f64::consts::TAU;

/// Where the points that corner k of n owns stand: `v`, `t+`, `t-`, `b211_k`, `b121_{k-1}` and `b112_k`.
pub fn corner_slots(n: usize, k: usize) -> [usize; 6] {
    [k, n + 2 * k, n + 2 * k + 1, 3 * n + k, 4 * n + (k + n - 1) % n, 5 * n + k]
}

/// The name of a control point of a patch with `n` corners.
pub(super) fn point_name(n: usize, number: usize) -> String {
    match number {
        k if k < n => format!("v{k}"),
        k if k < 3 * n => format!("t{}", edge_name(k - n)),
        k => format!("{}_{}", ["b211", "b121", "b112"][k / n - 3], k % n),
    }
}

/// The corner point and the frame of the edge points t. For rings without a rule, the frame of Gregory patches, which
/// regular faces have.
pub fn pm_frame<T: Blend>(ring: &RingValues<T>) -> Frame<T> {
    if ring.shape.kind != RingKind::Smooth {
        return ring.frame();
    }
    let faces = ring.shape.faces();
    let n = faces as f64;
    let mut frame = Frame { p: T::sum([(n / (n + 5.0), &ring.centre)]), ..Frame::default() };
    let scale = 1.0 / (n * tangent_scale(faces));
    for l in 0..faces {
        frame.p.add_scaled(4.0 / (n * (n + 5.0)), &ring.edges[l]);
        frame.p.add_scaled(1.0 / (n * (n + 5.0)), &ring.pm_diagonal(l));
        let e = ring.pm_edge(l);
        let [cos, sin] = ring.shape.edge_direction(l);
        frame.a.add_scaled(scale * cos, &e);
        frame.b.add_scaled(scale * sin, &e);
    }
    frame
}

impl<T: Blend> RingValues<T> {
    /// The vertex opposite in face i; of a triangle and a pentagon the middle of the far edge.
    fn pm_diagonal(&self, i: usize) -> T {
        if self.shape.triangles[i] {
            T::sum([(0.5, &self.edges[i]), (0.5, &self.edges[(i + 1) % self.edges.len()])])
        } else {
            self.diagonals[i].clone()
        }
    }

    /// f_i, the inner Bezier point of face i at this vertex, were it inside a B-spline.
    fn pm_face(&self, i: usize) -> T {
        let i = i % self.shape.faces();
        let next = &self.edges[(i + 1) % self.edges.len()];
        T::sum([
            (4.0 / 9.0, &self.centre),
            (2.0 / 9.0, &self.edges[i]),
            (2.0 / 9.0, next),
            (1.0 / 9.0, &self.pm_diagonal(i)),
        ])
    }

    /// e_j, between the faces on both sides of edge j.
    fn pm_edge(&self, j: usize) -> T {
        let faces = self.shape.faces();
        T::sum([(0.5, &self.pm_face(j)), (0.5, &self.pm_face(j + faces - 1))])
    }
}

/// `1 - cos(2 pi / m)`.
fn mu(m: usize) -> f64 {
    match m {
        3 => 1.5,
        4 => 1.0,
        _ => 1.0 - (TAU / m as f64).cos(),
    }
}

/// b202, the point of a spoke beside b211 and b121: C1 across the spoke, as is b301 beside the two b310.
fn pm_b202<T: Blend>(m: usize, v: &T, [plus, minus]: &[T; 2], b211: &T, b121_before: &T) -> T {
    let (c, across) = (1.0 - mu(m), 1.0 / (2.0 * mu(m)));
    let b301 = T::sum([(across * (0.5 - 2.0 * c), v), (0.75 * across, plus), (0.75 * across, minus)]);
    T::sum([(across, b211), (across, b121_before), (-2.0 * c * across, &b301)])
}

/// The points b112 of a pentagon with this centre.
///
/// Their sums over neighbours give the points b103 of the spokes, which have to be an affine image of a regular pentagon for
/// C1 at the centre. Which one is free: it is the one with the least jump of second derivatives across the spokes.
fn pm_centre_of_pentagon<T: Blend>(centre: &T, b202: &[T], b211: &[T], b121: &[T]) -> Vec<T> {
    let m = 5;
    let (mu, theta) = (mu(m), TAU / m as f64);
    let c = 1.0 - mu;
    // b112_i + b112_{i-1}
    let sum = |i: usize| {
        let mut sum = T::sum([(2.0 * mu, centre), (2.0 * c, &b202[i])]);
        for j in 0..m {
            let (sin, cos) = (theta * ((i + m - j) % m) as f64).sin_cos();
            let turn = sin / (5.0 * mu * (0.5 * theta).tan());
            let before = (j + m - 1) % m;
            sum.add_scaled(-0.8 * c * cos, &b202[j]);
            sum.add_scaled(turn, &b121[j]);
            sum.add_scaled(-turn, &b211[before]);
            sum.add_scaled(2.0 * c * turn, &b121[before]);
            sum.add_scaled(-2.0 * c * turn, &b211[j]);
        }
        sum
    };
    let sums: Vec<T> = (0..m).map(sum).collect();
    let of = |i: usize| {
        let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|step| &sums[(i + step) % m]);
        T::sum([(0.5, a), (0.5, b), (-0.5, c), (0.5, d), (-0.5, e)])
    };
    (0..m).map(of).collect()
}

/// The control points of the face with these three, four or five corners, whose frames are [`pm_frame`]s.
///
/// GLSL twin: `glsl/schemes/pm/scheme_points.glsl`.
pub fn pm_points<T: Blend>(corners: &[PatchCorner<T>]) -> Vec<T> {
    let m = corners.len();
    let mu = mu(m);
    let angles: Vec<[f64; 2]> = corners.iter().map(|c| c.ring.shape.edge_direction(1)).collect();
    let v: Vec<&T> = corners.iter().map(|c| &c.frame.p).collect();
    let t: Vec<[T; 2]> = corners.iter().map(|c| [c.plus(), c.minus()]).collect();
    let f: Vec<T> = corners.iter().map(|c| c.ring.pm_face(c.index)).collect();
    let e: Vec<[T; 2]> = corners.iter().map(|c| [c.ring.pm_edge(c.index), c.ring.pm_edge(c.minus_index())]).collect();
    // b211 at the near end of an edge, or b121 at its far end, seen from there.
    let beside = |near: usize, far: usize, side: usize| {
        let ([cos_near, sin_near], [cos_far, sin_far]) = (angles[near], angles[far]);
        let (t0, t1) = (&t[near][side], &t[far][1 - side]);
        let (along, out) = ((1.0 + cos_near) / (4.0 * mu), (2.0 * mu - 1.0 - cos_far) / (8.0 * mu));
        let across = 3.0 / (4.0 * mu * (sin_near + sin_far));
        T::sum([
            (0.25 - out, v[near]),
            (0.75 - along + out, t0),
            (along, t1),
            (across, &f[near]),
            (-across, &e[near][side]),
        ])
    };
    let b211: Vec<T> = (0..m).map(|i| beside(i, (i + 1) % m, 0)).collect();
    let b121: Vec<T> = (0..m).map(|i| beside((i + 1) % m, i, 1)).collect();
    let mut centre = T::default();
    let own = if m == 3 { 2.0 } else { 1.0 };
    let all = m as f64 * (15.0 + own);
    for k in 0..m {
        centre.add_scaled(own / all, v[k]);
        centre.add_scaled(3.0 / all, &e[k][0]);
        centre.add_scaled(3.0 / all, &e[k][1]);
        centre.add_scaled(9.0 / all, &f[k]);
    }
    let b112: Vec<T> = if m == 5 {
        let b202 = |k: usize| pm_b202(m, v[k], &t[k], &b211[k], &b121[(k + m - 1) % m]);
        pm_centre_of_pentagon(&centre, &(0..m).map(b202).collect::<Vec<_>>(), &b211, &b121)
    } else {
        (0..m).map(|i| pm_inner(i, &centre, &v, &t, &b211, &b121)).collect()
    };
    v.into_iter().cloned().chain(t.into_iter().flatten()).chain(b211).chain(b121).chain(b112).collect()
}

/// The point b112 of sector `i` of a triangle or a quad, from the centre, the corners `v`, their tangent points `t`, and b211 and b121.
fn pm_inner<T: Blend>(i: usize, centre: &T, v: &[&T], t: &[[T; 2]], b211: &[T], b121: &[T]) -> T {
    let m = v.len();
    let (next, before) = ((i + 1) % m, (i + m - 1) % m);
    if m == 3 {
        // `before` is the corner opposite the sector.
        return T::sum([
            (1.5, centre),
            (-1.0 / 12.0, v[before]),
            (-1.0 / 24.0, &t[before][0]),
            (-1.0 / 24.0, &t[before][1]),
            (-1.0 / 6.0, &b211[before]),
            (-1.0 / 6.0, &b121[next]),
        ]);
    }
    let opposite = (i + 2) % m;
    T::sum([
        (1.0, centre),
        (3.0 / 16.0, &b211[i]),
        (3.0 / 16.0, &b121[i]),
        (-3.0 / 16.0, &b121[next]),
        (-3.0 / 16.0, &b211[before]),
        (1.0 / 16.0, &b211[next]),
        (1.0 / 16.0, &b121[before]),
        (-1.0 / 16.0, &b121[opposite]),
        (-1.0 / 16.0, &b211[opposite]),
    ])
}

/// A quad at (u, v).
///
/// GLSL twin: `glsl/schemes/pm/evaluate_pm_quad.glsl`.
pub fn evaluate_pm_quad<P: Point>(points: &[P; 24], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    let [one, two] = [1.0, 2.0].map(scalar::<P>);
    let (sector, [x, y, z]) = match (v <= u, u + v <= one) {
        (true, true) => (0, [one - u - v, u - v, two * v]),
        (true, false) => (1, [u - v, u + v - one, two - two * u]),
        (false, false) => (2, [u + v - one, v - u, two - two * v]),
        (false, true) => (3, [v - u, one - u - v, two * u]),
    };
    evaluate_sector(points, sector, x, y, z)
}

/// A triangle at barycentric (u, v, 1 - u - v).
///
/// GLSL twin: `glsl/schemes/pm/evaluate_pm_triangle.glsl`.
pub fn evaluate_pm_triangle<P: Point>(points: &[P; 18], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    let [one, three] = [1.0, 3.0].map(scalar::<P>);
    let w = one - u - v;
    // A sector is where its opposite corner's coordinate is the least.
    if w <= u && w <= v {
        evaluate_sector(points, 0, u - w, v - w, three * w)
    } else if u <= v {
        evaluate_sector(points, 1, v - u, w - u, three * u)
    } else {
        evaluate_sector(points, 2, w - v, u - v, three * v)
    }
}

/// The first sector of a pentagon at barycentric (u, v, 1 - u - v): u = 1 at corner 0, v = 1 at corner 1, w = 1 at the
/// centre.
///
/// GLSL twin: `glsl/schemes/pm/evaluate_pm_pentagon.glsl`.
pub fn evaluate_pm_pentagon<P: Point>(points: &[P; 30], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    evaluate_sector(points, 0, u, v, scalar::<P>(1.0) - u - v)
}

/// Sector i at barycentric (x, y, z): x = 1 at corner i, y = 1 at corner i + 1, z = 1 at the centre.
fn evaluate_sector<P: Point>(points: &[P], i: usize, x: P::Scalar, y: P::Scalar, z: P::Scalar) -> Sample<P> {
    let m = points.len() / 6;
    let c = scalar::<P>(1.0 - mu(m));
    let [half, quarter, three, four, two] = [0.5, 0.25, 3.0, 4.0, 2.0].map(scalar::<P>);
    let inverse = scalar::<P>(1.0 / (2.0 * mu(m)));
    let point = |k: usize| corner_slots(m, k).map(|slot| points[slot]);
    let b310 = |k: usize, side: usize| (point(k)[0] + point(k)[side] * three) * quarter;
    // The spoke from corner k to the centre: C1 across it, between the points of the sectors on both sides.
    let across = |left: P, right: P, spoke: P| (left + right - spoke * (two * c)) * inverse;
    let b301 = |k: usize| across(b310(k, 1), b310(k, 2), point(k)[0]);
    let b202 = |k: usize| across(point(k)[3], point(k)[4], b301(k));
    let b103 = |k: usize| across(point(k)[5], point((k + m - 1) % m)[5], b202(k));
    let mut centre = P::default();
    for k in 0..m {
        centre = centre + b103(k) * scalar::<P>(1.0 / m as f64);
    }
    let j = (i + 1) % m;
    // Rows from the edge to the centre: the Bezier points of each row from corner i to corner j.
    let rows = [
        vec![point(i)[0], b310(i, 1), (point(i)[1] + point(j)[2]) * half, b310(j, 2), point(j)[0]],
        vec![b301(i), point(i)[3], point(j)[4], b301(j)],
        vec![b202(i), point(i)[5], b202(j)],
        vec![b103(i), b103(j)],
        vec![centre],
    ];
    let (position, dx, dy) = de_casteljau(rows, x, y, z, four);
    let chords = (point(j)[0] - point(i)[0]).cross(centre - point(i)[0]);
    Sample { position, normal: unit_normal(dx, dy, chords) }
}

/// A quartic triangle and its derivatives from the centre towards the two corners. `rows[r][s]` is the point with exponents
/// (4 - r - s, s, r).
fn de_casteljau<P: Point>(
    mut rows: [Vec<P>; 5],
    x: P::Scalar,
    y: P::Scalar,
    z: P::Scalar,
    degree: P::Scalar,
) -> (P, P, P) {
    for level in (1..4).rev() {
        for r in 0..=level {
            for s in 0..=level - r {
                rows[r][s] = (rows[r][s] * x + rows[r][s + 1] * y) + rows[r + 1][s] * z;
            }
        }
    }
    let [a, b, c] = [rows[0][0], rows[0][1], rows[1][0]];
    ((a * x + b * y) + c * z, (a - c) * degree, (b - c) * degree)
}
