// Bits of what patches share. Rust twins: src/table/shared.rs.
#ifndef SHARED_BITS_GLSL
#define SHARED_BITS_GLSL

#include "constants.glsl"
#include "draw/tables.glsl"

// Across the plus edge and its transversal, across the minus edge and its transversal, the normal at the corner, and where
// the surface is displaced the direction at the corner.
#ifdef DISPLACED
#define SHARED_VECTORS 6
#else
#define SHARED_VECTORS 5
#endif

const uint EDGE_MASK = ~SHARP_EDGE_BIT;

// Word i of a corner by its number among all.
uint shared_word(uint corner, uint i) {
    return table_words[tables.shared_corners + SHARED_WORDS * corner + i];
}

// 1 where the plus edge of a corner is sharp, by its number among all; else 0.
float corner_sharp(uint corner) {
    return (shared_word(corner, 2u) & SHARP_EDGE_BIT) != 0u ? 1.0 : 0.0;
}

#endif
