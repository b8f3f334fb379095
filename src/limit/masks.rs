//! The limit at a vertex: the left eigenvectors of the subdivision matrix of its one-ring (patch_maths A).

use super::sample::LimitSample;
use crate::blend::{Blend, Frame, RingValues};
use crate::topology::{Ring, RingKind, Topology};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// The limit at the corner of a face, as sums of the vertices around it.
pub(crate) struct CornerMasks<T> {
    pub position: T,
    /// Tangents along the two edges of the face, the plus edge first.
    pub edges: [T; 2],
    /// The normal is along their cross product; `None` where there is no tangent plane.
    pub plane: Option<[T; 2]>,
}

/// The masks at the corner of a face, `vertex(v)` being the value at mesh vertex `v`.
///
/// Nothing at the vertex may be semi-sharp, and the faces around it must be quads.
pub(crate) fn corner_masks<T: Blend>(topology: &Topology, half_edge: u32, vertex: impl Fn(u32) -> T) -> CornerMasks<T> {
    let place = topology.place(half_edge);
    let ring = &topology.rings()[place.ring as usize];
    let j = place.index as usize;
    let values = RingValues::new(topology, ring, vertex);
    let mut frame = values.frame();
    if let Some(sharp) = dart_edge(topology, ring) {
        frame = dart_frame(&values, sharp);
    } else if ring.kind == RingKind::Crease && ring.faces >= 3 {
        frame.b = cross_tangent(&values);
    }
    let tangent = |j| T::sum([(3.0, &values.edge_vector(&frame, j))]);
    let edges = [tangent(j), tangent(j + 1)];
    let plane = match (ring.kind, ring.faces) {
        // The tangents need not span the plane: at a smooth boundary around one face they are parallel.
        (RingKind::Smooth, 3..) | (RingKind::Crease, _) => Some([frame.a.clone(), frame.b.clone()]),
        // Two faces inside the surface: no tangent plane.
        (RingKind::Smooth, _) => None,
        (RingKind::Corner, _) => Some(edges.clone()),
    };
    CornerMasks { position: frame.p, edges, plane }
}

/// Position, tangents along the two edges of the face, and normal at the corner of a face.
///
/// As for [`corner_masks`].
pub(super) fn corner_limit(topology: &Topology, half_edge: u32) -> LimitSample {
    let CornerMasks { position, edges: [du, dv], plane } =
        corner_masks(topology, half_edge, |v| topology.mesh().position(v));
    let normal = plane.map_or(DVec3::ZERO, |[a, b]| a.cross(b));
    LimitSample { position, du, dv, normal: normal.normalize_or_zero() }
}

/// The sharp edge of a dart.
pub(crate) fn dart_edge(topology: &Topology, ring: &Ring) -> Option<usize> {
    if ring.kind != RingKind::Smooth {
        return None;
    }
    topology.ring_half_edges(ring).position(|h| topology.is_sharp(h))
}

/// The exact tangent across a crease with three or more faces on this side, where Biermann et al.'s is that of another rule.
fn cross_tangent<T: Blend>(values: &RingValues<T>) -> T {
    let faces = values.diagonals.len();
    let turn = PI / faces as f64;
    let (cos, cos_half) = (turn.cos(), (turn / 2.0).cos());
    let lambda = (5.0 + cos + cos_half * (18.0 + 2.0 * cos).sqrt()) / 16.0;
    let scale = 1.0 + cos + cos_half * (18.0 + 2.0 * cos).sqrt();
    let sin = |j: usize| (j as f64 * turn).sin();
    let at_edge = |j| scale * sin(j);
    let at_diagonal = |i| sin(i) + sin(i + 1);
    let sum = (1..faces).map(at_edge).sum::<f64>() + (0..faces).map(at_diagonal).sum::<f64>();
    let at_end = (at_diagonal(0) / 4.0 + at_edge(1) / 16.0 - sum / 8.0) / (lambda - 0.25);
    let weight = 1.0 / (9.0 * faces as f64);
    let mut tangent = T::sum([
        (-(2.0 * at_end + sum) * weight, &values.centre),
        (at_end * weight, &values.edges[0]),
        (at_end * weight, &values.edges[faces]),
    ]);
    for j in 1..faces {
        tangent.add_scaled(at_edge(j) * weight, &values.edges[j]);
    }
    for i in 0..faces {
        tangent.add_scaled(at_diagonal(i) * weight, &values.diagonals[i]);
    }
    tangent
}

