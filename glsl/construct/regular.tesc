// Second stage of the two-stage construction for regular faces: a bicubic Bezier patch from the frames of its corners.
// Rust twin: `bicubic_points` in src/patch/bicubic.rs.
// variants: CAPTURE, CAPTURE_POINTS, TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#define REGULAR
layout(vertices = 4) out;
#include "control.glsl"
#include "rings.glsl"

layout(location = 0) in vec3 in_centre[];
layout(location = 1) in vec4 in_limit[];
layout(location = 2) in vec3 in_tangent_a[];
layout(location = 3) in vec3 in_tangent_b[];
layout(location = 4) in uint in_patch_number[];

void main() {
    uint k = uint(gl_InvocationID);
    uint patch_number = in_patch_number[0];
    uvec2 place = patch_corners[draw.first_corner + patch_number * 4u + k];
    Ring ring = ring_at(place.x);
    uint minus_index = place.y + 1u == ring.edges ? 0u : place.y + 1u;
    vec3 centre = in_centre[k];
    vec3 p = in_limit[k].xyz;
    corner[gl_InvocationID] = p;
    edge_plus[gl_InvocationID] = edge_point(ring, place.y, centre, p, in_tangent_a[k], in_tangent_b[k]);
    edge_minus[gl_InvocationID] = edge_point(ring, minus_index, centre, p, in_tangent_a[k], in_tangent_b[k]);
    face_plus[gl_InvocationID] =
        (4.0 * centre + 2.0 * (in_centre[(k + 1u) & 3u] + in_centre[(k + 3u) & 3u]) + in_centre[(k + 2u) & 3u]) / 9.0;
    finish_corner(patch_number, 4u);
}
