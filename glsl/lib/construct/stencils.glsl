// The stencil table. Rust twin: src/table/stencils.rs.
#ifndef STENCILS_GLSL
#define STENCILS_GLSL

#include "constants.glsl"
#include "draw/positions.glsl"

layout(set = 1, binding = 5, std430) readonly buffer StencilPatches { uvec2 stencil_patches[]; };
layout(set = 1, binding = 6, std430) readonly buffer StencilVertices { uint stencil_vertices[]; };
layout(set = 1, binding = 7, std430) readonly buffer StencilTypes { uint stencil_types[]; };

const uint ENTRY_WORDS = 1u + OWNED;

// The control points that a corner of a patch with so many corners owns. Those that faces around the corner share come out with the same bits
// for all of them: the sums go around the corner's ring from where it starts.
void stencil_points(uint patch_index, uint corner, uint corners, out vec3 points[OWNED]) {
    uvec2 place = stencil_patches[patch_index];
    uint head = place.y + HEAD_WORDS * corner;
    uint first = place.y + stencil_types[head];
    uint count = stencil_types[head + 1u];
    uint turning = stencil_types[head + 2u];
    uint turn = stencil_vertices[place.x + corner];
    precise vec3 sums[OWNED];
    for (uint i = 0u; i < OWNED; ++i) {
        sums[i] = vec3(0.0);
    }
    for (uint i = 0u; i < count; ++i) {
        uint turned = i + turn - 1u;
        turned = 1u + (turned < turning ? turned : turned - turning);
        uint at = first + ENTRY_WORDS * (i >= 1u && i <= turning ? turned : i);
        vec3 x = vertex_position(stencil_vertices[place.x + corners + stencil_types[at]]);
        for (uint k = 0u; k < OWNED; ++k) {
            precise vec3 term = uintBitsToFloat(stencil_types[at + 1u + k]) * x;
            sums[k] += term;
        }
    }
    points = sums;
}

#endif
