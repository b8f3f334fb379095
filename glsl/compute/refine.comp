// Vertices of adaptive subdivision, once a frame in which the control vertices moved: each a weighted sum of vertices before it. One
// invocation for each. Rust twin: `Plan::row` in src/adaptive/rows.rs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "constants.glsl"
#include "draw/invocation.glsl"
#include "draw/tables.glsl"

layout(set = 1, binding = BINDING_POSITIONS, std430) buffer Positions { vec4 positions[]; };

void main() {
    uint index = invocation_number();
    if (index >= invocations.count) {
        return;
    }
    uvec2 block = table_pairs[tables.blocks / 2u + invocations.first_block + index / invocations.rows_of_block];
    uint mask = tables.mask_starts + block.x + index % invocations.rows_of_block;
    uint vertices = tables.block_vertices + block.y;
    uint start = table_words[mask], end = table_words[mask + 1u];
    // As seen from the first of them, for sums to keep the bits of small cells: weights add up to one.
    vec3 origin = positions[table_words[vertices + table_pairs[tables.mask_terms / 2u + start].x]].xyz;
    precise vec3 sum = vec3(0.0);
    for (uint i = start; i < end; ++i) {
        uvec2 term = table_pairs[tables.mask_terms / 2u + i];
        precise vec3 seen = positions[table_words[vertices + term.x]].xyz - origin;
        sum = sum + uintBitsToFloat(term.y) * seen;
    }
    precise vec3 vertex = origin + sum;
    positions[invocations.first_vertex + invocations.first + index] = vec4(vertex, 0.0);
}
