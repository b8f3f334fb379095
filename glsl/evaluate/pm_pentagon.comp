// The first sector of a Pm-patch of a pentagon. On a lattice, for draws to share: see glsl/lib/lattice.glsl.
// variants: TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#define TRIANGLE
#define PENTAGON
#define OWNED 6
#define CORNERS 5
#include "lattice.glsl"
#include "evaluate_pm_pentagon.glsl"

void main() {
    evaluate_lattice();
}
