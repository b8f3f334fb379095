// Evaluation that patches share. Rust twins: src/patch/bicubic.rs, src/patch/point.rs.
//
// glslang does not carry `precise` into called functions: every local of a shared edge's arithmetic says it itself.
#ifndef PATCH_GLSL
#define PATCH_GLSL

struct Sample {
    vec3 position;
    vec3 normal;
};

struct Basis {
    vec4 value;
    vec4 derivative;
};

// The cubic Bernstein polynomials and their derivatives: at t and 1 - t the same numbers in reverse order.
Basis cubic_basis(float t) {
    precise float s = 1.0 - t;
    precise float ss = s * s;
    precise float tt = t * t;
    precise float st = s * t;
    precise vec4 value = vec4(ss * s, 3.0 * ss * t, 3.0 * tt * s, tt * t);
    precise vec4 derivative = vec4(-(3.0 * ss), 3.0 * ss - 3.0 * (2.0 * st), 3.0 * (2.0 * st) - 3.0 * tt, 3.0 * tt);
    return Basis(value, derivative);
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

// A 4 x 4 tensor-product Bezier patch, rows along u.
//
// Derivatives are taken of the points as seen from the first one: they are differences of nearly equal numbers where a patch
// is small and far from the origin. Positions are not: an edge must get the same bits from both of its patches.
Sample evaluate_tensor(vec3 x00, vec3 x01, vec3 x02, vec3 x03, vec3 x10, vec3 x11, vec3 x12, vec3 x13, vec3 x20,
                       vec3 x21, vec3 x22, vec3 x23, vec3 x30, vec3 x31, vec3 x32, vec3 x33, float u, float v) {
    Basis bu = cubic_basis(u);
    Basis bv = cubic_basis(v);
    vec3 c0 = symmetric_sum(bu.value, x00, x10, x20, x30);
    vec3 c1 = symmetric_sum(bu.value, x01, x11, x21, x31);
    vec3 c2 = symmetric_sum(bu.value, x02, x12, x22, x32);
    vec3 c3 = symmetric_sum(bu.value, x03, x13, x23, x33);
    vec3 position = symmetric_sum(bv.value, c0, c1, c2, c3);

    precise vec3 y01 = x01 - x00, y02 = x02 - x00, y03 = x03 - x00;
    precise vec3 y10 = x10 - x00, y11 = x11 - x00, y12 = x12 - x00, y13 = x13 - x00;
    precise vec3 y20 = x20 - x00, y21 = x21 - x00, y22 = x22 - x00, y23 = x23 - x00;
    precise vec3 y30 = x30 - x00, y31 = x31 - x00, y32 = x32 - x00, y33 = x33 - x00;
    vec3 d0 = symmetric_sum(bu.derivative, vec3(0.0), y10, y20, y30);
    vec3 d1 = symmetric_sum(bu.derivative, y01, y11, y21, y31);
    vec3 d2 = symmetric_sum(bu.derivative, y02, y12, y22, y32);
    vec3 d3 = symmetric_sum(bu.derivative, y03, y13, y23, y33);
    vec3 e0 = symmetric_sum(bu.value, vec3(0.0), y10, y20, y30);
    vec3 e1 = symmetric_sum(bu.value, y01, y11, y21, y31);
    vec3 e2 = symmetric_sum(bu.value, y02, y12, y22, y32);
    vec3 e3 = symmetric_sum(bu.value, y03, y13, y23, y33);
    vec3 du = symmetric_sum(bv.value, d0, d1, d2, d3);
    vec3 dv = symmetric_sum(bv.derivative, e0, e1, e2, e3);
    return Sample(position, unit_normal(du, dv, cross(y33, y03 - y30)));
}

// The face point (a f+ + b f-) / (a + b); at a corner, where both weights vanish, it does not matter.
vec3 blend(vec3 plus, float a, vec3 minus, float b) {
    float sum = a + b;
    return sum > 0.0 ? (a * plus + b * minus) * (1.0 / sum) : plus;
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
