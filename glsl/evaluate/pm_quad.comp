// A Pm-patch of a quad: a c-patch. On a lattice, for draws to share: see glsl/lib/lattice.glsl.
// variants: TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 6
#define CORNERS 4
#include "lattice.glsl"
#include "evaluate_pm_quad.glsl"

void main() {
    evaluate_lattice();
}
