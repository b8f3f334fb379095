// Bits of what patches share. Rust twins: src/table/shared.rs.
#ifndef SHARED_BITS_GLSL
#define SHARED_BITS_GLSL

const uint SHARP_EDGE_BIT = 1u << 30;    // the faces at it are lit with normals of their own

// Across the plus edge and its transversal, across the minus edge and its transversal, the normal at the corner, and where
// the surface is displaced the direction at the corner.
#ifdef DISPLACED
#define SHARED_VECTORS 6
#else
#define SHARED_VECTORS 5
#endif

#endif
