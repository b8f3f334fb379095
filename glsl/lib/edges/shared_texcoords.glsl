// Where the displacement is looked up along an edge and at a corner. Rust twin: src/table/shared.rs.
#ifndef SHARED_TEXCOORDS_GLSL
#define SHARED_TEXCOORDS_GLSL

#include "draw/tables.glsl"

// Texture coordinates at a corner: on its plus edge, on its minus edge, at the corner itself; and x: the mean length of an
// edge there. Rust twin: `SharedTexcoord` in src/table/shared.rs.
struct SharedTexcoord { vec2 plus, minus, corner, scale; };

SharedTexcoord shared_texcoord_of(uint corner) {
    uint at = tables.shared_texcoords / 4u + 2u * corner;
    vec4 edges = uintBitsToFloat(table_fours[at]), rest = uintBitsToFloat(table_fours[at + 1u]);
    return SharedTexcoord(edges.xy, edges.zw, rest.xy, rest.zw);
}

#endif
