// A Gregory quad. Rust twin: `evaluate_gregory_quad` in src/patch/gregory.rs.
// Of the control points `owned[corner][number]` of whatever stage includes it.
#ifndef EVALUATE_GREGORY_QUAD_GLSL
#define EVALUATE_GREGORY_QUAD_GLSL

#include "evaluate/patch.glsl"

Surface evaluate_gregory_quad(float u, float v) {
    precise float s = 1.0 - u;
    precise float t = 1.0 - v;
#define CORNER(k, x, y) TensorCorner(owned[k][0], owned[k][1], owned[k][2], blend(owned[k][3], x, owned[k][4], y))
    return evaluate_tensor(CORNER(0, u, v), CORNER(1, v, s), CORNER(2, s, t), CORNER(3, t, u), u, v);
#undef CORNER
}

#include "evaluate/adaptive.glsl"

Surface evaluate_whole(vec3 at) {
    return evaluate_gregory_quad(at.x, at.y);
}

#endif
