// What the cached construction keeps of a patch, for shaders that evaluate a uniform grid.
#ifndef READ_CACHED_GLSL
#define READ_CACHED_GLSL

#include "evaluate/uniform_grid_sample.glsl"
#include "construct/cached.glsl"
#ifdef DISPLACED
#include "displace/map_lod.glsl"
#include "edges/shared_texcoords.glsl"
#endif

// Reads the patch with this number among all and this first corner, for a uniform grid of `segments` segments.
void read_cached(uint patch_number, uint first_corner, uint segments) {
#ifdef MAY_BE_ADAPTIVE
    evaluated_patch = patch_number;
#endif
    for (int k = 0; k < CORNERS; ++k) {
        vec4 texels[KEPT_TEXELS] = texels_of_patch(first_corner, k);
        for (int i = 0; i < OWNED; ++i) {
            owned[k][i] = kept_vector(texels, i);
        }
#ifdef SHARED
        for (int i = 0; i < SHARED_VECTORS; ++i) {
            shared_with[k][i] = kept_vector(texels, OWNED + i);
        }
        shared_bits[k] = kept_bits(texels);
#endif
#ifdef DISPLACED
        SharedTexcoord shared_at = shared_texcoord_of(first_corner + k);
        shared_texcoord[k] = vec2[3](shared_at.plus, shared_at.minus, shared_at.corner);
        shared_lod[k] = map_lod(shared_at.scale.x, float(segments));
#endif
#ifdef TEXCOORD
        texcoord[k] = corner_texcoord(first_corner + k);
#endif
    }
}

#endif
