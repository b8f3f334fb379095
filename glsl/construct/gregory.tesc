// Second stage of the two-stage construction: the control points of a Gregory patch from the frames of its corners.
// Each corner owns p, e+, e-, f+, f-. Rust twin: `gregory_points` in src/patch/gregory.rs.
// variants: CAPTURE, CAPTURE_POINTS, TEXCOORD, SHARED, SHARED+CAPTURE, SHARED+TEXCOORD, DISPLACED, DISPLACED+CAPTURE
// variants: TRIANGLE, TRIANGLE+CAPTURE, TRIANGLE+CAPTURE_POINTS, TRIANGLE+TEXCOORD, TRIANGLE+SHARED, TRIANGLE+SHARED+CAPTURE, TRIANGLE+SHARED+TEXCOORD, TRIANGLE+DISPLACED, TRIANGLE+DISPLACED+CAPTURE
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 5
#include "control.glsl"
#include "frames.glsl"

// The transversal of corner k, this invocation's, at its ring edge j.
vec3 corner_transversal(Corner corner, uint k, uint j) {
    return scheme_transversal(corner.ring, j, in_centre[k], in_tangent_a[k], in_tangent_b[k]);
}

// f+ or f-: `near` and `far` are the edge points, `side` the transversal as seen from this face.
vec3 face_point(vec3 p, vec3 near, vec3 far, float cos_near, float cos_far, vec3 side) {
    const float d = CORNERS == 4u ? 3.0 : 4.0;
    return (cos_far * p + (d - 2.0 * cos_near - cos_far) * near + 2.0 * cos_near * far + side) / d;
}

void main() {
    uint k = uint(gl_InvocationID);
    uint next = k + 1u == CORNERS ? 0u : k + 1u;
    uint before = k == 0u ? CORNERS - 1u : k - 1u;
    Corner corner = corner_at(k);
    vec3 p = in_limit[k].xyz;
    vec3 plus = corner_edge_point(corner, k, corner.plus);
    vec3 minus = corner_edge_point(corner, k, corner.minus);
    owned[gl_InvocationID][0] = p;
    owned[gl_InvocationID][1] = plus;
    owned[gl_InvocationID][2] = minus;
    barrier();
    float cosine = in_limit[k].w;
    owned[gl_InvocationID][3] = face_point(p, plus, owned[next][2], cosine, in_limit[next].w,
                                           corner_transversal(corner, k, corner.plus));
    // The face lies on the right of its minus edge.
    owned[gl_InvocationID][4] = face_point(p, minus, owned[before][1], cosine, in_limit[before].w,
                                           -corner_transversal(corner, k, corner.minus));
    finish_framed_corner(corner, k);
    barrier();
    finish_patch(in_patch_number[0]);
}
