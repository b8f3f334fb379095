// What the control shaders of the two-stage construction get from its vertex shader, and share.
#ifndef FRAMES_GLSL
#define FRAMES_GLSL

#include "rings.glsl"
#ifdef SHARED
#include "shared.glsl"
#endif

layout(location = 0) in vec3 in_centre[];
layout(location = 1) in vec4 in_limit[];  // w: the ring's cosine
layout(location = 2) in vec3 in_tangent_a[];
layout(location = 3) in vec3 in_tangent_b[];
layout(location = 4) in uint in_patch_number[];

// A corner of the patch and its ring.
struct Corner {
    uint index;  // of its ring
    Ring ring;
    uint plus;   // the ring edge that is its plus edge
    uint minus;  // and its minus edge
};

Corner corner_at(uint k) {
    uvec2 place = patch_corners[draw.first_corner + in_patch_number[0] * CORNERS + k];
    Ring ring = ring_at(place.x);
    return Corner(place.x, ring, place.y, place.y + 1u == ring.edges ? 0u : place.y + 1u);
}

// The frame's edge point of corner k, this invocation's, at its ring edge j.
vec3 corner_edge_point(Corner corner, uint k, uint j) {
    return edge_point(corner.ring, j, in_centre[k], in_limit[k].xyz, in_tangent_a[k], in_tangent_b[k]);
}

// What is left to do when the corner's control points are written: see `finish_corner`.
void finish_framed_corner(Corner corner, uint k) {
    finish_corner(in_patch_number[0]);
#ifdef SHARED
    share_corner(draw.first_corner + in_patch_number[0] * CORNERS + k,
                 FramedRing(corner.index, corner.ring, in_centre[k], in_limit[k].xyz, in_tangent_a[k], in_tangent_b[k]));
#endif
}

#endif
