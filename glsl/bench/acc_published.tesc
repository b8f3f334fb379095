// ACC as published (Loop and Schaefer 2008), for the bench: the control shader hands on what the tangents are made of.
// Each corner owns b at the corner, along its plus and minus edge and inside, then t+ and t-. Otherwise as
// glsl/construct/acc.tesc, in whose place it is drawn.
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 6
// The others are tangents.
#define HULL 4
#define INNER 5
#include "control.glsl"
#include "frames.glsl"

layout(location = 6) patch out vec4 cosines;

void main() {
    uint k = uint(gl_InvocationID);
    owned[gl_InvocationID][0] = in_limit[k].xyz;
    owned[gl_InvocationID][1] = in_inner[k][3];
    owned[gl_InvocationID][2] = in_inner[k][4];
    owned[gl_InvocationID][3] = in_inner[k][0];
    owned[gl_InvocationID][4] = 3.0 * in_plus[k];
    owned[gl_InvocationID][5] = 3.0 * in_minus[k];
    if (gl_InvocationID == 0) {
        cosines = vec4(in_limit[0].w, in_limit[1].w, in_limit[2].w, in_limit[3].w);
    }
    finish_framed_corner(k);
    barrier();
    finish_patch(in_patch_number[0]);
}
