// Second stage of the two-stage construction for regular faces: a bicubic Bezier patch from the frames of its corners.
// Each corner owns its corner point and, as seen from there, two edge points and an inner point. Rust twin: `bicubic_points` in
// src/patch/bicubic.rs.
// variants: CAPTURE, CAPTURE_POINTS, TEXCOORD, SHARED, SHARED+CAPTURE, SHARED+TEXCOORD, DISPLACED, DISPLACED+CAPTURE
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 4
#include "control.glsl"
#include "frames.glsl"

void main() {
    uint k = uint(gl_InvocationID);
    vec3 p = in_limit[k].xyz;
    owned[gl_InvocationID][0] = p;
    owned[gl_InvocationID][1] = in_plus[k];
    owned[gl_InvocationID][2] = in_minus[k];
    vec3 beside = in_centre[(k + 1u) & 3u] + in_centre[(k + 3u) & 3u];
    owned[gl_InvocationID][3] = (4.0 * in_centre[k] + 2.0 * beside + in_centre[k ^ 2u]) / 9.0 - p;
    finish_framed_corner(k);
    barrier();
    finish_patch(in_patch_number[0]);
}
