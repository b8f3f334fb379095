// Where the displacement is looked up along an edge and at a corner. Rust twin: src/table/shared.rs.
#ifndef SHARED_TEXCOORDS_GLSL
#define SHARED_TEXCOORDS_GLSL

// Texture coordinates at a corner: on its plus edge, on its minus edge, at the corner itself; and x: the mean length of an
// edge there. Rust twin: `SharedTexcoord` in src/table/shared.rs.
struct SharedTexcoord { vec2 plus, minus, corner, scale; };
layout(set = 1, binding = 10, std430) readonly buffer SharedTexcoords { SharedTexcoord shared_texcoords[]; };

#endif
