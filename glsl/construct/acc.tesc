// Second stage of the two-stage construction: an ACC patch from its corners' rings.
// variants: CAPTURE, CAPTURE_POINTS, TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 8
#define INNER 5
#include "construct/control.glsl"
#include "construct/frames.glsl"
#include "construct/acc_points.glsl"

void main() {
    uint k = uint(gl_InvocationID);
    acc_points(k);
    finish_framed_corner(k);
    barrier();
    finish_patch(in_patch_number[0]);
}
