// A regular patch. Rust twin: `evaluate_bicubic` in src/blend/bicubic.rs.
// Of the control points `owned[corner][number]` of whatever stage includes it.
#ifndef EVALUATE_BICUBIC_GLSL
#define EVALUATE_BICUBIC_GLSL

#include "evaluate/patch.glsl"

Surface evaluate_bicubic(float u, float v) {
#define CORNER(k) TensorCorner(owned[k][0], owned[k][1], owned[k][2], owned[k][3])
    return evaluate_tensor(CORNER(0), CORNER(1), CORNER(2), CORNER(3), u, v);
#undef CORNER
}

Surface evaluate_surface(vec3 at) {
    return evaluate_bicubic(at.x, at.y);
}

#endif
