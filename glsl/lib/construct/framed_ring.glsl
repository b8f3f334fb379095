// A ring with its limit point and tangent frame: made from the control vertices or, where KEPT_FRAMES holds, read from where
// glsl/compute/frames.comp keeps them.
#ifndef FRAMED_RING_GLSL
#define FRAMED_RING_GLSL

#include "evaluate/patch.glsl"
#include "construct/rings.glsl"

#ifdef KEPT_FRAMES
#include "construct/kept_frames.glsl"
#endif

struct FramedRing {
    uint index;
    Ring ring;
    vec3 centre, p, a, b;
#ifdef KEPT_FRAMES
    vec3 normal;
#endif
};

FramedRing framed_ring(uint index) {
    FramedRing framed;
    framed.index = index;
    framed.ring = ring_at(index);
    framed.centre = vertex_position(framed.ring.vertex);
#ifdef KEPT_FRAMES
    if (KEPT_FRAMES) {
        KeptFrame kept = kept_frame(index);
        framed.p = kept.p;
        framed.a = kept.a;
        framed.b = kept.b;
        framed.normal = kept.normal;
        return framed;
    }
#endif
    ring_frame(framed.ring, framed.centre, framed.p, framed.a, framed.b);
    return framed;
}

// The normal at the vertex of a ring; without a tangent plane, the mean normal of the faces around it.
vec3 ring_normal(FramedRing at) {
#ifdef KEPT_FRAMES
    if (KEPT_FRAMES) {
        return at.normal;
    }
#endif
    vec3 normal = unit_normal(at.a, at.b, vec3(0.0));
    if (normal != vec3(0.0)) {
        return normal;
    }
    precise vec3 sum = vec3(0.0);
    precise vec3 before = edge_neighbour(at.ring, 0u) - at.centre;
    uint count = at.ring.faces + at.ring.edges;
    for (uint i = 1u; i <= 2u * at.ring.faces; ++i) {
        uint entry = at.ring.entries + (i < count ? i : 0u);
        precise vec3 next = entry_position(ring_entry(entry)) - at.centre;
        sum += exact_cross(before, next);
        before = next;
    }
    return unit(sum);
}

#endif
