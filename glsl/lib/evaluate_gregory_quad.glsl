// A Gregory quad. Rust twin: `evaluate_gregory_quad` in src/patch/gregory.rs.
// Of the control points `owned[corner][number]` of whatever stage includes it.
#ifndef EVALUATE_GREGORY_QUAD_GLSL
#define EVALUATE_GREGORY_QUAD_GLSL

#include "patch.glsl"

// The points of corner k.
#define corner(k) owned[k][0]
#define edge_plus(k) owned[k][1]
#define edge_minus(k) owned[k][2]
#define face_plus(k) owned[k][3]
#define face_minus(k) owned[k][4]

Sample evaluate_gregory_quad(float u, float v) {
    float s = 1.0 - u;
    float t = 1.0 - v;
    vec3 f0 = blend(face_plus(0), u, face_minus(0), v);
    vec3 f1 = blend(face_plus(1), v, face_minus(1), s);
    vec3 f2 = blend(face_plus(2), s, face_minus(2), t);
    vec3 f3 = blend(face_plus(3), t, face_minus(3), u);
    return evaluate_tensor(corner(0), edge_minus(0), edge_plus(3), corner(3),  //
                           edge_plus(0), f0, f3, edge_minus(3),                //
                           edge_minus(1), f1, f2, edge_plus(2),                //
                           corner(1), edge_plus(1), edge_minus(2), corner(2), u, v);
}

Sample evaluate_patch(vec3 at) {
    return evaluate_gregory_quad(at.x, at.y);
}

#endif
