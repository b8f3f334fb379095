// ACC as published (Loop and Schaefer 2008), for the bench: the tangents across the edges are made at every vertex. The surface
// is that of glsl/evaluate/acc.tese, in whose place it is drawn; no face may fall back.
#version 460
#extension GL_GOOGLE_include_directive : require
#define CORNERS 4
#define OWNED 6
#include "evaluate/evaluation.glsl"
#include "acc.glsl"

layout(location = 11) patch in vec4 cosines;

#define x_plus(k) across(k, edge_plus(k), edge_minus((k + 1) & 3), t_plus(k), (k + 1) & 3)
#define x_minus(k) across(k, edge_minus(k), edge_plus((k + 3) & 3), t_minus(k), (k + 3) & 3)
#define across(k, near, far, tangent, end) acc_across(inner(k), near, near, far, tangent, cosines[k], cosines[end])
#include "scheme_evaluate.glsl"

void main() {
    vec3 at = parameter();
    emit(evaluate_surface(at), at);
}
