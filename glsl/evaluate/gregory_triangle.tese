// A Gregory triangle. Evaluated in glsl/lib/evaluate/evaluate_gregory_triangle.glsl.
// variants: TEXCOORD, CAPTURE, CAPTURE_GRID, SHARED, SHARED+TEXCOORD, SHARED+CAPTURE, SHARED+CAPTURE_GRID, DISPLACED, DISPLACED+CAPTURE, DISPLACED+CAPTURE_GRID
#version 460
#extension GL_GOOGLE_include_directive : require
#define TRIANGLE
#define OWNED 5
#include "evaluate/evaluation.glsl"
#include "evaluate/evaluate_gregory_triangle.glsl"

void main() {
    vec3 at = parameter();
    emit(evaluate_surface(at), at);
}
