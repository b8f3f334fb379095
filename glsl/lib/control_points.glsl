// Making the control points of the cached construction, with the weights of the stencil table. Compiled for patches whose
// corners own 4, 5 .. control points.
#ifndef CONTROL_POINTS_GLSL
#define CONTROL_POINTS_GLSL

#ifndef OWNED
#define OWNED 4
#endif
#define CACHED_ACCESS writeonly
#include "stencils.glsl"
#include "cached.glsl"

// The patches of one kind. Rust twin: `Corners` in src/renderer/cached.rs.
layout(push_constant, std430) uniform Patches {
    uint first_patch;
    uint first_corner;
    uint corners;      // of a patch
    uint invocations;  // corners of all of them
} patches;

// Those of corner i of all.
void make_control_points(uint i) {
    vec3 points[OWNED];
    stencil_points(patches.first_patch + i / patches.corners, i % patches.corners, patches.corners, points);
    uint at = corner_points(patches.first_corner + i);
    for (uint k = 0u; k < OWNED; ++k) {
        control_points[at + 3u * k] = points[k].x;
        control_points[at + 3u * k + 1u] = points[k].y;
        control_points[at + 3u * k + 2u] = points[k].z;
    }
}

#endif
