// Which patches of a draw can be seen: of cached control points, one invocation for each patch, by the rules of the control
// shaders. glsl/compute/compact.comp lists them.
// variants: OWNED=5, OWNED=5+TRIANGLE, OWNED=8
#version 460
#extension GL_GOOGLE_include_directive : require
#ifndef OWNED
#define OWNED 4
#endif
#ifdef TRIANGLE
#define CORNERS 3
#else
#define CORNERS 4
#endif
#define MAKES_LISTS
#include "cached.glsl"
#include "draw.glsl"
#include "visible.glsl"

layout(local_size_x = 64) in;

vec3 owned[CORNERS][OWNED];
uint outside[CORNERS];
vec4 pixel_box[CORNERS];
#include "culling.glsl"
#include "edge_factors.glsl"

void main() {
    uint patch_number = gl_GlobalInvocationID.x;
    uint count = draw.patches_per_instance;
    if (patch_number >= count) {
        return;
    }
    for (uint k = 0u; k < CORNERS; ++k) {
        vec4 texels[KEPT_TEXELS] = kept_texels(draw.first_corner + patch_number * CORNERS + k);
        for (int i = 0; i < OWNED; ++i) {
            owned[k][i] = kept_vector(texels, i);
        }
    }
    float smallest = MAX_FACTOR;
    for (uint k = 0u; k < CORNERS; ++k) {
        Examined examined = examine(k);
        outside[k] = examined.outside;
        pixel_box[k] = examined.pixel_box;
        smallest = min(smallest, within_limits(plus_factor(patch_number, k)));
    }
    visible.patches[count + patch_number] = is_culled(1.0 / smallest) ? 0u : 1u;
}
