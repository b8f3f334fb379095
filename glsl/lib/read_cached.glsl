// Control points from where the cached construction keeps them, for shaders that evaluate a lattice.
#ifndef READ_CACHED_GLSL
#define READ_CACHED_GLSL

#include "cached.glsl"
#include "kinds.glsl"

// Those of a patch whose first corner this is.
void read_cached(uint first_corner) {
    for (uint k = 0u; k < CORNERS; ++k) {
        for (uint i = 0u; i < OWNED; ++i) {
            owned[k][i] = kept_vector(first_corner + k, i);
        }
    }
}

#endif
