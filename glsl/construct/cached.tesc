// The cached construction, in each draw: the control points are there (glsl/compute/control_points.comp). Compiled for
// patches whose corners own 4, 5 .. control points.
// variants: OWNED=4, OWNED=4+CAPTURE, OWNED=4+CAPTURE_POINTS, OWNED=4+TEXCOORD
// variants: OWNED=4+SHARED, OWNED=4+SHARED+CAPTURE, OWNED=4+SHARED+TEXCOORD, OWNED=4+DISPLACED, OWNED=4+DISPLACED+CAPTURE
// variants: OWNED=5, OWNED=5+CAPTURE, OWNED=5+CAPTURE_POINTS, OWNED=5+TEXCOORD
// variants: OWNED=5+SHARED, OWNED=5+SHARED+CAPTURE, OWNED=5+SHARED+TEXCOORD, OWNED=5+DISPLACED, OWNED=5+DISPLACED+CAPTURE
// variants: OWNED=6, OWNED=6+CAPTURE, OWNED=6+CAPTURE_POINTS, OWNED=6+TEXCOORD
// variants: OWNED=6+TRIANGLE, OWNED=6+TRIANGLE+CAPTURE, OWNED=6+TRIANGLE+CAPTURE_POINTS, OWNED=6+TRIANGLE+TEXCOORD
// variants: OWNED=6+PENTAGON, OWNED=6+PENTAGON+CAPTURE, OWNED=6+PENTAGON+CAPTURE_POINTS, OWNED=6+PENTAGON+TEXCOORD
// variants: OWNED=8, OWNED=8+CAPTURE, OWNED=8+CAPTURE_POINTS, OWNED=8+TEXCOORD
// variants: OWNED=5+TRIANGLE, OWNED=5+TRIANGLE+CAPTURE, OWNED=5+TRIANGLE+CAPTURE_POINTS, OWNED=5+TRIANGLE+TEXCOORD
// variants: OWNED=5+TRIANGLE+SHARED, OWNED=5+TRIANGLE+SHARED+CAPTURE, OWNED=5+TRIANGLE+SHARED+TEXCOORD, OWNED=5+TRIANGLE+DISPLACED, OWNED=5+TRIANGLE+DISPLACED+CAPTURE
#version 460
#extension GL_GOOGLE_include_directive : require
#ifndef OWNED
#define OWNED 4
#endif
#define KEPT_FRAMES
#include "construct/control.glsl"
#ifdef SHARED
#include "edges/shared.glsl"
#include "edges/write_shared.glsl"
#endif
#include "construct/cached.glsl"
#ifdef DISPLACED
#include "displace/corner_lod.glsl"
#endif

layout(location = 0) in uint in_patch_number[];

void main() {
    uint corner = draw.first_corner + in_patch_number[0] * CORNERS + uint(gl_InvocationID);
    vec4 texels[KEPT_TEXELS] = kept_texels(corner);
    for (int i = 0; i < OWNED; ++i) {
        own[i] = kept_vector(texels, i);
    }
#ifdef SHARED
    vec3 with[SHARED_VECTORS];
    for (int i = 0; i < SHARED_VECTORS; ++i) {
        with[i] = kept_vector(texels, OWNED + i);
    }
    float lod = 0.0;
#ifdef DISPLACED
    lod = corner_lod(corner, corner_speaker(corner, framed_ring(patch_corner(corner).x)));
#endif
    write_shared(corner, with, kept_number(texels, KEPT - 1), lod);
#endif
    finish_corner(in_patch_number[0]);
    barrier();
    finish_patch(in_patch_number[0]);
}
