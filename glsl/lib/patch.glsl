// Evaluation that patches share. Rust twins: src/patch/bicubic.rs, src/patch/point.rs.
//
// glslang does not carry `precise` into called functions: every local of a shared edge's arithmetic says it itself, and so
// does all else, for a vertex to be the same wherever a shader evaluates it.
#ifndef PATCH_GLSL
#define PATCH_GLSL

// What evaluating a patch gives: of the derivatives only the direction counts.
struct Surface {
    vec3 position;
    vec3 du, dv;
    vec3 facing;  // about where the normal goes where the derivatives are parallel
};

struct Sample {
    vec3 position;
    vec3 normal;
};

struct Basis {
    vec4 value;
    vec3 slope;  // the quadratic polynomials: of the differences of the points they make a third of the derivative
};

// The cubic Bernstein polynomials: at t and 1 - t the same numbers in reverse order.
Basis cubic_basis(float t) {
    precise float s = 1.0 - t;
    precise float ss = s * s;
    precise float tt = t * t;
    precise vec4 value = vec4(ss * s, 3.0 * ss * t, 3.0 * tt * s, tt * t);
    return Basis(value, vec3(ss, 2.0 * (s * t), tt));
}

// The sum that both directions along an edge evaluate to the same bits.
vec3 symmetric_sum(vec4 weights, vec3 x0, vec3 x1, vec3 x2, vec3 x3) {
    precise vec3 sum = (weights.x * x0 + weights.w * x3) + (weights.y * x1 + weights.z * x2);
    return sum;
}

// Products whose rounding no driver may change: `cross` and `dot` may be made of fused operations.
vec3 exact_cross(vec3 a, vec3 b) {
    precise vec3 product = a.yzx * b.zxy - a.zxy * b.yzx;
    return product;
}

float exact_dot(vec3 a, vec3 b) {
    precise float product = (a.x * b.x + a.y * b.y) + a.z * b.z;
    return product;
}

// A vector made one long, unless it is zero.
vec3 unit(vec3 x) {
    float squared = exact_dot(x, x);
    precise vec3 scaled = x * inversesqrt(squared);
    return squared > 0.0 ? scaled : x;
}

// The unit vector along `du x dv`; where the derivatives are parallel, along `fallback`.
vec3 unit_normal(vec3 du, vec3 dv, vec3 fallback) {
    vec3 normal = exact_cross(du, dv);
    // Within 1e-5 rad of each other: what is left of the cross product is rounding.
    bool parallel = exact_dot(normal, normal) <= 1e-10 * (exact_dot(du, du) * exact_dot(dv, dv));
    return unit(parallel ? fallback : normal);
}

// A control point that is kept as seen from its corner.
vec3 from_corner(vec3 p, vec3 vector) {
    precise vec3 point = p + vector;
    return point;
}

// A control point other than the corner itself, of those that a corner owns: bicubic and Gregory patches, with 4 and 5, keep
// them as seen from the corner, for the differences of which normals are made.
#if defined(OWNED) && OWNED != 4 && OWNED != 5
#define CONTROL_POINT(k, i) owned[k][i]
#else
#define CONTROL_POINT(k, i) from_corner(owned[k][0], owned[k][i])
#endif

Sample sample_of(Surface surface) {
    return Sample(surface.position, unit_normal(surface.du, surface.dv, surface.facing));
}

// A third of the derivative along a cubic: from its ends `near` and `far` to the points beside them, and between these. From either
// end the same but for its sign.
vec3 edge_slope(vec3 slope, vec3 near, vec3 middle, vec3 far) {
    precise vec3 sum = (slope.x * near - slope.z * far) + slope.y * middle;
    return sum;
}

// What a corner of a tensor-product patch owns: its point and, as seen from there, those along its plus and its minus edge, and
// inside.
struct TensorCorner {
    vec3 p, plus, minus, inner;
};

// A 4 x 4 tensor-product Bezier patch.
//
// The row of points beside an edge is the row of the edge and vectors from there, so that slopes across an edge are made of
// those vectors alone: with points, they would be differences of nearly equal numbers where a patch is small and far from the
// origin. The derivative along an edge has the same bits for both its patches, but for its sign.
Surface evaluate_tensor(TensorCorner a, TensorCorner b, TensorCorner c, TensorCorner d, float u, float v) {
    Basis bu = cubic_basis(u);
    Basis bv = cubic_basis(v);
    // From a to b, and from d to c.
    vec3 x1 = from_corner(a.p, a.plus), x2 = from_corner(b.p, b.minus);
    vec3 y1 = from_corner(d.p, d.minus), y2 = from_corner(c.p, c.plus);
    vec3 x = symmetric_sum(bu.value, a.p, x1, x2, b.p);
    vec3 y = symmetric_sum(bu.value, d.p, y1, y2, c.p);
    // From those edges inwards.
    precise vec3 v1 = a.inner - a.plus, v2 = b.inner - b.minus;
    precise vec3 w1 = d.inner - d.minus, w2 = c.inner - c.plus;
    vec3 x_in = symmetric_sum(bu.value, a.minus, v1, v2, b.plus);
    vec3 y_in = symmetric_sum(bu.value, d.plus, w1, w2, c.minus);
    vec3 x_beside = from_corner(x, x_in), y_beside = from_corner(y, y_in);
    vec3 position = symmetric_sum(bv.value, x, x_beside, y_beside, y);

    // A third of the derivatives.
    vec3 dv = edge_slope(bv.slope, x_in, y_beside - x_beside, y_in);
    vec3 dx = edge_slope(bu.slope, a.plus, x2 - x1, b.minus);
    vec3 dy = edge_slope(bu.slope, d.minus, y2 - y1, c.plus);
    precise vec3 dx_in = bu.slope.x * (v1 - a.minus) + bu.slope.y * (v2 - v1) + bu.slope.z * (b.plus - v2);
    precise vec3 dy_in = bu.slope.x * (w1 - d.plus) + bu.slope.y * (w2 - w1) + bu.slope.z * (c.minus - w2);
    vec4 at = bv.value;
    precise vec3 du = ((at.x + at.y) * dx + at.y * dx_in) + ((at.z + at.w) * dy + at.z * dy_in);
    return Surface(position, du, dv, cross(c.p - a.p, d.p - b.p));
}

// The face point (a f+ + b f-) / (a + b); at a corner, where both weights vanish, it does not matter.
vec3 blend(vec3 plus, float a, vec3 minus, float b) {
    precise vec3 between = plus + (b / max(a + b, 1e-30)) * (minus - plus);
    return between;
}

// What the corners have, at a point of the patch.
#if defined(PENTAGON)
#define INTERPOLATED(of, at) (at.x * of[0] + at.y * of[1] + at.z * ((of[0] + of[1] + of[2] + of[3] + of[4]) / 5.0))
#elif defined(TRIANGLE)
#define INTERPOLATED(of, at) (at.x * of[0] + at.y * of[1] + at.z * of[2])
#else
#define INTERPOLATED(of, at) mix(mix(of[0], of[1], at.x), mix(of[3], of[2], at.x), at.y)
#endif

#endif
