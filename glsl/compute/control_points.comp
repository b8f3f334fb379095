// The cached construction, once a frame: the control points that each corner of each patch owns, with the weights of the
// stencil table. One invocation for each corner. Compiled for patches whose corners own 4, 5 .. control points.
// variants: OWNED=4, OWNED=5, OWNED=6, OWNED=8
#version 460
#extension GL_GOOGLE_include_directive : require
#ifndef OWNED
#define OWNED 4
#endif
#define CACHED_ACCESS writeonly
#include "stencils.glsl"
#include "cached.glsl"

layout(local_size_x = 64) in;

// The patches of one kind. Rust twin: `Dispatch` in src/renderer/cached.rs.
layout(push_constant, std430) uniform Patches {
    uint first_patch;
    uint first_corner;
    uint corners;      // of a patch
    uint invocations;  // corners of all of them
} patches;

void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint i = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (i >= patches.invocations) {
        return;
    }
    vec3 points[OWNED];
    stencil_points(patches.first_patch + i / patches.corners, i % patches.corners, patches.corners, points);
    uint at = corner_points(patches.first_corner + i);
    for (uint k = 0u; k < OWNED; ++k) {
        control_points[at + 3u * k] = points[k].x;
        control_points[at + 3u * k + 1u] = points[k].y;
        control_points[at + 3u * k + 2u] = points[k].z;
    }
}
