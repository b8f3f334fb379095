// An ACC patch: the normal is that of the two tangent patches. Evaluated in glsl/lib/evaluate/evaluate_acc.glsl.
// variants: TEXCOORD, CAPTURE, CAPTURE_GRID
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 8
#include "evaluate/evaluation.glsl"
#include "evaluate/evaluate_acc.glsl"

void main() {
    vec3 at = parameter();
    emit(evaluate_surface(at), at);
}
