// Control vertices from a buffer that the device wrote, once a frame in which they moved. One invocation for each.
#version 460
#extension GL_GOOGLE_include_directive : require
#define POSITIONS_ACCESS
#define OWN_INVOCATIONS
#include "constants.glsl"
#include "draw/invocation.glsl"
#include "draw/positions.glsl"

// Words, for the bits to stay.
layout(set = 2, binding = 0, std430) readonly buffer Given { uint given[]; };

// Rust twin: `Gathered` in src/renderer/model/gather.rs.
layout(push_constant, std430) uniform Gathered {
    uint count;
    uint first;   // word of the first position
    uint stride;  // words from one to the next
} gathered;

void main() {
    uint vertex = invocation_number();
    if (vertex >= gathered.count) {
        return;
    }
    uint word = gathered.first + vertex * gathered.stride;
    positions[vertex] = uintBitsToFloat(uvec4(given[word], given[word + 1u], given[word + 2u], 0u));
}
