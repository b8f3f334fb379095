//! Gregory patches: Loop, Schaefer, Ni and Castano, *Approximating Subdivision Surfaces with Gregory Patches for
//! Hardware Tessellation* (2009), as corrected in patch_maths B.
//!
//! A quad has 20 control points, a triangle 15, in this order: the corners `p_0..`, then the edge points `e_0+, e_0-,
//! e_1+, e_1-, ..`, then the face points `f_0+, f_0-, ..`. `e_k+` and `f_k+` belong to the edge from corner k to
//! corner k + 1, `e_k-` and `f_k-` to the edge from corner k to corner k - 1.

use crate::blend::{
    Blend, CurveBasis, PatchCorner, Point, Sample, TensorCorner, curve_point, evaluate_tensor, scalar, seen_from_ends,
    tensor_derivatives, unit_normal,
};

/// The control points of the patch with these corners: 20 for four, 15 for three.
///
/// `transversal` gives `r_j` of a corner's ring edge j; that of the paper is [`RingValues::transversal`](super::RingValues::transversal). The patches on
/// both sides of an edge have to be given the same.
///
/// GLSL twin: `glsl/schemes/gregory/scheme_points.glsl`.
pub fn gregory_points<T: Blend>(
    corners: &[PatchCorner<T>],
    transversal: impl Fn(&PatchCorner<T>, usize) -> T,
) -> Vec<T> {
    let n = corners.len();
    // The d of section 3.4: three times the degree ratio between the patch and its edge curves.
    let d = if n == 4 { 3.0 } else { 4.0 };
    let plus: Vec<T> = corners.iter().map(PatchCorner::plus).collect();
    let minus: Vec<T> = corners.iter().map(PatchCorner::minus).collect();
    let cosines: Vec<f64> = corners.iter().map(|c| c.ring.shape.cosine()).collect();
    let mut points: Vec<T> = corners.iter().map(|c| c.frame.p.clone()).collect();
    for k in 0..n {
        points.push(plus[k].clone());
        points.push(minus[k].clone());
    }
    for (k, corner) in corners.iter().enumerate() {
        let (next, before) = ((k + 1) % n, (k + n - 1) % n);
        let face_point = |far: usize, near_edge: &T, far_edge: &T, side: f64, edge: usize| {
            T::sum([
                (cosines[far] / d, &corner.frame.p),
                ((d - 2.0 * cosines[k] - cosines[far]) / d, near_edge),
                (2.0 * cosines[k] / d, far_edge),
                (side / d, &transversal(corner, edge)),
            ])
        };
        points.push(face_point(next, &plus[k], &minus[next], 1.0, corner.index));
        // The face lies on the right of its minus edge.
        points.push(face_point(before, &minus[k], &plus[before], -1.0, corner.minus_index()));
    }
    points
}

/// The name of a control point of a patch with `n` corners.
pub(super) fn point_name(n: usize, number: usize) -> String {
    match number {
        k if k < n => format!("p{k}"),
        k if k < 3 * n => format!("e{}", edge_name(k - n)),
        k => format!("f{}", edge_name(k - 3 * n)),
    }
}

/// The name of an edge's end: corner and side.
pub(super) fn edge_name(number: usize) -> String {
    format!("{}{}", number / 2, if number.is_multiple_of(2) { '+' } else { '-' })
}

/// A quad patch at (u, v), with the de Casteljau normal of section 3.5: the derivative that takes the blended face points
/// as constant. It is exact on the boundary, and inside closer to Catmull-Clark than the true one.
///
/// GLSL twin: `glsl/schemes/gregory/evaluate_gregory_quad.glsl`.
pub fn evaluate_gregory_quad<P: Point>(points: &[P; 20], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    evaluate_tensor(&quad_corners(points, u, v), u, v)
}

/// Position and derivatives by u and v of [`evaluate_gregory_quad`].
pub(crate) fn gregory_quad_derivatives<P: Point>(points: &[P; 20], u: P::Scalar, v: P::Scalar) -> [P; 3] {
    let [position, du, dv] = tensor_derivatives(&quad_corners(points, u, v), u, v);
    let three = scalar::<P>(3.0);
    [position, du * three, dv * three]
}

