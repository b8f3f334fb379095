// What a corner of an ACC patch takes from its ring: its inner point, the points between the faces at its edges, and those of
// the boundary curves there.
#ifndef CORNER_ACC_GLSL
#define CORNER_ACC_GLSL

#include "construct/corner_faces.glsl"

// The number of edges around the vertex, were it inside.
float acc_valence(Ring ring) {
    return float(ring.faces) * (ring.open ? (ring.cone ? 4.0 : 2.0) : 1.0);
}

// The inner point of a face; `first` and `second` are the ends of its edges.
vec3 acc_inner(float n, Face face, vec3 centre, vec3 first, vec3 second) {
    // A triangle acts through its centroid.
    vec3 diagonal = face.triangle ? (centre + first + second) / 3.0 : face.diagonal;
    return (n * centre + 2.0 * (first + second) + diagonal) / (n + 5.0);
}

vec3[INNER] acc_corner(Ring ring, CornerFaces at, vec3 p, vec3 plus, vec3 minus) {
    vec3 inner[INNER];
    float n = acc_valence(ring);
    vec3 before = acc_inner(n, at.face_before, at.centre, at.before, at.here);
    inner[0] = acc_inner(n, at.face, at.centre, at.here, at.next);
    vec3 after = acc_inner(n, at.face_after, at.centre, at.next, at.after);
    // One sum for both faces at an edge.
    precise vec3 at_plus = 0.5 * (before + inner[0]);
    precise vec3 at_minus = 0.5 * (inner[0] + after);
    inner[1] = at.has_before ? at_plus : (2.0 * at.centre + at.here) / 3.0;
    inner[2] = at.has_after ? at_minus : (2.0 * at.centre + at.next) / 3.0;
    // Where a face falls back, the curve along the edge is the frame's.
    inner[3] = ring.fallback ? p + plus : inner[1];
    inner[4] = ring.fallback ? p + minus : inner[2];
    return inner;
}

vec3[INNER] scheme_corner(Ring ring, CornerFaces faces, vec3 p, vec3 plus, vec3 minus, vec3 transversal[2]) {
    return acc_corner(ring, faces, p, plus, minus);
}

#endif
