// What a corner of a patch takes from its ring (Loop et al. 2009, section 4): its limit point, the vectors from there to its edge
// points and, by scheme, what its inner points need.
#ifndef CORNER_GLSL
#define CORNER_GLSL

#include "construct/corner_faces.glsl"
#include "construct/framed_ring.glsl"
#include "scheme.glsl"
#include "scheme_corner.glsl"
#ifdef SHARED
#include "edges/shared.glsl"
#endif

struct Corner {
    vec3 centre;
    vec4 limit;  // w: the ring's cosine
    vec3 plus, minus;
#ifdef INNER
    vec3 inner[INNER];
#endif
#ifdef SHARED
    vec3 with[SHARED_VECTORS];
#ifdef DISPLACED
    FramedRing owner;
#endif
#endif
};

// By its number among all corners.
Corner corner_of_patch(uint number) {
    uvec2 place = patch_corner(number);
    FramedRing own = framed_ring(place.x);
    Ring ring = own.ring;
    vec3 centre = own.centre, a = own.a, b = own.b;
    uint minus_edge = edge_after(ring, place.y);
    Corner corner;
    corner.centre = centre;
    corner.limit = vec4(own.p, ring_cosine(ring));
    vec3 here = edge_neighbour(ring, place.y), next = edge_neighbour(ring, minus_edge);
    corner.plus = edge_vector(ring, place.y, centre, here, a, b);
    corner.minus = edge_vector(ring, minus_edge, centre, next, a, b);
#if defined(INNER) || defined(SHARED)
    CornerFaces faces = corner_faces(ring, place.y, minus_edge, centre, here, next);
#endif
#if defined(NEEDS_TRANSVERSALS) || defined(SHARED)
    vec3 r[2] = transversals(ring, place.y, minus_edge, faces, a, b);
#elif defined(INNER)
    const vec3 r[2] = vec3[2](vec3(0.0), vec3(0.0));
#endif
#ifdef INNER
    corner.inner = scheme_corner(ring, faces, own.p, corner.plus, corner.minus, r);
#endif
#ifdef SHARED
    vec3 e_before = edge_vector(ring, edge_before(ring, place.y), centre, faces.before, a, b);
    vec3 e_after = edge_vector(ring, edge_after(ring, minus_edge), centre, faces.after, a, b);
    SharedEdge plus = SharedEdge(across(ring, place.y, e_before, corner.plus, corner.minus), r[0]);
    SharedEdge minus = SharedEdge(across(ring, minus_edge, corner.plus, corner.minus, e_after), r[1]);
    FramedRing owner = own;
#ifdef DISPLACED
    corner.owner = owner = corner_owner(number, own);
#endif
    corner.with = share_corner(number, own, owner, plus, minus);
#endif
    return corner;
}

#endif
