// What a corner of a Gregory patch takes from its ring: the transversals of its edges.
#ifndef CORNER_GREGORY_GLSL
#define CORNER_GREGORY_GLSL

#include "corner_faces.glsl"

#define INNER 2

void inner_values(Ring ring, uint plus_edge, uint minus_edge, CornerFaces at, vec3 plus, vec3 minus, vec3 p, vec3 a, vec3 b,
                  out vec3 inner[INNER]) {
    vec3 mean_before = face_centroid(at.face_before, at.centre, at.before, at.here);
    vec3 mean = face_centroid(at.face, at.centre, at.here, at.next);
    vec3 mean_after = face_centroid(at.face_after, at.centre, at.next, at.after);
    Beside at_plus = Beside(!at.has_before, false, at.centre, at.before, at.here, at.next, mean_before, mean);
    Beside at_minus = Beside(false, !at.has_after, at.centre, at.here, at.next, at.after, mean, mean_after);
    inner[0] = scheme_transversal(ring, plus_edge, at_plus, a, b);
    inner[1] = scheme_transversal(ring, minus_edge, at_minus, a, b);
}

#endif
