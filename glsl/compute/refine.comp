// Vertices of adaptive subdivision, once a frame in which the control vertices moved: each a weighted sum of vertices before it. One
// invocation for each. Rust twin: `Plan::row` in src/adaptive/rows.rs.
#version 460
#extension GL_GOOGLE_include_directive : require
#define POSITIONS_ACCESS
#include "constants.glsl"
#include "draw/invocation.glsl"
#include "draw/positions.glsl"
#include "draw/tables.glsl"

layout(set = 1, binding = BINDING_TABLE_TEXELS + 6) uniform usamplerBuffer block_texels;
layout(set = 1, binding = BINDING_TABLE_TEXELS + 7) uniform usamplerBuffer block_vertex_texels;
layout(set = 1, binding = BINDING_TABLE_TEXELS + 8) uniform samplerBuffer mask_weight_texels;

// The first four of the weights of a block's mask, and of its vertices.
uvec2 block_at(uint i) {
    return READS_TEXELS ? texelFetch(block_texels, int(i)).xy : table_pairs[tables.blocks / 2u + i];
}

uvec4 block_vertices(uint i) {
    return READS_TEXELS ? texelFetch(block_vertex_texels, int(i)) : table_fours[tables.block_vertices / 4u + i];
}

vec4 mask_weights(uint i) {
    return READS_TEXELS ? texelFetch(mask_weight_texels, int(i))
                        : uintBitsToFloat(table_fours[tables.mask_weights / 4u + i]);
}

void main() {
    uint index = invocation_number();
    if (index >= invocations.count) {
        return;
    }
    uint number = invocations.first_block + index / invocations.rows_of_block;
    uvec2 block = block_at(number);
    uint fours = block_at(number + 1u).y - block.y;
    uint weights = block.x + index % invocations.rows_of_block * fours;
    // As seen from one of them, for sums to keep the bits of small cells: weights add up to one.
    vec3 origin = vertex_position(block_vertices(block.y).x);
    precise vec3 sum = vec3(0.0);
    for (uint i = 0u; i < fours; ++i) {
        uvec4 vertices = block_vertices(block.y + i);
        vec4 weight = mask_weights(weights + i);
        for (uint k = 0u; k < 4u; ++k) {
            precise vec3 seen = vertex_position(vertices[k]) - origin;
            sum = sum + weight[k] * seen;
        }
    }
    precise vec3 vertex = origin + sum;
    positions[invocations.first_vertex + invocations.first + index] = vec4(vertex, 0.0);
}
