// What the control shader hands on of what corners share.
#ifndef WRITE_SHARED_GLSL
#define WRITE_SHARED_GLSL

#include "shared_bits.glsl"
#ifdef DISPLACED
#include "shared_texcoords.glsl"
#endif

layout(location = 16) out vec3 shared_with[][SHARED_VECTORS];
layout(location = 22) out uint shared_bits[];
#ifdef DISPLACED
layout(location = 23) out vec2 shared_texcoord[][3];
layout(location = 26) out float shared_lod[];
#endif

// Of a corner by its number among all.
void write_shared(uint corner, vec3 vectors[SHARED_VECTORS], uint bits, float lod) {
    for (int i = 0; i < SHARED_VECTORS; ++i) {
        shared_with[gl_InvocationID][i] = vectors[i];
    }
    shared_bits[gl_InvocationID] = bits;
#ifdef DISPLACED
    SharedTexcoord texcoord = shared_texcoords[corner];
    shared_texcoord[gl_InvocationID][0] = texcoord.plus;
    shared_texcoord[gl_InvocationID][1] = texcoord.minus;
    shared_texcoord[gl_InvocationID][2] = texcoord.corner;
    shared_lod[gl_InvocationID] = lod;
#endif
}

// What the vertex shader has of corner k, whose number among all this is.
#ifdef DISPLACED
#define HAND_ON_SHARED(corner, k) write_shared(corner, in_shared_with[k], in_shared_bits[k], in_shared_lod[k])
#else
#define HAND_ON_SHARED(corner, k) write_shared(corner, in_shared_with[k], in_shared_bits[k], 0.0)
#endif

#endif
