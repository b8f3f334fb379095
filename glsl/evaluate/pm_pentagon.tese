// The first sector of a Pm-patch of a pentagon. Evaluated in glsl/lib/evaluate/evaluate_pm_pentagon.glsl.
// variants: TEXCOORD, CAPTURE, CAPTURE_GRID
#version 460
#extension GL_GOOGLE_include_directive : require
#define TRIANGLE
#define PENTAGON
#define OWNED 6
#define CORNERS 5
#include "evaluate/evaluation.glsl"
#include "evaluate/evaluate_pm_pentagon.glsl"

void main() {
    vec3 at = parameter();
    emit(evaluate_surface(at), at);
}
