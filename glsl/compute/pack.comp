// Lists the patches of a draw that glsl/compute/cull.comp can see, in their order, and writes the indirect draws of them. One
// workgroup. Rust twin: `Pack` in src/renderer/lists.rs.
#version 460
#extension GL_GOOGLE_include_directive : require
#define MAKES_LISTS
#include "visible.glsl"

const uint INVOCATIONS = 64u;
layout(local_size_x = 64) in;

layout(push_constant, std430) uniform Pack {
    uint count;                 // of all patches
    uint vertices;              // of a patch in a draw: the points of its corners, or the indices of a lattice
    uint first_index;           // of a lattice
    uint patches_per_instance;  // 0: an indexed draw with an instance for each
} pack;

shared uint found[INVOCATIONS];

void command(uint first, uvec4 words) {
    for (uint i = 0u; i < 4u; ++i) {
        visible.commands[first + i] = words[i];
    }
}

void main() {
    // Each takes a run.
    uint id = gl_LocalInvocationID.x;
    uint length = (pack.count + INVOCATIONS - 1u) / INVOCATIONS;
    uint start = min(id * length, pack.count), end = min(start + length, pack.count);
    uint own = 0u;
    for (uint i = start; i < end; ++i) {
        own += visible.patches[pack.count + i];
    }
    found[id] = own;
    barrier();
    uint before = 0u, all = 0u;
    for (uint i = 0u; i < INVOCATIONS; ++i) {
        before += i < id ? found[i] : 0u;
        all += found[i];
    }
    for (uint i = start; i < end; ++i) {
        if (visible.patches[pack.count + i] != 0u) {
            visible.patches[before] = i;
            ++before;
        }
    }
    if (id != 0u) {
        return;
    }
    if (pack.patches_per_instance == 0u) {
        // VkDrawIndexedIndirectCommand
        command(0u, uvec4(pack.vertices, all, pack.first_index, 0u));
        visible.commands[4] = 0u;
        return;
    }
    // VkDrawIndirectCommand: whole instances, and what is left as one more.
    uint whole = all / pack.patches_per_instance, rest = all % pack.patches_per_instance;
    command(0u, uvec4(pack.patches_per_instance * pack.vertices, whole, 0u, 0u));
    command(4u, uvec4(rest * pack.vertices, rest > 0u ? 1u : 0u, 0u, rest > 0u ? whole : 0u));
}
