// The cached construction, once a frame, after glsl/compute/frames.comp: what the corners of a patch own and share. The two stages
// of the two-stage construction in one invocation for each patch.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef DISPLACED
#define SHARED
#endif
#define KEPT_FRAMES true
#define MAKES_POINTS
#include "construct/cached.glsl"
#include "draw/invocation.glsl"
#include "construct/two_stages.glsl"

void main() {
    uint index = invocation_number();
    if (index >= invocations.count) {
        return;
    }
    uint first = invocations.first + index * CORNERS;
    for (uint k = 0u; k < CORNERS; ++k) {
        corners[k] = corner_of_patch(first + k);
#ifdef SHARED
        for (uint i = 0u; i < SHARED_VECTORS; ++i) {
            keep_vector(first + k, OWNED + i, corners[k].with[i]);
        }
        keep_number(first + k, 3u * (OWNED + SHARED_VECTORS), corner_sharp(first + k));
#endif
    }
    second_stage();
    for (uint k = 0u; k < CORNERS; ++k) {
        for (uint i = 0u; i < OWNED; ++i) {
            keep_vector(first + k, i, owned[k][i]);
        }
    }
}
