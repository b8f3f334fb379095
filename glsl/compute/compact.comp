// Lists the patches of a draw that glsl/compute/cull.comp can see, in their order, and writes the indirect draws of them; with COPIES
// also copies what is kept of them to behind the list, one after the other, for instances to have it as attributes. One invocation
// for each patch. Rust twin: `Compact` in src/renderer/lists.rs.
// variants: COPIES
#version 460
#extension GL_GOOGLE_include_directive : require
#define MAKES_LISTS
#include "visible.glsl"
#ifdef COPIES
// Texel by texel: how many vectors there are is of no concern.
#define KEPT 4
#include "cached.glsl"

layout(constant_id = 0) const uint CORNERS = 4u;
#endif

const uint INVOCATIONS = 64u;
layout(local_size_x = 64) in;

layout(push_constant, std430) uniform Compact {
    uint count;                 // of all patches
    uint vertices;              // of a patch in a draw: the points of its corners, or the indices of a lattice
    uint first_index;           // of a lattice
    uint patches_per_instance;  // 0: an indexed draw with an instance for each
    uint first_corner;
    uint copies;                // the word of the list after its header where they start
} compact;

// Of each invocation whether its patch can be seen, and in the upper bits how many it found before this group; then how many of the
// group are before it.
shared uint found[INVOCATIONS];
shared uint before_group;
shared uint in_group;

void command(uint first, uvec4 words) {
    for (uint i = 0u; i < 4u; ++i) {
        visible.commands[first + i] = words[i];
    }
}

void write_commands(uint all) {
    if (compact.patches_per_instance == 0u) {
        // VkDrawIndexedIndirectCommand
        command(0u, uvec4(compact.vertices, all, compact.first_index, 0u));
        visible.commands[4] = 0u;
        return;
    }
    // VkDrawIndirectCommand: whole instances, and what is left as one more.
    uint whole = all / compact.patches_per_instance, rest = all % compact.patches_per_instance;
    command(0u, uvec4(compact.patches_per_instance * compact.vertices, whole, 0u, 0u));
    command(4u, uvec4(rest * compact.vertices, rest > 0u ? 1u : 0u, 0u, rest > 0u ? whole : 0u));
}

void main() {
    uint id = gl_LocalInvocationID.x;
    uint start = gl_WorkGroupID.x * INVOCATIONS, patch_number = start + id;
    bool is_visible = patch_number < compact.count && visible.patches[compact.count + patch_number] != 0u;
    uint before = 0u;
    for (uint i = id; i < start; i += INVOCATIONS) {
        before += visible.patches[compact.count + i];
    }
    found[id] = before << 8 | uint(is_visible);
    barrier();
    if (id == 0u) {
        uint here = 0u, earlier = 0u;
        for (uint i = 0u; i < INVOCATIONS; ++i) {
            uint each = found[i];
            found[i] = here;
            here += each & 255u;
            earlier += each >> 8;
        }
        before_group = earlier;
        in_group = here;
    }
    barrier();
    if (id == 0u && start + INVOCATIONS >= compact.count) {
        write_commands(before_group + in_group);
    }
    if (!is_visible) {
        return;
    }
    uint place = before_group + found[id];
    visible.patches[place] = patch_number;
#ifdef COPIES
    uint texels = CORNERS * STRIDE;
    for (uint i = 0u; i < texels; ++i) {
        uvec4 texel = floatBitsToUint(kept_texel(compact.first_corner + patch_number * CORNERS, i));
        uint to = compact.copies + 4u * (place * texels + i);
        for (uint j = 0u; j < 4u; ++j) {
            visible.patches[to + j] = texel[j];
        }
    }
#endif
}
