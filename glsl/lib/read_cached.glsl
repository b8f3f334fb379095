// What the cached construction keeps of a patch, for shaders that evaluate a lattice.
#ifndef READ_CACHED_GLSL
#define READ_CACHED_GLSL

#include "cached.glsl"
#include "lattice_sample.glsl"
#ifdef DISPLACED
#include "shared_texcoords.glsl"
#endif

// Of a patch whose first corner this is.
void read_cached(uint first_corner) {
    for (uint k = 0u; k < CORNERS; ++k) {
        for (uint i = 0u; i < OWNED; ++i) {
            owned[k][i] = kept_vector(first_corner + k, i);
        }
#ifdef SHARED
        for (uint i = 0u; i < SHARED_VECTORS; ++i) {
            shared_with[k][i] = kept_vector(first_corner + k, OWNED + i);
        }
        shared_bits[k] = corner_bits(first_corner + k);
#endif
#ifdef DISPLACED
        SharedTexcoord shared_at = shared_texcoords[first_corner + k];
        shared_texcoord[k] = vec2[3](shared_at.plus, shared_at.minus, shared_at.corner);
        // A corner whose edges have no length is as one whose edges are very short.
        shared_lod[k] = log2(max(shared_at.scale.x, 1e-30));
        texcoord[k] = texcoords[first_corner + k];
#endif
    }
}

#endif
