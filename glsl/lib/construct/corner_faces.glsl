// The part of a one-ring around one of its faces, a patch's: what a corner of the patch takes from its ring besides the frame.
#ifndef CORNER_FACES_GLSL
#define CORNER_FACES_GLSL

#include "construct/rings.glsl"

struct CornerFaces {
    bool has_before, has_after;      // there is a face beyond the plus edge, beyond the minus edge
    vec3 centre;
    vec3 before, here, next, after;  // the ends of four edges, of which the second and third are the patch's
    Face face_before, face, face_after;
};

// `here` and `next` are the ends of the patch's edges.
CornerFaces corner_faces(Ring ring, uint plus_edge, uint minus_edge, vec3 centre, vec3 here, vec3 next) {
    uint before = edge_before(ring, plus_edge), after = edge_after(ring, minus_edge);
    bool has_before = !(ring.open && plus_edge == 0u), has_after = !(ring.open && minus_edge == ring.faces);
    return CornerFaces(has_before, has_after, centre, edge_neighbour(ring, before), here, next,
                       edge_neighbour(ring, after), ring_face(ring, before), ring_face(ring, plus_edge),
                       ring_face(ring, has_after ? minus_edge : 0u));
}

// The transversals of the plus and of the minus edge as the scheme has them; a and b are the tangent frame.
vec3[2] transversals(Ring ring, uint plus_edge, uint minus_edge, CornerFaces at, vec3 a, vec3 b) {
    vec3 mean_before = face_centroid(at.face_before, at.centre, at.before, at.here);
    vec3 mean = face_centroid(at.face, at.centre, at.here, at.next);
    vec3 mean_after = face_centroid(at.face_after, at.centre, at.next, at.after);
    Beside at_plus = Beside(!at.has_before, false, at.centre, at.before, at.here, at.next, mean_before, mean);
    Beside at_minus = Beside(false, !at.has_after, at.centre, at.here, at.next, at.after, mean, mean_after);
    return vec3[2](scheme_transversal(ring, plus_edge, at_plus, a, b),
                   scheme_transversal(ring, minus_edge, at_minus, a, b));
}

#endif
