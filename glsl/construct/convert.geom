// Conversion by the geometry shader, the first of two passes (Ni et al. 2008): the control points that each corner of each patch
// owns, to where the cached construction keeps them. Draws nothing.
// variants: OWNED=4, OWNED=5, OWNED=6, OWNED=8
#version 460
#extension GL_GOOGLE_include_directive : require
#include "control_points.glsl"

layout(points) in;
layout(points, max_vertices = 1) out;

layout(location = 0) in uint corner_number[];

void main() {
    make_control_points(corner_number[0]);
}
