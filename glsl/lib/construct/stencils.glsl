// The stencil table. Rust twin: src/table/stencils.rs.
#ifndef STENCILS_GLSL
#define STENCILS_GLSL

#include "constants.glsl"
#include "draw/positions.glsl"
#include "draw/tables.glsl"

const uint ENTRY_WORDS = 1u + OWNED;

// Control points that a corner of a patch with `corners` corners owns. Points that faces around the corner share have the same bits
// for all of them: the sums go around the corner's ring from where it starts.
void stencil_points(uint patch_index, uint corner, uint corners, out vec3 points[OWNED]) {
    // Where the vertices of the patch and the weights of its type start.
    uvec2 place = table_pairs[tables.stencil_patches / 2u + patch_index]
        + uvec2(tables.stencil_vertices, tables.stencil_types);
    uint head = place.y + HEAD_WORDS * corner;
    uint first = place.y + table_words[head];
    uint count = table_words[head + 1u];
    uint turning = table_words[head + 2u];
    uint turn = table_words[place.x + corner];
    precise vec3 sums[OWNED];
    for (uint i = 0u; i < OWNED; ++i) {
        sums[i] = vec3(0.0);
    }
    for (uint i = 0u; i < count; ++i) {
        uint turned = i + turn - 1u;
        turned = 1u + (turned < turning ? turned : turned - turning);
        uint at = first + ENTRY_WORDS * (i >= 1u && i <= turning ? turned : i);
        vec3 x = vertex_position(table_words[place.x + corners + table_words[at]]);
        for (uint k = 0u; k < OWNED; ++k) {
            precise vec3 term = uintBitsToFloat(table_words[at + 1u + k]) * x;
            sums[k] += term;
        }
    }
    points = sums;
}

#endif
