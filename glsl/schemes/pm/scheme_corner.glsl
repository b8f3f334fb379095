// What a corner of a Pm-patch takes from its ring, which is closed: f of its face, and e of its edges.
#ifndef CORNER_PM_GLSL
#define CORNER_PM_GLSL

#include "construct/corner_faces.glsl"

// f_i of a ring face; `first` and `second` are the ends of its edges.
vec3 pm_face(Face face, vec3 centre, vec3 first, vec3 second) {
    vec3 diagonal = face.triangle ? 0.5 * (first + second) : face.diagonal;
    return (4.0 * centre + 2.0 * (first + second) + diagonal) / 9.0;
}

vec3[INNER] pm_corner(CornerFaces at) {
    vec3 f = pm_face(at.face, at.centre, at.here, at.next);
    return vec3[INNER](f, 0.5 * (f + pm_face(at.face_before, at.centre, at.before, at.here)),
                       0.5 * (f + pm_face(at.face_after, at.centre, at.next, at.after)));
}

vec3[INNER] scheme_corner(Ring ring, CornerFaces faces, vec3 p, vec3 plus, vec3 minus, vec3 transversal[2]) {
    return pm_corner(faces);
}

#endif
