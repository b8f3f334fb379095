// Copies what is kept of the patches on a list to behind the list, one after the other, for instances to have it as attributes. One
// invocation for each corner of as many patches as there may be. Rust twin: `Gather` in src/renderer/lists.rs.
#version 460
#extension GL_GOOGLE_include_directive : require
#define MAKES_LISTS
#define KEPT 4
#include "cached.glsl"
#include "visible.glsl"

layout(local_size_x = 64) in;

layout(push_constant, std430) uniform Gather {
    uint first_corner;
    uint copies;  // the word of the list after its header where the copies start
} gather;

layout(constant_id = 0) const uint CORNERS = 4u;

void main() {
    uint place = gl_GlobalInvocationID.x / CORNERS, corner = gl_GlobalInvocationID.x % CORNERS;
    // The instances of the indexed draw.
    if (place >= visible.commands[1]) {
        return;
    }
    uint from = gather.first_corner + visible.patches[place] * CORNERS + corner;
    uint to = gather.copies + 4u * STRIDE * gl_GlobalInvocationID.x;
    for (uint i = 0u; i < STRIDE; ++i) {
        uvec4 texel = floatBitsToUint(kept_texel(from, i));
        for (uint j = 0u; j < 4u; ++j) {
            visible.patches[to + 4u * i + j] = texel[j];
        }
    }
}
