// What the control shader hands on of each corner to the evaluation shader: see packed.glsl.
#ifndef HANDED_ON_GLSL
#define HANDED_ON_GLSL

#include "draw/packed.glsl"
#ifdef SHARED
#include "edges/shared_bits.glsl"
#endif

// The control points that the corner owns come first. Then what it shares, and 1 where its plus edge is sharp.
#define HANDED_SHARED (3 * OWNED)
#ifdef SHARED
#define HANDED_SHARP (HANDED_SHARED + 3 * SHARED_VECTORS)
#define HANDED_MAP (HANDED_SHARP + 1)
#else
#define HANDED_MAP HANDED_SHARED
#endif
// Where in the displacement map its plus edge, its minus edge and it itself are looked up, and the level.
#ifdef DISPLACED
#define HANDED_LOD (HANDED_MAP + 6)
#define HANDED_TEXCOORD (HANDED_LOD + 1)
#else
#define HANDED_TEXCOORD HANDED_MAP
#endif
#ifdef TEXCOORD
#define HANDED_END (HANDED_TEXCOORD + 2)
#else
#define HANDED_END HANDED_TEXCOORD
#endif
// Of patches that may be refined, the number of the patch among all: 24 bits by its first corner, the rest by its second.
#ifdef MAY_BE_ADAPTIVE
#define HANDED_PATCH HANDED_END
#define HANDED_ROWS PACKED_ROWS(HANDED_PATCH + 1)
#else
#define HANDED_ROWS PACKED_ROWS(HANDED_END)
#endif

#endif
