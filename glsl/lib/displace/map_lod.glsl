// A level of the displacement map. Rust twin: `map_lod` in src/tessellator/factors.rs.
#ifndef MAP_LOD_GLSL
#define MAP_LOD_GLSL

#include "displace/displacement_map.glsl"

// At which an edge of so many segments has as many texels; `length` is the edge's over that of the map's longer side.
float map_lod(float length, float segments) {
    precise float texels = length * displacement_texels() / segments;
    return max(log2(texels), 0.0);
}

#endif
