// What the control shaders of the two-stage construction get from its vertex shader for each corner: see
// glsl/construct/two_stage.vert.
#ifndef FRAMES_GLSL
#define FRAMES_GLSL

#include "construct/corner_numbers.glsl"
#ifdef SHARED
#include "edges/write_shared.glsl"
#endif

layout(location = 0) in uint in_patch_number[];
layout(location = 1) in vec4 of_corner[][RING_ROWS];

vec3 in_limit(uint k) {
    return PACKED_VECTOR(of_corner[k], RING_LIMIT);
}

// As seen from the limit point.
vec3 in_plus(uint k) {
    return PACKED_VECTOR(of_corner[k], RING_PLUS);
}

// Likewise.
vec3 in_minus(uint k) {
    return PACKED_VECTOR(of_corner[k], RING_MINUS);
}

#ifdef INNER
float in_cosine(uint k) {
    return PACKED_NUMBER(of_corner[k], RING_COSINE);
}

vec3 in_inner(uint k, int i) {
    return PACKED_VECTOR(of_corner[k], RING_INNER + 3 * i);
}
#else
vec3 in_centre(uint k) {
    return PACKED_VECTOR(of_corner[k], RING_CENTRE);
}
#endif

// What is left to do when the corner's control points are written: see `finish_corner`.
void finish_framed_corner(uint patch_number, uint k) {
#ifdef SHARED
    vec3 with[SHARED_VECTORS];
    for (int i = 0; i < SHARED_VECTORS; ++i) {
        with[i] = PACKED_VECTOR(of_corner[k], RING_SHARED + 3 * i);
    }
    float lod = 0.0;
#ifdef DISPLACED
    lod = PACKED_NUMBER(of_corner[k], RING_LOD);
#endif
    uint corner = draw.first_corner + patch_number * CORNERS + k;
    write_shared(corner, with, PACKED_NUMBER(of_corner[k], RING_SHARP), lod);
#endif
    finish_corner(patch_number);
}

#endif
