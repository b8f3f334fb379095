// Second stage of the two-stage construction for regular faces: a bicubic Bezier patch from the frames of its corners.
// variants: CAPTURE, CAPTURE_POINTS, TEXCOORD, SHARED, SHARED+CAPTURE, SHARED+TEXCOORD, DISPLACED, DISPLACED+CAPTURE
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 4
#include "construct/control.glsl"
#include "construct/frames.glsl"
#include "construct/bicubic_points.glsl"

void main() {
    uint k = uint(gl_InvocationID);
    bicubic_points(k);
    finish_framed_corner(k);
    barrier();
    finish_patch(in_patch_number[0]);
}
