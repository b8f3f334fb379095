// Control points from where the cached construction keeps them, for shaders that evaluate a lattice.
#ifndef READ_CACHED_GLSL
#define READ_CACHED_GLSL

#include "cached.glsl"
#include "kinds.glsl"

// Those of a patch whose first corner this is.
void read_cached(uint first_corner) {
    for (uint k = 0u; k < CORNERS; ++k) {
        uint from = corner_points(first_corner + k);
        for (uint i = 0u; i < OWNED; ++i) {
            uint x = from + 3u * i;
            owned[k][i] = vec3(control_points[x], control_points[x + 1u], control_points[x + 2u]);
        }
    }
}

#endif
