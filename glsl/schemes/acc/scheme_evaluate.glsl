// An ACC patch: the normal is that of the two tangent patches. Rust twin: `evaluate_acc` in src/patch/acc.rs.
// Of the control points `owned[corner][number]` of whatever stage includes it.
#ifndef EVALUATE_ACC_GLSL
#define EVALUATE_ACC_GLSL

#include "evaluate/patch.glsl"

// The points of corner k.
#define corner(k) owned[k][0]
#define edge_plus(k) owned[k][1]
#define edge_minus(k) owned[k][2]
#define inner(k) owned[k][3]
#define t_plus(k) owned[k][4]
#define t_minus(k) owned[k][5]
// A shader that makes them itself says how.
#ifndef x_plus
#define x_plus(k) owned[k][6]
#define x_minus(k) owned[k][7]
#endif

// A quadratic of a tangent patch whose middle point is the derivative of the geometry's from `near` to `far`.
vec3 tangent(vec3 x0, vec3 near, vec3 far, vec3 x2, float t) {
    precise float s = 1.0 - t;
    precise vec3 sum = (s * s) * x0 + (t * t) * x2 + (2.0 * (s * t)) * (3.0 * (far - near));
    return sum;
}

Surface evaluate_acc(float u, float v) {
    vec4 bu = cubic_basis(u);
    vec4 bv = cubic_basis(v);
    vec3 c0 = symmetric_sum(bu, corner(0), edge_plus(0), edge_minus(1), corner(1));
    vec3 c1 = symmetric_sum(bu, edge_minus(0), inner(0), inner(1), edge_plus(1));
    vec3 c2 = symmetric_sum(bu, edge_plus(3), inner(3), inner(2), edge_minus(2));
    vec3 c3 = symmetric_sum(bu, corner(3), edge_minus(3), edge_plus(2), corner(2));
    vec3 u0 = tangent(t_plus(0), edge_plus(0), edge_minus(1), -t_minus(1), u);
    vec3 u1 = tangent(x_minus(0), inner(0), inner(1), -x_plus(1), u);
    vec3 u2 = tangent(x_plus(3), inner(3), inner(2), -x_minus(2), u);
    vec3 u3 = tangent(t_minus(3), edge_minus(3), edge_plus(2), -t_plus(2), u);
    vec3 v0 = tangent(t_minus(0), edge_minus(0), edge_plus(3), -t_plus(3), v);
    vec3 v1 = tangent(x_plus(0), inner(0), inner(3), -x_minus(3), v);
    vec3 v2 = tangent(x_minus(1), inner(1), inner(2), -x_plus(2), v);
    vec3 v3 = tangent(t_plus(1), edge_plus(1), edge_minus(2), -t_minus(2), v);
    precise vec3 ac = corner(2) - corner(0), bd = corner(3) - corner(1);
    return Surface(symmetric_sum(bv, c0, c1, c2, c3), symmetric_sum(bv, u0, u1, u2, u3),
                   symmetric_sum(bu, v0, v1, v2, v3), cross(ac, bd));
}

Surface evaluate_surface(vec3 at) {
    return evaluate_acc(at.x, at.y);
}

#endif
