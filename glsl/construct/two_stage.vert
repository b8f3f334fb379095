// First stage of the two-stage construction: a control vertex and its one-ring become what a corner of a patch takes from
// them (Loop et al. 2009, section 4): see corner_numbers.glsl. One invocation for each corner of each patch.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef DISPLACED
#define SHARED
#endif
#include "constants.glsl"
#include "draw/draw.glsl"
#include "construct/corner.glsl"
#include "construct/corner_numbers.glsl"
#include "draw/visible.glsl"
#ifdef DISPLACED
#include "displace/corner_lod.glsl"
#endif

layout(constant_id = ID_CORNERS) const uint CORNERS = 4u;

layout(location = 0) out uint patch_number;
layout(location = 1) out vec4 of_corner[RING_ROWS];

void main() {
    // Not gl_PrimitiveID: lavapipe restarts it (bug B).
    uint vertex = uint(gl_VertexIndex);
    patch_number = patch_drawn(uint(gl_InstanceIndex) * draw.patches_per_instance + vertex / CORNERS);
    uint number = draw.first_corner + take_instance(patch_number) * CORNERS + vertex % CORNERS;
    Corner corner = corner_of_patch(number);
    float numbers[4 * RING_ROWS];
    PUT_VECTOR(numbers, RING_LIMIT, corner.limit);
    PUT_VECTOR(numbers, RING_PLUS, corner.plus);
    PUT_VECTOR(numbers, RING_MINUS, corner.minus);
#ifdef INNER
    numbers[RING_COSINE] = corner.limit.w;
    for (int i = 0; i < INNER; ++i) {
        PUT_VECTOR(numbers, RING_INNER + 3 * i, corner.inner[i]);
    }
#else
    PUT_VECTOR(numbers, RING_CENTRE, corner.centre);
#endif
#ifdef SHARED
    for (int i = 0; i < SHARED_VECTORS; ++i) {
        PUT_VECTOR(numbers, RING_SHARED + 3 * i, corner.with[i]);
    }
    numbers[RING_SHARP] = corner_sharp(number);
#ifdef DISPLACED
    numbers[RING_LOD] = corner_lod(number, corner.owner);
#endif
#endif
    for (int i = 0; i < RING_ROWS; ++i) {
        of_corner[i] = ROW_OF(numbers, i);
    }
}