/// Limit and tangents at the end of a single sharp edge: `a` along the sharp edge, `b` to its left.
///
/// No closed form is known; the masks are found by iteration. Being symmetric to the sharp edge, the ring has its
/// tangent across the edge among the masks that change sign under reflection, and the other among those that do not.
pub(crate) fn dart_frame<T: Blend>(values: &RingValues<T>, sharp: usize) -> Frame<T> {
    let n = values.edges.len();
    let points: Vec<&T> = std::iter::once(&values.centre)
        .chain((0..n).map(|j| &values.edges[(sharp + j) % n]))
        .chain((0..n).map(|i| &values.diagonals[(sharp + i) % n]))
        .collect();
    let matrix = dart_matrix(n);
    let directions = |direction: fn(f64) -> f64| -> Vec<f64> {
        let of_edges = (0..n).map(|j| direction(TAU * j as f64 / n as f64));
        let of_faces = (0..n).map(|i| direction(TAU * (i as f64 + 0.5) / n as f64));
        std::iter::once(0.0).chain(of_edges).chain(of_faces).collect()
    };
    let combine = |mask: Vec<f64>| T::sum(mask.into_iter().zip(points.iter().copied()));
    let mut position = vec![0.0; 2 * n + 1];
    position[0] = 1.0;
    let position = combine(dominant(&matrix, position, |_| {}));
    // Masks of tangents sum to zero: the limit of a constant is no tangent.
    let without_mean = |mask: &mut [f64]| {
        let mean = mask.iter().sum::<f64>() / mask.len() as f64;
        mask.iter_mut().for_each(|w| *w -= mean);
    };
    let along = combine(dominant(&matrix, directions(f64::cos), without_mean));
    let odd = |mask: &mut [f64]| {
        for i in 0..n {
            let (j, k) = (1 + i, 1 + (n - i) % n);
            let (d, e) = (1 + n + i, 2 * n - i);
            (mask[j], mask[k]) = (0.5 * (mask[j] - mask[k]), 0.5 * (mask[k] - mask[j]));
            (mask[d], mask[e]) = (0.5 * (mask[d] - mask[e]), 0.5 * (mask[e] - mask[d]));
        }
        mask[0] = 0.0;
    };
    let across = combine(dominant(&matrix, directions(f64::sin), odd));
    // The edges stand at multiples of a full turn / n from edge 0 of the ring, not from the sharp one.
    let (sin, cos) = (TAU * sharp as f64 / n as f64).sin_cos();
    let turned = |cos: f64, sin: f64| T::sum([(cos, &along), (sin, &across)]);
    Frame { p: position, a: turned(cos, -sin), b: turned(sin, cos) }
}

/// One subdivision step of a ring of `n` quads whose edge 0 is infinitely sharp. Rows and columns: the vertex, the
/// edge neighbours, the diagonals.
fn dart_matrix(n: usize) -> Vec<Vec<f64>> {
    let edge = |j: usize| 1 + j % n;
    let diagonal = |i: usize| 1 + n + i % n;
    let mut matrix = vec![vec![0.0; 2 * n + 1]; 2 * n + 1];
    let add_face_point = |row: &mut [f64], weight: f64, i: usize| {
        for column in [0, edge(i), edge(i + 1), diagonal(i)] {
            row[column] += 0.25 * weight;
        }
    };
    let count = n as f64;
    matrix[0][0] = (count - 2.0) / count;
    for i in 0..n {
        matrix[0][edge(i)] += 1.0 / (count * count);
        add_face_point(&mut matrix[0], 1.0 / (count * count), i);
        add_face_point(&mut matrix[diagonal(i)], 1.0, i);
        let row = &mut matrix[edge(i)];
        let of_ends = if i == 0 { 0.5 } else { 0.25 };
        row[0] += of_ends;
        row[edge(i)] += of_ends;
        if i > 0 {
            add_face_point(row, 0.25, i);
            add_face_point(row, 0.25, i + n - 1);
        }
    }
    matrix
}

/// The left eigenvector of the largest eigenvalue among those that `project` keeps. Its weights add up to one in
/// absolute value.
fn dominant(matrix: &[Vec<f64>], mut mask: Vec<f64>, project: impl Fn(&mut [f64])) -> Vec<f64> {
    // The ratios of neighbouring eigenvalues are below 0.9 in rings of any size met in practice.
    for _ in 0..400 {
        let mut next = vec![0.0; mask.len()];
        for (weight, row) in mask.iter().zip(matrix) {
            for (next, &entry) in next.iter_mut().zip(row) {
                *next += weight * entry;
            }
        }
        project(&mut next);
        let sum: f64 = next.iter().map(|w| w.abs()).sum();
        next.iter_mut().for_each(|w| *w /= sum);
        let change: f64 = next.iter().zip(&mask).map(|(a, b)| (a - b).abs()).sum();
        mask = next;
        if change < 1e-16 {
            break;
        }
    }
    mask
}
