// The stencil construction: every control point is a weighted sum of the vertices around the patch, with the weights of
// its type of connectivity (Loop et al. 2009, section 4).
// variants: TRIANGLE, REGULAR, CAPTURE, TRIANGLE+CAPTURE, REGULAR+CAPTURE, CAPTURE_POINTS, TRIANGLE+CAPTURE_POINTS, REGULAR+CAPTURE_POINTS, TEXCOORD, TRIANGLE+TEXCOORD, REGULAR+TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require

#ifdef TRIANGLE
const uint CORNERS = 3u;
layout(vertices = 3) out;
#else
const uint CORNERS = 4u;
layout(vertices = 4) out;
#endif
#include "control.glsl"
#include "stencils.glsl"

layout(location = 4) in uint in_patch_number[];

void main() {
    uint patch_number = in_patch_number[0];
    vec3 p, plus, minus, f_plus, f_minus;
    stencil_points(draw.first_patch + patch_number, uint(gl_InvocationID), p, plus, minus, f_plus, f_minus);
    corner[gl_InvocationID] = p;
    edge_plus[gl_InvocationID] = plus;
    edge_minus[gl_InvocationID] = minus;
    face_plus[gl_InvocationID] = f_plus;
#ifndef REGULAR
    face_minus[gl_InvocationID] = f_minus;
#endif
    finish_corner(patch_number, CORNERS);
}
