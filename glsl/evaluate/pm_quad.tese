// A Pm-patch of a quad: a c-patch. Evaluated in glsl/lib/evaluate/evaluate_pm_quad.glsl.
// variants: TEXCOORD, CAPTURE, CAPTURE_GRID
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 6
#define CORNERS 4
#include "evaluate/evaluation.glsl"
#include "evaluate/evaluate_pm_quad.glsl"

void main() {
    vec3 at = parameter();
    emit(evaluate_surface(at), at);
}
