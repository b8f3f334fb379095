// An ACC patch: the normal is that of the two tangent patches. On a lattice, for draws to share: see glsl/lib/lattice.glsl.
// variants: TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 8
#include "lattice.glsl"
#include "evaluate_acc.glsl"

void main() {
    evaluate_lattice();
}
