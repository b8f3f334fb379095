// Second stage of the two-stage construction: a Pm-patch (of a quad: a c-patch) from its corners' rings.
// variants: TRIANGLE, CAPTURE, TRIANGLE+CAPTURE, CAPTURE_POINTS, TRIANGLE+CAPTURE_POINTS, TEXCOORD, TRIANGLE+TEXCOORD
// variants: PENTAGON, PENTAGON+CAPTURE, PENTAGON+CAPTURE_POINTS, PENTAGON+TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 6
#define INNER 3
#define OWNED_IS_SHARED
#include "construct/control.glsl"
#include "construct/frames.glsl"

// What each corner gives to the centre of the patch.
layout(location = 14) patch out vec3 centre_share[CORNERS];
#ifdef PENTAGON
// The sum of b112 of sectors i - 1 and i.
layout(location = 19) patch out vec3 b112_sum[CORNERS];
#endif

#include "construct/pm_points.glsl"

void main() {
    uint k = uint(gl_InvocationID);
    pm_outer_points(k);
    barrier();
    pm_points_beside(k);
    barrier();
#ifdef PENTAGON
    pm_sum_inside(k);
    barrier();
#endif
    pm_point_inside(k);
    finish_framed_corner(k);
    barrier();
    finish_patch(in_patch_number[0]);
}
