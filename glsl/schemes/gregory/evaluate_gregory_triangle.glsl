// A Gregory triangle. Rust twin: `evaluate_gregory_triangle` in src/patch/gregory.rs.
// Of the control points `owned[corner][number]` of whatever stage includes it.
#ifndef EVALUATE_GREGORY_TRIANGLE_GLSL
#define EVALUATE_GREGORY_TRIANGLE_GLSL

#include "evaluate/patch.glsl"

#define corner(k) owned[k][0]

// The terms of corner k with coordinate x, and of its edge to the next corner, whose coordinate is y: the derivatives,
// and of the position what vanishes on the edges. Points are given as seen from `origin`,
// corner 0: see `evaluate_tensor`.
void add_corner(float x, float y, float z, vec3 origin, vec3 p, vec3 plus, vec3 next_minus, vec3 f_plus, vec3 change,
                inout vec3 inner, inout vec3 dx, inout vec3 dy, inout vec3 dz) {
    precise vec3 edge = x * plus + y * next_minus;
    precise float scale = 3.0 * x * y * (x + y);
    precise vec3 face = blend(f_plus, y, change, z);
    precise vec3 of_inner = inner + (12.0 * x * x * y * z) * (origin + face);
    precise vec3 of_dx =
        dx + ((3.0 * x * x) * p + (3.0 * y * (2.0 * x + y)) * edge + scale * plus + (24.0 * x * y * z) * face);
    precise vec3 of_dy = dy + ((3.0 * x * (x + 2.0 * y)) * edge + scale * next_minus + (12.0 * x * x * z) * face);
    precise vec3 of_dz = dz + (12.0 * x * x * y) * face;
    inner = of_inner;
    dx = of_dx;
    dy = of_dy;
    dz = of_dz;
}

// What a corner counts with the points beside it on both its edges; its own coordinate is x.
float corner_weight(float x, float y, float z) {
    precise float weight = (x * x) * (x + ((3.0 * y) * (x + y) + (3.0 * z) * (x + z)));
    return weight;
}

// The points beside the ends of an edge, as seen from there; the factor is 1 on the edge itself.
vec3 edge_terms(float x, float y, vec3 plus, vec3 next_minus) {
    precise vec3 sum = (x + y) * (((x * x) * (3.0 * y)) * plus + ((y * y) * (3.0 * x)) * next_minus);
    return sum;
}

// On an edge the terms of the others are zero, and what is left has the bits of `curve_point` along the edge of a quad.
vec3 position_at(float u, float v, float w, vec3 inner) {
    precise vec3 corners = (corner_weight(u, v, w) * corner(0) + corner_weight(v, w, u) * corner(1))
        + corner_weight(w, u, v) * corner(2);
    precise vec3 edges = (edge_terms(u, v, owned[0][1], owned[1][2]) + edge_terms(v, w, owned[1][1], owned[2][2]))
        + edge_terms(w, u, owned[2][1], owned[0][2]);
    precise vec3 position = (corners + edges) + inner;
    return position;
}

Surface evaluate_gregory_triangle(float u, float v, float w) {
    precise vec3 o = corner(0), b = corner(1) - o, c = corner(2) - o;
    vec3 inner = vec3(0.0), du = vec3(0.0), dv = vec3(0.0), dw = vec3(0.0);
    precise vec3 plus1 = b + owned[1][1], minus1 = b + owned[1][2], f_plus1 = b + owned[1][3];
    precise vec3 plus2 = c + owned[2][1], minus2 = c + owned[2][2], f_plus2 = c + owned[2][3];
    add_corner(u, v, w, o, vec3(0.0), owned[0][1], minus1, owned[0][3], owned[0][4], inner, du, dv, dw);
    add_corner(v, w, u, o, b, plus1, minus2, f_plus1, owned[1][4], inner, dv, dw, du);
    add_corner(w, u, v, o, c, plus2, owned[0][2], f_plus2, owned[2][4], inner, dw, du, dv);
    precise vec3 along_u = du - dw, along_v = dv - dw;
    return Surface(position_at(u, v, w, inner), along_u, along_v, cross(b, c));
}

#include "evaluate/adaptive.glsl"

Surface evaluate_whole(vec3 at) {
    return evaluate_gregory_triangle(at.x, at.y, at.z);
}

#endif
