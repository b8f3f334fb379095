// The stencil table. Rust twin: src/table/stencils.rs.
#ifndef STENCILS_GLSL
#define STENCILS_GLSL

#include "positions.glsl"

layout(set = 1, binding = 1, std430) readonly buffer StencilPatches { uvec2 stencil_patches[]; };
layout(set = 1, binding = 2, std430) readonly buffer StencilVertices { uint stencil_vertices[]; };
layout(set = 1, binding = 3, std430) readonly buffer StencilTypes { uint stencil_types[]; };

const uint ENTRY_WORDS = 1u + OWNED;

// The control points that a corner of a patch owns.
void stencil_points(uint patch_index, uint corner, out vec3 points[OWNED]) {
    uvec2 place = stencil_patches[patch_index];
    uint head = place.y + 2u * corner;
    uint at = place.y + stencil_types[head];
    uint end = at + ENTRY_WORDS * stencil_types[head + 1u];
    for (uint i = 0u; i < OWNED; ++i) {
        points[i] = vec3(0.0);
    }
    for (; at < end; at += ENTRY_WORDS) {
        vec3 x = vertex_position(stencil_vertices[place.x + stencil_types[at]]);
        for (uint i = 0u; i < OWNED; ++i) {
            points[i] += uintBitsToFloat(stencil_types[at + 1u + i]) * x;
        }
    }
}

#endif
