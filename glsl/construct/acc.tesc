// Second stage of the two-stage construction: an ACC patch from its corners' rings. Each corner owns b at the corner, along
// its plus and minus edge and inside, then t+, t-, x+, x-. Rust twin: `acc_points` in src/patch/acc.rs.
// variants: CAPTURE, CAPTURE_POINTS, TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 8
// The others are tangents.
#define HULL 4
#define INNER 5
#include "control.glsl"
#include "frames.glsl"
#include "acc.glsl"

void main() {
    uint k = uint(gl_InvocationID);
    uint next = (k + 1u) & 3u;
    uint before = (k + 3u) & 3u;
    vec3 inner = in_inner[k][0], along_plus = in_inner[k][3], along_minus = in_inner[k][4];
    vec3 t_plus = 3.0 * in_plus[k];
    vec3 t_minus = 3.0 * in_minus[k];
    owned[gl_InvocationID][0] = in_limit[k].xyz;
    owned[gl_InvocationID][1] = along_plus;
    owned[gl_InvocationID][2] = along_minus;
    owned[gl_InvocationID][3] = inner;
    owned[gl_InvocationID][4] = t_plus;
    owned[gl_InvocationID][5] = t_minus;
    float cosine = in_limit[k].w;
    owned[gl_InvocationID][6] = acc_across(inner, in_inner[k][1], along_plus, in_inner[next][4], t_plus, cosine,
                                           in_limit[next].w);
    owned[gl_InvocationID][7] = acc_across(inner, in_inner[k][2], along_minus, in_inner[before][3], t_minus, cosine,
                                           in_limit[before].w);
    finish_framed_corner(k);
    barrier();
    finish_patch(in_patch_number[0]);
}