/// The tensor-product patch that a quad patch is at (u, v), with its face points blended.
fn quad_corners<P: Point>(points: &[P; 20], u: P::Scalar, v: P::Scalar) -> [TensorCorner<P>; 4] {
    let one = scalar::<P>(1.0);
    let [p, e, f] = [&points[0..4], &points[4..12], &points[12..20]];
    let (s, t) = (one - u, one - v);
    let beside = [[u, v], [v, s], [s, t], [t, u]];
    let corner = |k: usize| {
        let seen = |x: P| x - p[k];
        let inner = blend(seen(f[2 * k]), beside[k][0], seen(f[2 * k + 1]), beside[k][1]);
        TensorCorner::new(p[k], seen(e[2 * k]), seen(e[2 * k + 1]), inner)
    };
    std::array::from_fn(corner)
}

/// The face point `(a f+ + b f-) / (a + b)`; at a corner, where both weights vanish, it does not matter.
fn blend<P: Point>(plus: P, a: P::Scalar, minus: P, b: P::Scalar) -> P {
    use num_traits::Float;
    plus + (minus - plus) * (b / (a + b).max(scalar::<P>(1e-30)))
}

/// A triangle patch at barycentric (u, v, 1 - u - v), with the derivative as in [`evaluate_gregory_quad`].
///
/// GLSL twin: `glsl/schemes/gregory/evaluate_gregory_triangle.glsl`.
pub fn evaluate_gregory_triangle<P: Point>(points: &[P; 15], u: P::Scalar, v: P::Scalar) -> Sample<P> {
    let [c1, c2, c3, c12, c24] = [1.0, 2.0, 3.0, 12.0, 24.0].map(scalar::<P>);
    let b = [u, v, c1 - u - v];
    let [p, e, f] = [&points[0..3], &points[3..9], &points[9..15]];
    // On an edge the terms of the others are zero, and what is left has the bits of a quad's `curve_point` along its edge.
    let corner = |k: usize| {
        let (x, y, z) = (b[k], b[(k + 1) % 3], b[(k + 2) % 3]);
        p[k] * ((x * x) * (x + ((c3 * y) * (x + y) + (c3 * z) * (x + z))))
    };
    let corners = (corner(0) + corner(1)) + corner(2);
    // The points beside the ends of the edge from corner k to corner n, as seen from there; the factor is 1 on the edge itself.
    let edge_terms = |k: usize, n: usize| {
        let (x, y) = (b[k], b[n]);
        ((e[2 * k] - p[k]) * ((x * x) * (c3 * y)) + (e[2 * n + 1] - p[n]) * ((y * y) * (c3 * x))) * (x + y)
    };
    let edges = (edge_terms(0, 1) + edge_terms(1, 2)) + edge_terms(2, 0);
    let mut inner = P::default();
    // Partial derivatives by u, v and w as if they were independent, of the points as seen from the first corner: see
    // `evaluate_tensor`. What that takes off all three alike goes again in their differences.
    let origin = p[0];
    let mut gradient = [P::default(); 3];
    for k in 0..3 {
        let (n, o) = ((k + 1) % 3, (k + 2) % 3);
        let (x, y, z) = (b[k], b[n], b[o]);
        // Corner k.
        gradient[k] = gradient[k] + (p[k] - origin) * (c3 * x * x);
        // The edge from corner k to corner n.
        let (plus, minus) = (e[2 * k] - origin, e[2 * n + 1] - origin);
        let edge = plus * x + minus * y;
        let scale = c3 * x * y * (x + y);
        gradient[k] = gradient[k] + edge * (c3 * y * (c2 * x + y)) + plus * scale;
        gradient[n] = gradient[n] + edge * (c3 * x * (x + c2 * y)) + minus * scale;
        // The face point of corner k.
        let face = blend(f[2 * k] - origin, y, f[2 * k + 1] - origin, z);
        inner = inner + (origin + face) * (c12 * x * x * y * z);
        gradient[k] = gradient[k] + face * (c24 * x * y * z);
        gradient[n] = gradient[n] + face * (c12 * x * x * z);
        gradient[o] = gradient[o] + face * (c12 * x * x * y);
    }
    let position = (corners + edges) + inner;
    let normal = unit_normal(gradient[0] - gradient[2], gradient[1] - gradient[2], (p[1] - p[0]).cross(p[2] - p[0]));
    Sample { position, normal }
}

/// A curve along the boundary of a patch, from corner k to the next, as cubic Bezier points.
pub fn boundary_curve<P: Point>(points: &[P], corners: usize, k: usize) -> [P; 4] {
    let next = (k + 1) % corners;
    [points[k], points[corners + 2 * k], points[corners + 2 * next + 1], points[next]]
}

/// A point on a boundary curve at `t` from its first end.
pub fn evaluate_boundary<P: Point>(curve: &[P; 4], t: P::Scalar) -> P {
    curve_point(&CurveBasis::new::<P>(t), seen_from_ends(*curve))
}
