// The part of a one-ring around one of its faces, a patch's: what a corner of the patch takes from its ring besides the frame.
#ifndef CORNER_FACES_GLSL
#define CORNER_FACES_GLSL

#include "rings.glsl"

struct CornerFaces {
    bool has_before, has_after;        // there is a face beyond the plus edge, beyond the minus edge
    vec3 centre;
    vec3 before, here, next, after;    // the ends of four edges, of which the second and third are the patch's
    Face face_before, face, face_after;
};

#endif
