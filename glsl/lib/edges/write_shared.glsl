// Has the control shader hand on what corners share, with `finish_corner`.
#ifndef WRITE_SHARED_GLSL
#define WRITE_SHARED_GLSL

#include "edges/shared_bits.glsl"
#ifdef DISPLACED
#include "edges/shared_texcoords.glsl"
#endif

// Of a corner by its number among all; `sharp` is 1 where its plus edge is.
void write_shared(uint corner, vec3 vectors[SHARED_VECTORS], float sharp, float lod) {
    for (int i = 0; i < SHARED_VECTORS; ++i) {
        PUT_VECTOR(numbers, HANDED_SHARED + 3 * i, vectors[i]);
    }
    numbers[HANDED_SHARP] = sharp;
#ifdef DISPLACED
    SharedTexcoord texcoord = shared_texcoord_of(corner);
    PUT_PAIR(numbers, HANDED_MAP, texcoord.plus);
    PUT_PAIR(numbers, HANDED_MAP + 2, texcoord.minus);
    PUT_PAIR(numbers, HANDED_MAP + 4, texcoord.corner);
    numbers[HANDED_LOD] = lod;
#endif
}

#endif
