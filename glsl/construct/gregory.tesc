// Second stage of the two-stage construction: the control points of a Gregory patch from the frames of its corners.
// Rust twin: `gregory_points` in src/patch/gregory.rs.
// variants: TRIANGLE, CAPTURE, TRIANGLE+CAPTURE, CAPTURE_POINTS, TRIANGLE+CAPTURE_POINTS, TEXCOORD, TRIANGLE+TEXCOORD
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
#include "rings.glsl"

layout(location = 0) in vec3 in_centre[];
layout(location = 1) in vec4 in_limit[];
layout(location = 2) in vec3 in_tangent_a[];
layout(location = 3) in vec3 in_tangent_b[];
layout(location = 4) in uint in_patch_number[];

// f_k+ or f_k-: `near` and `far` are the edge points, `side` the transversal as seen from this face.
vec3 face_point(vec3 p, vec3 near, vec3 far, float cos_near, float cos_far, vec3 side) {
    const float d = CORNERS == 4u ? 3.0 : 4.0;
    return (cos_far * p + (d - 2.0 * cos_near - cos_far) * near + 2.0 * cos_near * far + side) / d;
}

void main() {
    uint k = uint(gl_InvocationID);
    uint next = k + 1u == CORNERS ? 0u : k + 1u;
    uint before = k == 0u ? CORNERS - 1u : k - 1u;
    uint patch_number = in_patch_number[0];
    uvec2 place = patch_corners[draw.first_corner + patch_number * CORNERS + k];
    Ring ring = ring_at(place.x);
    uint plus_index = place.y;
    uint minus_index = plus_index + 1u == ring.edges ? 0u : plus_index + 1u;

    vec3 centre = in_centre[k];
    vec3 p = in_limit[k].xyz;
    corner[gl_InvocationID] = p;
    edge_plus[gl_InvocationID] = edge_point(ring, plus_index, centre, p, in_tangent_a[k], in_tangent_b[k]);
    edge_minus[gl_InvocationID] = edge_point(ring, minus_index, centre, p, in_tangent_a[k], in_tangent_b[k]);
    barrier();
    float cosine = in_limit[k].w;
    face_plus[gl_InvocationID] = face_point(p, edge_plus[k], edge_minus[next], cosine, in_limit[next].w,
                                            transversal(ring, plus_index, centre));
    // The face lies on the right of its minus edge.
    face_minus[gl_InvocationID] = face_point(p, edge_minus[k], edge_plus[before], cosine, in_limit[before].w,
                                             -transversal(ring, minus_index, centre));
    finish_corner(patch_number, CORNERS);
}
