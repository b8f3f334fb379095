// A Pm-patch of a triangle. On a lattice, for draws to share: see glsl/lib/lattice.glsl.
// variants: TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#define TRIANGLE
#define OWNED 6
#define CORNERS 3
#include "lattice.glsl"
#include "evaluate_pm_triangle.glsl"

void main() {
    evaluate_lattice();
}
