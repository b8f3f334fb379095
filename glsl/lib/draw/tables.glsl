// The tables of a model: one after the other in one buffer, which shaders see as words, in pairs and in fours. Rust twin:
// src/renderer/model/tables.rs.
#ifndef TABLES_GLSL
#define TABLES_GLSL

#include "constants.glsl"

layout(set = 1, binding = BINDING_TABLES, std430) readonly buffer TableWords { uint table_words[]; };
layout(set = 1, binding = BINDING_TABLES, std430) readonly buffer TablePairs { uvec2 table_pairs[]; };
layout(set = 1, binding = BINDING_TABLES, std430) readonly buffer TableFours { uvec4 table_fours[]; };

// The word where each table starts, a multiple of four. Of a model whose faces are subdivided, fans are in the place of rings.
layout(set = 1, binding = BINDING_TABLE_STARTS, std140) uniform Tables {
    uint ring_headers;
    uint ring_entries;
    uint ring_types;
    uint patch_corners;
    uint quadtrees;
    uint leaves;
    uint blocks;
    uint block_vertices;
    uint mask_weights;
    uint stencil_patches;
    uint stencil_vertices;
    uint stencil_types;
    uint texcoords;
    uint shared_corners;
    uint shared_texcoords;
    uint hulls;
    uint faces;  // where that of patch 0 would be
} tables;

// The texture coordinate of a corner by its number among all.
vec2 corner_texcoord(uint corner) {
    return uintBitsToFloat(table_pairs[tables.texcoords / 2u + corner]);
}

#endif
