// Conversion by the geometry shader, the first of two passes (Ni et al. 2008): the control points that each corner of each patch
// owns, with the weights of the stencil table, to where the cached construction keeps them. Draws nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#define MAKES_POINTS
#include "construct/stencils.glsl"
#include "construct/cached.glsl"

layout(points) in;
layout(points, max_vertices = 1) out;

// The patches of one kind. Rust twin: `Patches` in src/renderer/construct/conversion.rs.
layout(push_constant, std430) uniform Patches {
    uint first_patch;
    uint first_corner;
    uint corners;  // of a patch
} patches;

layout(location = 0) in uint corner_number[];

void main() {
    uint i = corner_number[0];
    vec3 points[OWNED];
    stencil_points(patches.first_patch + i / patches.corners, i % patches.corners, patches.corners, points);
    for (uint k = 0u; k < OWNED; ++k) {
        keep_vector(patches.first_corner + i, k, points[k]);
    }
    // Never: but lavapipe (22.3.6) takes a geometry shader without this for one that has no streams, and then counts the vertices
    // of one by what another left on its stack.
    if (patches.corners == 0u) {
        EmitVertex();
    }
}
