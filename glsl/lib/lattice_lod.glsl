// The displacement of a vertex of a lattice.
#ifndef LATTICE_LOD_GLSL
#define LATTICE_LOD_GLSL

#include "displaced.glsl"
#include "displacement_map.glsl"
#include "draw.glsl"

// The level of the map at which an edge has as many texels as segments; `length` is the edge's over that of the map's longer
// side, as a logarithm.
float lattice_lod(float length) {
    precise float lod = length + log2(displacement_texels() / draw_factor());
    return max(lod, 0.0);
}

#endif
