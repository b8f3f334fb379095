// What the vertex shader of the two-stage construction hands on of each corner to the control shader: see packed.glsl.
#ifndef CORNER_NUMBERS_GLSL
#define CORNER_NUMBERS_GLSL

#include "draw/packed.glsl"
#include "scheme.glsl"
#ifdef SHARED
#include "edges/shared_bits.glsl"
#endif

// The limit point, and the edge points as seen from there. Then what inner points are made of: the ring's cosine and INNER vectors
// or, of regular faces, the control vertex.
#define RING_LIMIT 0
#define RING_PLUS 3
#define RING_MINUS 6
#ifdef INNER
#define RING_COSINE 9
#define RING_INNER 10
#define RING_SHARED (RING_INNER + 3 * INNER)
#else
#define RING_CENTRE 9
#define RING_SHARED 12
#endif
// What it shares, 1 where its plus edge is sharp, and the level of the displacement map.
#ifdef SHARED
#define RING_SHARP (RING_SHARED + 3 * SHARED_VECTORS)
#define RING_LOD (RING_SHARP + 1)
#ifdef DISPLACED
#define RING_ROWS PACKED_ROWS(RING_LOD + 1)
#else
#define RING_ROWS PACKED_ROWS(RING_LOD)
#endif
#else
#define RING_ROWS PACKED_ROWS(RING_SHARED)
#endif

#endif
