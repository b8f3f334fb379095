// Second stage of the two-stage construction for regular faces: a bicubic Bezier patch from the frames of its corners.
// Each corner owns its corner point, two edge points and an inner point. Rust twin: `bicubic_points` in
// src/patch/bicubic.rs.
// variants: CAPTURE, CAPTURE_POINTS, TEXCOORD, SHARED, SHARED+CAPTURE, SHARED+TEXCOORD, DISPLACED, DISPLACED+CAPTURE
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 4
#include "control.glsl"
#include "frames.glsl"

void main() {
    uint k = uint(gl_InvocationID);
    Corner corner = corner_at(k);
    vec3 centre = in_centre[k];
    owned[gl_InvocationID][0] = in_limit[k].xyz;
    owned[gl_InvocationID][1] = corner_edge_point(corner, k, corner.plus);
    owned[gl_InvocationID][2] = corner_edge_point(corner, k, corner.minus);
    owned[gl_InvocationID][3] =
        (4.0 * centre + 2.0 * (in_centre[(k + 1u) & 3u] + in_centre[(k + 3u) & 3u]) + in_centre[(k + 2u) & 3u]) / 9.0;
    finish_framed_corner(corner, k);
    barrier();
    finish_patch(in_patch_number[0]);
}
