// A Pm-patch of a triangle. Evaluated in glsl/lib/evaluate/evaluate_pm_triangle.glsl.
// variants: TEXCOORD, CAPTURE, CAPTURE_GRID
#version 460
#extension GL_GOOGLE_include_directive : require
#define TRIANGLE
#define OWNED 6
#define CORNERS 3
#include "evaluate/evaluation.glsl"
#include "evaluate/evaluate_pm_triangle.glsl"

void main() {
    vec3 at = parameter();
    emit(evaluate_surface(at), at);
}
