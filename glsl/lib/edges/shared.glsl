// What a patch corner shares with other patches: made in the vertex shader or in the control shader, and handed on by the latter.
// Rust twins: src/table/shared.rs, src/tessellator/shared.rs.
#ifndef SHARED_GLSL
#define SHARED_GLSL

#include "constants.glsl"
#include "construct/framed_ring.glsl"
#include "edges/shared_bits.glsl"

// Whether another ring than its own owns what a corner shares, as at creases.
layout(constant_id = ID_HAS_FOREIGN_OWNERS) const bool HAS_FOREIGN_OWNERS = true;

// An edge as the vertex of a ring sees it.
struct SharedEdge {
    vec3 across;
    vec3 transversal;
};

// The vector across edge j; e0 and e1 are the edge vectors before and after it. Rust twin: `RingValues::across` in
// src/blend/ring.rs.
vec3 across(Ring ring, uint j, vec3 e0, vec3 e, vec3 e1) {
    float cosine = ring_cosine(ring);
    precise vec3 first = 3.0 * e1 - (3.0 * cosine) * e;
    precise vec3 last = (3.0 * cosine) * e - 3.0 * e0;
    precise vec3 inside = 1.5 * (e1 - e0);
    return !ring.open ? inside : j == 0u ? first : j == ring.faces ? last : inside;
}

SharedEdge shared_edge(FramedRing at, uint j) {
    Ring ring = at.ring;
    bool first = ring.open && j == 0u, last = ring.open && j == ring.faces;
    uint j0 = edge_before(ring, j), j1 = edge_after(ring, j);
    vec3 before = edge_neighbour(ring, j0), here = edge_neighbour(ring, j), next = edge_neighbour(ring, j1);
    vec3 e0 = edge_vector(ring, j0, at.centre, before, at.a, at.b);
    vec3 e = edge_vector(ring, j, at.centre, here, at.a, at.b);
    vec3 e1 = edge_vector(ring, j1, at.centre, next, at.a, at.b);
    vec3 mean_before = face_centroid(ring_face(ring, j0), at.centre, before, here);
    vec3 mean = face_centroid(ring_face(ring, last ? 0u : j), at.centre, here, next);
    Beside beside = Beside(first, last, at.centre, before, here, next, mean_before, mean);
    return SharedEdge(across(ring, j, e0, e, e1), scheme_transversal(ring, j, beside, at.a, at.b));
}

// The ring that owns what a corner shares, whose own ring this is; `corner` is its number among all corners.
FramedRing corner_owner(uint corner, FramedRing own) {
    FramedRing owner = own;
    if (HAS_FOREIGN_OWNERS) {
        uint of_corner = shared_word(corner, 0u);
        if (of_corner != own.index) {
            owner = framed_ring(of_corner);
        }
    }
    return owner;
}

// What a corner of a patch shares: see SHARED_VECTORS. `own` is its ring, with its plus and minus edge.
vec3[SHARED_VECTORS] share_corner(uint corner, FramedRing own, FramedRing owner, SharedEdge own_plus, SharedEdge own_minus) {
    uint plus_edge = shared_word(corner, 2u);
    SharedEdge plus = own_plus, minus = own_minus;
    if (HAS_FOREIGN_OWNERS) {
        uint of_plus = shared_word(corner, 1u);
        uint of_minus = shared_word(corner, 3u);
        if (of_plus != own.index) {
            plus = shared_edge(framed_ring(of_plus), plus_edge & EDGE_MASK);
        }
        if (of_minus != own.index) {
            minus = shared_edge(framed_ring(of_minus), shared_word(corner, 4u));
        }
    }
    vec3 with[SHARED_VECTORS];
    with[0] = plus.across;
    with[1] = plus.transversal;
    with[2] = minus.across;
    with[3] = minus.transversal;
    with[4] = ring_normal(own);
#ifdef DISPLACED
    with[5] = ring_normal(owner);
#endif
    return with;
}

#endif
