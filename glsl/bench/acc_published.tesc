// ACC as published (Loop and Schaefer 2008), for the bench: the control shader hands on what the tangents are made of.
// Each corner owns b at the corner, along its plus and minus edge and inside, then t+ and t-. Otherwise as
// glsl/construct/acc.tesc, in whose place it is drawn.
#version 460
#extension GL_GOOGLE_include_directive : require
#define CORNERS 4
#define OWNED 6
// The others are tangents.
#define HULL 4
#include "construct/control.glsl"
#include "construct/frames.glsl"

layout(location = 11) patch out vec4 cosines;

void main() {
    uint k = uint(gl_InvocationID);
    OWNED_BY(k)[0] = in_limit(k);
    OWNED_BY(k)[1] = in_inner(k, 3);
    OWNED_BY(k)[2] = in_inner(k, 4);
    OWNED_BY(k)[3] = in_inner(k, 0);
    OWNED_BY(k)[4] = 3.0 * in_plus(k);
    OWNED_BY(k)[5] = 3.0 * in_minus(k);
    if (gl_InvocationID == 0) {
        cosines = vec4(in_cosine(0), in_cosine(1), in_cosine(2), in_cosine(3));
    }
    finish_framed_corner(in_patch_number[0], k);
    barrier();
    finish_patch(in_patch_number[0]);
}
