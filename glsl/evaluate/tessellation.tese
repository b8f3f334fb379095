// A patch, evaluated by the tessellation stages.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "evaluate/evaluation.glsl"
#include "scheme_evaluate.glsl"

void main() {
    vec3 at = parameter();
    emit(evaluate_surface(at), at);
}
