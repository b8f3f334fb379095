// A Gregory quad. On a lattice, for draws to share: see glsl/lib/lattice.glsl.
// variants: TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 5
#include "lattice.glsl"
#include "evaluate_gregory_quad.glsl"

void main() {
    evaluate_lattice();
}
