// Evaluation that patches share. Rust twins: src/blend/bezier.rs, src/blend/point.rs.
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

// The cubic Bernstein polynomials: at t and 1 - t the same numbers in reverse order.
vec4 cubic_basis(float t) {
    precise float s = 1.0 - t;
    precise float ss = s * s;
    precise float tt = t * t;
    precise vec4 value = vec4(ss * s, 3.0 * ss * t, 3.0 * tt * s, tt * t);
    return value;
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

// A cubic Bezier curve by its ends and, as seen from either, the point beside it: what the ends count is the sum of two Bernstein
// polynomials. At t and 1 - t the same numbers, in reverse order and with other signs.
struct CurveBasis {
    vec2 ends;    // of the ends
    vec2 beside;  // of the points beside them
    vec3 slope;   // of a third of the derivative: of the point beside the first end, of the way from end to end, of the point
                  // beside the second
};

CurveBasis curve_basis(float t) {
    precise float s = 1.0 - t;
    precise float ss = s * s, tt = t * t;
    precise float s3 = 3.0 * s, t3 = 3.0 * t;
    precise vec2 ends = vec2(ss * (s + t3), tt * (t + s3));
    precise vec2 beside = vec2(ss * t3, tt * s3);
    precise float between = 2.0 * (s * t);
    precise vec3 slope = vec3(ss - between, between, between - tt);
    return CurveBasis(ends, beside, slope);
}

// The sum that both directions along an edge evaluate to the same bits.
vec3 curve_point(CurveBasis at, vec3 p0, vec3 beside0, vec3 beside1, vec3 p1) {
    precise vec3 sum = (at.ends.x * p0 + at.ends.y * p1) + (at.beside.x * beside0 + at.beside.y * beside1);
    return sum;
}

// A third of the derivative. From either end the same but for its sign.
vec3 curve_slope(CurveBasis at, vec3 p0, vec3 beside0, vec3 beside1, vec3 p1) {
    precise vec3 sum = at.slope.y * (p1 - p0) + (at.slope.x * beside0 + at.slope.z * beside1);
    return sum;
}

vec3 from_corner(vec3 p, vec3 vector) {
    precise vec3 point = p + vector;
    return point;
}

// Control point i of those that a corner owns, other than the corner itself, out of all that is kept of them. Patches that share
// frames keep other things, of which positions and normals are made with the fewest operations. Rust twin:
// `Scheme::kept` in src/patch/scheme.rs.
// - the points along the plus and the minus edge, as seen from the corner;
// - the inner point, if there is one: of quads as seen from where these two lead to one after the other, of triangles as seen from
//   the corner;
// - of Gregory patches, the way from there (f+) to f-.
#ifndef KEEPS_FRAME
#define POINT_OF(kept, i) kept[i]
#elif OWNED == 3
#define POINT_OF(kept, i) from_corner(kept[0], kept[i])
#else
#ifdef TRIANGLE
#define INNER_OF(kept) kept[3]
#else
#define INNER_OF(kept) from_corner(from_corner(kept[1], kept[2]), kept[3])
#endif
#ifdef TWO_FACE_POINTS
#define LAST_OF(kept) from_corner(INNER_OF(kept), kept[4])
#else
#define LAST_OF(kept) INNER_OF(kept)
#endif
#define POINT_OF(kept, i) from_corner(kept[0], (i) < 3 ? kept[i] : (i) == 3 ? INNER_OF(kept) : LAST_OF(kept))
#endif
#define CONTROL_POINT(k, i) POINT_OF(owned[k], i)

Sample sample_of(Surface surface) {
    return Sample(surface.position, unit_normal(surface.du, surface.dv, surface.facing));
}

// What a corner of a tensor-product patch has: its point; as seen from there, those along its plus and its minus edge; and the
// inner point as seen from where these two lead to one after the other.
struct TensorCorner {
    vec3 p, plus, minus, twist;
};

// A 4 x 4 tensor-product Bezier patch, by its edges from a to b and from d to c, and by what lies inwards from them: so slopes
// across an edge are made of vectors alone. With points, they would be differences of nearly equal numbers where a patch is small
// and far from the origin. The derivative along an edge has the same bits for both its patches, but for its sign.
Surface evaluate_tensor(TensorCorner a, TensorCorner b, TensorCorner c, TensorCorner d, float u, float v) {
    CurveBasis at_u = curve_basis(u), at_v = curve_basis(v);
    vec3 x = curve_point(at_u, a.p, a.plus, b.minus, b.p);
    vec3 y = curve_point(at_u, d.p, d.minus, c.plus, c.p);
    vec3 x_in = curve_point(at_u, a.minus, a.twist, b.twist, b.plus);
    vec3 y_in = curve_point(at_u, d.plus, d.twist, c.twist, c.minus);
    vec3 dx = curve_slope(at_u, a.p, a.plus, b.minus, b.p);
    vec3 dy = curve_slope(at_u, d.p, d.minus, c.plus, c.p);
    vec3 dx_in = curve_slope(at_u, a.minus, a.twist, b.twist, b.plus);
    vec3 dy_in = curve_slope(at_u, d.plus, d.twist, c.twist, c.minus);
    precise vec3 ac = c.p - a.p, bd = d.p - b.p;
    return Surface(curve_point(at_v, x, x_in, y_in, y), curve_point(at_v, dx, dx_in, dy_in, dy),
                   curve_slope(at_v, x, x_in, y_in, y), cross(ac, bd));
}

// The face point (a f+ + b f-) / (a + b), where `change` leads from f+ to f-; at a corner, where both weights vanish, it does not
// matter.
vec3 blend(vec3 plus, float a, vec3 change, float b) {
    precise vec3 between = plus + (b / max(a + b, 1e-30)) * change;
    return between;
}

// The edges of the patch on which a point of it lies: edge k leads from corner k to the next.
bvec4 edges_of(vec3 at) {
#ifdef TRIANGLE
    return bvec4(at.z == 0.0, at.x == 0.0, at.y == 0.0, false);
#else
    return bvec4(at.y == 0.0, at.x == 1.0, at.y == 1.0, at.x == 0.0);
#endif
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
