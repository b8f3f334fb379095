// What a corner of a Gregory patch takes from its ring: the transversals of its plus and its minus edge.
#ifndef SCHEME_CORNER_GLSL
#define SCHEME_CORNER_GLSL

vec3[INNER] scheme_corner(Ring ring, CornerFaces faces, vec3 p, vec3 plus, vec3 minus, vec3 transversal[2]) {
    return transversal;
}

#endif
