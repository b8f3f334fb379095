// A regular patch. Rust twin: `evaluate_bicubic` in src/patch/bicubic.rs.
// Of the control points `owned[corner][number]` of whatever stage includes it.
#ifndef EVALUATE_BICUBIC_GLSL
#define EVALUATE_BICUBIC_GLSL

#include "patch.glsl"

// The points of corner k.
#define corner(k) owned[k][0]
#define edge_plus(k) owned[k][1]
#define edge_minus(k) owned[k][2]
#define face_plus(k) owned[k][3]

Sample evaluate_bicubic(float u, float v) {
    return evaluate_tensor(corner(0), edge_minus(0), edge_plus(3), corner(3),          //
                           edge_plus(0), face_plus(0), face_plus(3), edge_minus(3),    //
                           edge_minus(1), face_plus(1), face_plus(2), edge_plus(2),    //
                           corner(1), edge_plus(1), edge_minus(2), corner(2), u, v);
}

Sample evaluate_patch(vec3 at) {
    return evaluate_bicubic(at.x, at.y);
}

#endif
