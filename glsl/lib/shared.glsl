// What a patch corner shares with other patches, for the control shaders to write. Rust twin: src/table/shared.rs.
#ifndef SHARED_GLSL
#define SHARED_GLSL

#include "patch.glsl"
#include "rings.glsl"
#include "shared_bits.glsl"

layout(set = 1, binding = 9, std430) readonly buffer SharedCorners { uint shared_corners[]; };

layout(location = 16) out vec3 shared_with[][SHARED_VECTORS];
layout(location = 22) out uint shared_bits[];

#ifdef DISPLACED
#include "displace.glsl"

// Texture coordinates at a corner: on its plus edge, on its minus edge, at the corner itself; and x: the mean length of an
// edge there. Rust twin: `SharedTexcoord` in src/table/shared.rs.
struct SharedTexcoord { vec2 plus, minus, corner, scale; };
layout(set = 1, binding = 10, std430) readonly buffer SharedTexcoords { SharedTexcoord shared_texcoords[]; };
layout(location = 23) out vec2 shared_texcoord[][3];
layout(location = 26) out float shared_lod[];
#endif

const uint SHARED_WORDS = 5u;
const uint EDGE_MASK = ~(REVERSED_BIT | SHARP_EDGE_BIT);

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

vec3 framed_edge_point(FramedRing at, uint j) {
    return edge_point(at.ring, j, at.centre, at.p, at.a, at.b);
}

// Rust twin: `RingValues::across` in src/patch/ring.rs.
vec3 across(FramedRing at, uint j) {
    float cosine = ring_cosine(at.ring);
    precise vec3 x;
    if (at.ring.open && j == 0u) {
        vec3 here = framed_edge_point(at, j), next = framed_edge_point(at, j + 1u);
        x = 3.0 * (next - at.p) - (3.0 * cosine) * (here - at.p);
    } else if (at.ring.open && j == at.ring.faces) {
        vec3 here = framed_edge_point(at, j), before = framed_edge_point(at, j - 1u);
        x = (3.0 * cosine) * (here - at.p) - 3.0 * (before - at.p);
    } else {
        uint next_j = j + 1u == at.ring.edges ? 0u : j + 1u;
        uint before_j = (j == 0u ? at.ring.edges : j) - 1u;
        x = 1.5 * (framed_edge_point(at, next_j) - framed_edge_point(at, before_j));
    }
    return x;
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

// Writes what a corner of the patch shares; `own` is its ring, `corner` its number among all corners.
void share_corner(uint corner, FramedRing own) {
    uint first = SHARED_WORDS * corner;
    uint speaker = shared_corners[first];
    uint plus_ring = shared_corners[first + 1u];
    uint plus_edge = shared_corners[first + 2u];
    uint minus_ring = shared_corners[first + 3u];
    uint minus_edge = shared_corners[first + 4u];
    shared_with[gl_InvocationID][4] = ring_normal(own);
    // Other rings speak at creases only.
    FramedRing at = own;
    if (plus_ring != own.index) {
        at = framed_ring(plus_ring);
    }
    shared_with[gl_InvocationID][0] = across(at, plus_edge & EDGE_MASK);
    shared_with[gl_InvocationID][1] = scheme_transversal(at.ring, plus_edge & EDGE_MASK, at.centre, at.a, at.b);
    if (minus_ring != at.index) {
        at = framed_ring(minus_ring);
    }
    shared_with[gl_InvocationID][2] = across(at, minus_edge);
    shared_with[gl_InvocationID][3] = scheme_transversal(at.ring, minus_edge, at.centre, at.a, at.b);
#ifdef DISPLACED
    if (speaker != at.index) {
        at = framed_ring(speaker);
    }
    shared_with[gl_InvocationID][5] = ring_normal(at);
    SharedTexcoord texcoord = shared_texcoords[corner];
    shared_texcoord[gl_InvocationID][0] = texcoord.plus;
    shared_texcoord[gl_InvocationID][1] = texcoord.minus;
    shared_texcoord[gl_InvocationID][2] = texcoord.corner;
    // The level at which an edge here has as many texels as segments.
    vec2 size = vec2(textureSize(displacement_map, 0));
    precise float texels = texcoord.scale.x * max(size.x, size.y) 
        / vertex_factor(at.p, at.a, at.b);
    shared_lod[gl_InvocationID] = max(log2(texels), 0.0);
#endif
    shared_bits[gl_InvocationID] = plus_edge & ~EDGE_MASK;
}

#endif
