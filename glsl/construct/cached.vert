// The cached construction, in each draw: what a corner of a patch owns and shares, as glsl/compute/control_points.comp left it.
// Compiled for patches whose corners own 4, 5 .. control points. One invocation for each corner of each patch.
// variants: OWNED=4, OWNED=5, OWNED=6, OWNED=8, OWNED=4+SHARED, OWNED=5+SHARED, OWNED=4+DISPLACED, OWNED=5+DISPLACED
#version 460
#extension GL_GOOGLE_include_directive : require
#ifndef OWNED
#define OWNED 4
#endif
#ifdef DISPLACED
#define SHARED
#endif
#define KEPT_FRAMES
#include "draw.glsl"
#ifdef SHARED
#include "shared.glsl"
#endif
#include "cached.glsl"
#include "visible.glsl"
#ifdef DISPLACED
#include "corner_lod.glsl"
#endif

layout(constant_id = 0) const uint CORNERS = 4u;

layout(location = 0) out vec3 owned[OWNED];
layout(location = 8) out uint patch_number;
#ifdef SHARED
layout(location = 7) out uint shared_bits;
layout(location = 9) out vec3 shared_with[SHARED_VECTORS];
#ifdef DISPLACED
layout(location = 6) out float shared_lod;
#endif
#endif

void main() {
    // Not gl_PrimitiveID: lavapipe restarts it (bug B).
    uint vertex = uint(gl_VertexIndex);
    uint first = uint(gl_InstanceIndex) * draw.patches_per_instance;
    patch_number = patch_drawn(first + vertex / CORNERS);
    uint corner = draw.first_corner + patch_number * CORNERS + vertex % CORNERS;
    vec4 texels[KEPT_TEXELS] = kept_texels(corner);
    for (int i = 0; i < OWNED; ++i) {
        owned[i] = kept_vector(texels, i);
    }
#ifdef SHARED
    for (int i = 0; i < SHARED_VECTORS; ++i) {
        shared_with[i] = kept_vector(texels, OWNED + i);
    }
    shared_bits = kept_bits(texels);
#ifdef DISPLACED
    shared_lod = corner_lod(corner, corner_speaker(corner, framed_ring(patch_corner(corner).x)));
#endif
#endif
}
