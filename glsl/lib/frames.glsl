// What the control shaders of the two-stage construction get from its vertex shader for each corner: see
// glsl/construct/two_stage.vert.
#ifndef FRAMES_GLSL
#define FRAMES_GLSL

#ifdef SHARED
#include "write_shared.glsl"
#endif

layout(location = 0) in vec3 in_centre[];
layout(location = 1) in vec4 in_limit[];  // w: the ring's cosine
layout(location = 2) in vec3 in_plus[];   // as seen from the limit point
layout(location = 3) in vec3 in_minus[];  // likewise
layout(location = 4) in uint in_patch_number[];
#ifdef INNER
layout(location = 5) in vec3 in_inner[][INNER];
#endif
#ifdef SHARED
layout(location = 8) in vec3 in_shared_with[][SHARED_VECTORS];
layout(location = 14) in uint in_shared_bits[];
#ifdef DISPLACED
layout(location = 15) in float in_shared_lod[];
#endif
#endif

// What is left to do when the corner's control points are written: see `finish_corner`.
void finish_framed_corner(uint k) {
    finish_corner(in_patch_number[0]);
#ifdef SHARED
    HAND_ON_SHARED(draw.first_corner + in_patch_number[0] * CORNERS + k, k);
#endif
}

#endif
