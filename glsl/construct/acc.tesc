// Second stage of the two-stage construction: an ACC patch from its corners' rings. Each corner owns b at the corner, along
// its plus and minus edge and inside, then t+, t-, x+, x-. Rust twin: `acc_points` in src/patch/acc.rs.
// variants: CAPTURE, CAPTURE_POINTS, TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 8
// The others are tangents.
#define HULL 4
#include "control.glsl"
#include "frames.glsl"

// The number of edges around the vertex, were it inside.
float acc_valence(Ring ring) {
    return float(ring.faces) * (ring.open ? (ring.cone ? 4.0 : 2.0) : 1.0);
}

// The inner point of ring face i; `first` and `second` are the ends of its edges.
vec3 acc_inner(Ring ring, uint i, vec3 centre, vec3 first, vec3 second) {
    float n = acc_valence(ring);
    uint entry = ring_entries[ring.entries + 2u * i + 1u];
    // A triangle acts through its centroid.
    bool triangle = (entry & TRIANGLE_BIT) != 0u;
    vec3 diagonal = triangle ? (centre + first + second) / 3.0 : vertex_position(entry);
    return (n * centre + 2.0 * (first + second) + diagonal) / (n + 5.0);
}

// The point between the faces of ring edge j.
vec3 acc_edge(Ring ring, uint j, vec3 centre) {
    vec3 here = edge_neighbour(ring, j);
    if (ring.open && (j == 0u || j == ring.faces)) {
        return (2.0 * centre + here) / 3.0;
    }
    uint before_j = (j == 0u ? ring.edges : j) - 1u;
    vec3 before = acc_inner(ring, before_j, centre, edge_neighbour(ring, before_j), here);
    vec3 after = acc_inner(ring, j, centre, here, edge_neighbour(ring, j + 1u));
    // One sum for both faces.
    precise vec3 edge = 0.5 * (before + after);
    return edge;
}

// x+ or x-: `near` and `far` are the geometry's points along the edge, `middle` is that between its faces.
vec3 acc_across(vec3 inner, vec3 middle, vec3 near, vec3 far, vec3 tangent, float cos_near, float cos_far) {
    return 2.0 * cos_near * (far - near) - (cos_far / 3.0) * tangent + 3.0 * (inner - middle);
}

void main() {
    uint k = uint(gl_InvocationID);
    uint next = (k + 1u) & 3u;
    uint before = (k + 3u) & 3u;
    Corner corner = corner_at(k);
    vec3 centre = in_centre[k];
    vec3 p = in_limit[k].xyz;
    vec3 middle_plus = acc_edge(corner.ring, corner.plus, centre);
    vec3 middle_minus = acc_edge(corner.ring, corner.minus, centre);
    vec3 e_plus = corner_edge_point(corner, k, corner.plus);
    vec3 e_minus = corner_edge_point(corner, k, corner.minus);
    // Where a face falls back, the curve along the edge is the frame's.
    vec3 along_plus = corner.ring.fallback ? e_plus : middle_plus;
    vec3 along_minus = corner.ring.fallback ? e_minus : middle_minus;
    vec3 inner = acc_inner(corner.ring, corner.plus, centre, edge_neighbour(corner.ring, corner.plus),
                           edge_neighbour(corner.ring, corner.minus));
    vec3 t_plus = 3.0 * (e_plus - p);
    vec3 t_minus = 3.0 * (e_minus - p);
    owned[gl_InvocationID][0] = p;
    owned[gl_InvocationID][1] = along_plus;
    owned[gl_InvocationID][2] = along_minus;
    owned[gl_InvocationID][3] = inner;
    owned[gl_InvocationID][4] = t_plus;
    owned[gl_InvocationID][5] = t_minus;
    barrier();
    float cosine = in_limit[k].w;
    owned[gl_InvocationID][6] = acc_across(inner, middle_plus, along_plus, owned[next][2], t_plus, cosine,
                                           in_limit[next].w);
    owned[gl_InvocationID][7] = acc_across(inner, middle_minus, along_minus, owned[before][1], t_minus, cosine,
                                           in_limit[before].w);
    finish_corner(in_patch_number[0]);
    barrier();
    finish_patch(in_patch_number[0]);
}
