// Second stage of the two-stage construction: the control points of a patch from what its corners took from their rings.
#version 460
#extension GL_GOOGLE_include_directive : require
#define CONTROL_STAGE
#include "construct/control.glsl"
#include "construct/frames.glsl"
#include "scheme_points.glsl"

#define STEP(f) f(k);
#define BETWEEN barrier();

void main() {
    uint k = uint(gl_InvocationID);
    uint patch_number = take_instance(in_patch_number[0]);
    POINT_STEPS
    finish_framed_corner(patch_number, k);
    barrier();
    finish_patch(patch_number);
}
