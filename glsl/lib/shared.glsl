// What a patch corner shares with other patches: made in the vertex shader or in the control shader, and handed on by the latter.
// Rust twin: src/table/shared.rs.
#ifndef SHARED_GLSL
#define SHARED_GLSL

#include "patch.glsl"
#include "rings.glsl"
#include "shared_bits.glsl"

// Whether any corner has another ring than its own speak for what it shares, as at creases.
layout(constant_id = 7) const bool HAS_SPEAKERS = true;

layout(set = 1, binding = 9, std430) readonly buffer SharedCorners { uint shared_corners[]; };

#ifdef DISPLACED
#include "displace.glsl"
#include "factors.glsl"

// Texture coordinates at a corner: on its plus edge, on its minus edge, at the corner itself; and x: the mean length of an
// edge there. Rust twin: `SharedTexcoord` in src/table/shared.rs.
struct SharedTexcoord { vec2 plus, minus, corner, scale; };
layout(set = 1, binding = 10, std430) readonly buffer SharedTexcoords { SharedTexcoord shared_texcoords[]; };
#endif

const uint SHARED_WORDS = 5u;
const uint EDGE_MASK = ~SHARP_EDGE_BIT;

// What a corner shares: see SHARED_VECTORS.
struct SharedCorner {
    vec3 vectors[SHARED_VECTORS];
    uint bits;
#ifdef DISPLACED
    float lod;
#endif
};

// A ring with its limit point and tangent frame.
struct FramedRing {
    uint index;
    Ring ring;
    vec3 centre, p, a, b;
};

FramedRing framed_ring(uint index) {
    Ring ring = ring_at(index);
    FramedRing framed = FramedRing(index, ring, vertex_position(ring.vertex), vec3(0.0), vec3(0.0), vec3(0.0));
    ring_frame(ring, framed.centre, framed.p, framed.a, framed.b);
    return framed;
}

// An edge as the vertex of a ring sees it.
struct SharedEdge {
    vec3 across;
    vec3 transversal;
};

// The vector across edge j; e0 and e1 are the edge vectors before and after it. Rust twin: `RingValues::across` in
// src/patch/ring.rs.
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

// The normal at the vertex of a ring; without a tangent plane, the mean normal of the faces around it.
vec3 ring_normal(FramedRing at) {
    vec3 normal = unit_normal(at.a, at.b, vec3(0.0));
    if (normal != vec3(0.0)) {
        return normal;
    }
    precise vec3 sum = vec3(0.0);
    precise vec3 before = edge_neighbour(at.ring, 0u) - at.centre;
    uint count = at.ring.faces + at.ring.edges;
    for (uint i = 1u; i <= 2u * at.ring.faces; ++i) {
        uint entry = at.ring.entries + (i < count ? i : 0u);
        precise vec3 next = vertex_position(ring_entries[entry] & ~TRIANGLE_BIT) - at.centre;
        sum += exact_cross(before, next);
        before = next;
    }
    return unit(sum);
}

// What a corner of a patch shares; `corner` is its number among all corners, `own` its ring, with its plus and minus edge.
SharedCorner share_corner(uint corner, FramedRing own, SharedEdge own_plus, SharedEdge own_minus) {
    uint first = SHARED_WORDS * corner;
    uint plus_edge = shared_corners[first + 2u];
    SharedEdge plus = own_plus, minus = own_minus;
    FramedRing speaker = own;
    if (HAS_SPEAKERS) {
        uint of_corner = shared_corners[first];
        uint of_plus = shared_corners[first + 1u];
        uint of_minus = shared_corners[first + 3u];
        if (of_plus != own.index) {
            plus = shared_edge(framed_ring(of_plus), plus_edge & EDGE_MASK);
        }
        if (of_minus != own.index) {
            minus = shared_edge(framed_ring(of_minus), shared_corners[first + 4u]);
        }
#ifdef DISPLACED
        if (of_corner != own.index) {
            speaker = framed_ring(of_corner);
        }
#endif
    }
    SharedCorner with;
    with.bits = plus_edge & ~EDGE_MASK;
    with.vectors[0] = plus.across;
    with.vectors[1] = plus.transversal;
    with.vectors[2] = minus.across;
    with.vectors[3] = minus.transversal;
    with.vectors[4] = ring_normal(own);
#ifdef DISPLACED
    with.vectors[5] = ring_normal(speaker);
    // The level at which an edge here has as many texels as segments.
    vec2 size = vec2(textureSize(displacement_map, 0));
    precise float texels =
        shared_texcoords[corner].scale.x * max(size.x, size.y) / vertex_factor(speaker.p, speaker.a, speaker.b);
    with.lod = max(log2(texels), 0.0);
#endif
    return with;
}

#ifdef CONTROL_GLSL
// The same, for constructions that have no ring at hand.
SharedCorner share_corner(uint corner) {
    uvec2 place = patch_corners[corner];
    FramedRing own = framed_ring(place.x);
    return share_corner(corner, own, shared_edge(own, place.y), shared_edge(own, edge_after(own.ring, place.y)));
}

layout(location = 16) out vec3 shared_with[][SHARED_VECTORS];
layout(location = 22) out uint shared_bits[];
#ifdef DISPLACED
layout(location = 23) out vec2 shared_texcoord[][3];
layout(location = 26) out float shared_lod[];
#endif

// Hands on what a corner of the patch shares.
void write_shared(uint corner, SharedCorner with) {
    for (int i = 0; i < SHARED_VECTORS; ++i) {
        shared_with[gl_InvocationID][i] = with.vectors[i];
    }
    shared_bits[gl_InvocationID] = with.bits;
#ifdef DISPLACED
    SharedTexcoord texcoord = shared_texcoords[corner];
    shared_texcoord[gl_InvocationID][0] = texcoord.plus;
    shared_texcoord[gl_InvocationID][1] = texcoord.minus;
    shared_texcoord[gl_InvocationID][2] = texcoord.corner;
    shared_lod[gl_InvocationID] = with.lod;
#endif
}
#endif

#endif
