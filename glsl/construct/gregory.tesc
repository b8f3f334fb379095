// Second stage of the two-stage construction: the control points of a Gregory patch from the frames of its corners.
// variants: CAPTURE, CAPTURE_POINTS, TEXCOORD, SHARED, SHARED+CAPTURE, SHARED+TEXCOORD, DISPLACED, DISPLACED+CAPTURE
// variants: TRIANGLE, TRIANGLE+CAPTURE, TRIANGLE+CAPTURE_POINTS, TRIANGLE+TEXCOORD, TRIANGLE+SHARED, TRIANGLE+SHARED+CAPTURE, TRIANGLE+SHARED+TEXCOORD, TRIANGLE+DISPLACED, TRIANGLE+DISPLACED+CAPTURE
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 5
#define INNER 2
#include "construct/control.glsl"
#include "construct/frames.glsl"
#include "construct/gregory_points.glsl"

void main() {
    uint k = uint(gl_InvocationID);
    gregory_points(k);
    finish_framed_corner(k);
    barrier();
    finish_patch(in_patch_number[0]);
}
