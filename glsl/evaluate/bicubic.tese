// A regular patch. Rust twin: `evaluate_bicubic` in src/patch/bicubic.rs.
// variants: TEXCOORD, CAPTURE, CAPTURE_GRID, SHARED, SHARED+TEXCOORD, SHARED+CAPTURE, SHARED+CAPTURE_GRID, DISPLACED, DISPLACED+CAPTURE, DISPLACED+CAPTURE_GRID
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 4
#include "evaluation.glsl"

// The points of corner k.
#define corner(k) owned[k][0]
#define edge_plus(k) owned[k][1]
#define edge_minus(k) owned[k][2]
#define face_plus(k) owned[k][3]

void main() {
    vec3 at = parameter();
    emit(evaluate_tensor(corner(0), edge_minus(0), edge_plus(3), corner(3),          //
                         edge_plus(0), face_plus(0), face_plus(3), edge_minus(3),    //
                         edge_minus(1), face_plus(1), face_plus(2), edge_plus(2),    //
                         corner(1), edge_plus(1), edge_minus(2), corner(2), at.x, at.y),
         at);
}
