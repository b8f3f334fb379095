// The stencil table. Rust twin: src/table/stencils.rs.
#ifndef STENCILS_GLSL
#define STENCILS_GLSL

#include "positions.glsl"

layout(set = 1, binding = 1, std430) readonly buffer StencilPatches { uvec2 stencil_patches[]; };
layout(set = 1, binding = 2, std430) readonly buffer StencilVertices { uint stencil_vertices[]; };
layout(set = 1, binding = 3, std430) readonly buffer StencilTypes { uint stencil_types[]; };

const uint ENTRY_WORDS = 6u;

// The control points that a corner of a patch owns: p, e+, e-, f+, f-.
void stencil_points(uint patch_index, uint corner, out vec3 p, out vec3 plus, out vec3 minus, out vec3 face_plus,
                    out vec3 face_minus) {
    uvec2 place = stencil_patches[patch_index];
    uint head = place.y + 2u * corner;
    uint at = place.y + stencil_types[head];
    uint end = at + ENTRY_WORDS * stencil_types[head + 1u];
    p = plus = minus = face_plus = face_minus = vec3(0.0);
    for (; at < end; at += ENTRY_WORDS) {
        vec3 x = vertex_position(stencil_vertices[place.x + stencil_types[at]]);
        p += uintBitsToFloat(stencil_types[at + 1u]) * x;
        plus += uintBitsToFloat(stencil_types[at + 2u]) * x;
        minus += uintBitsToFloat(stencil_types[at + 3u]) * x;
        face_plus += uintBitsToFloat(stencil_types[at + 4u]) * x;
        face_minus += uintBitsToFloat(stencil_types[at + 5u]) * x;
    }
}

#endif
