// The ring table of the two-stage construction. Rust twin: src/table/rings.rs.
#ifndef RINGS_GLSL
#define RINGS_GLSL

#include "positions.glsl"

layout(set = 1, binding = 1, std430) readonly buffer RingHeaders { uvec4 ring_headers[]; };
layout(set = 1, binding = 2, std430) readonly buffer RingEntries { uint ring_entries[]; };
layout(set = 1, binding = 3, std430) readonly buffer RingTypes { float ring_types[]; };
layout(set = 1, binding = 4, std430) readonly buffer PatchCorners { uvec2 patch_corners[]; };

const uint TRIANGLE_BIT = 1u << 31;
const uint PENTAGON_BIT = 1u << 30;
const uint OPEN_BIT = 1u << 31;
const uint CONE_BIT = 1u << 30;
const uint FITTED_BIT = 1u << 28;
const uint FALLBACK_BIT = 1u << 29;

struct Ring {
    uint vertex;
    uint entries;
    uint type;
    uint faces;
    uint edges;
    bool open;
    bool cone;
    bool fallback;
    bool fitted;
};

Ring ring_at(uint index) {
    uvec4 header = ring_headers[index];
    bool open = (header.w & OPEN_BIT) != 0u;
    uint faces = header.w & ~(OPEN_BIT | CONE_BIT | FALLBACK_BIT | FITTED_BIT);
    return Ring(header.x, header.y, header.z, faces, faces + uint(open), open, (header.w & CONE_BIT) != 0u,
                (header.w & FALLBACK_BIT) != 0u, (header.w & FITTED_BIT) != 0u);
}

// cos_k: of the angle between neighbouring edges.
float ring_cosine(Ring ring) {
    return ring_types[ring.type];
}

// Cosine and sine of the direction of edge j.
vec2 edge_direction(Ring ring, uint j) {
    uint at = ring.type + 1u + 2u * j;
    return vec2(ring_types[at], ring_types[at + 1u]);
}

// a_j, at the other end of edge j < edges + faces.
vec3 edge_neighbour(Ring ring, uint j) {
    uint wrapped = j >= ring.edges ? j - ring.edges : j;
    return vertex_position(ring_entries[ring.entries + 2u * wrapped]);
}

// What a ring entry stands for: a vertex, or the middle of the far edge of a pentagon.
vec3 entry_position(uint entry) {
    if ((entry & PENTAGON_BIT) != 0u) {
        uint at = entry & ~PENTAGON_BIT;
        return 0.5 * (vertex_position(ring_entries[at]) + vertex_position(ring_entries[at + 1u]));
    }
    return vertex_position(entry & ~TRIANGLE_BIT);
}

// Limit point and tangent frame.
void ring_frame(Ring ring, vec3 centre, out vec3 p_out, out vec3 a_out, out vec3 b_out) {
    uint first = ring.type + 1u + 2u * ring.edges;
    uint count = ring.faces + ring.edges;
    // The first entry and the last before all else: at a crease these are its ends, which the ring on the other side has
    // the other way round, and so both get the same bits.
    vec3 x0 = vertex_position(ring_entries[ring.entries]);
    vec3 x1 = entry_position(ring_entries[ring.entries + count - 1u]);
    uint last = first + 3u * count;
    precise vec3 p = ring_types[first + 3u] * x0 + ring_types[last] * x1;
    precise vec3 a = ring_types[first + 4u] * x0 + ring_types[last + 1u] * x1;
    precise vec3 b = ring_types[first + 5u] * x0 + ring_types[last + 2u] * x1;
    p += ring_types[first] * centre;
    a += ring_types[first + 1u] * centre;
    b += ring_types[first + 2u] * centre;
    for (uint i = 1u; i + 1u < count; ++i) {
        vec3 x = entry_position(ring_entries[ring.entries + i]);
        uint weight = first + 3u + 3u * i;
        p += ring_types[weight] * x;
        a += ring_types[weight + 1u] * x;
        b += ring_types[weight + 2u] * x;
    }
    p_out = p;
    a_out = a;
    b_out = b;
}

// e_j.
vec3 edge_point(Ring ring, uint j, vec3 centre, vec3 p, vec3 a, vec3 b) {
    precise vec3 e;
    if (ring.cone) {
        e = (2.0 * centre + edge_neighbour(ring, j)) / 3.0;
    } else {
        vec2 direction = edge_direction(ring, j);
        e = p + (direction.x * a + direction.y * b);
    }
    return e;
}

// c_i, the mean of the vertices of face i; `first` and `second` are the ends of its edges.
vec3 face_centroid(Ring ring, uint i, vec3 centre, vec3 first, vec3 second) {
    uint entry = ring_entries[ring.entries + 2u * i + 1u];
    precise vec3 sum = centre + first + second;
    precise vec3 of_three = sum / 3.0;
    precise vec3 of_four = (sum + vertex_position(entry & ~TRIANGLE_BIT)) / 4.0;
    return (entry & TRIANGLE_BIT) != 0u ? of_three : of_four;
}

// r_j, the transversal of edge j.
vec3 transversal(Ring ring, uint j, vec3 centre) {
    vec3 here = edge_neighbour(ring, j);
    precise vec3 r;
    if (ring.open && j == 0u) {
        vec3 next = edge_neighbour(ring, 1u);
        vec3 mean = face_centroid(ring, 0u, centre, here, next);
        r = (next - centre) / 3.0 + (4.0 * mean - 2.0 * (centre + here)) / 3.0;
        return r;
    }
    uint before_j = (j == 0u ? ring.edges : j) - 1u;
    vec3 before = edge_neighbour(ring, before_j);
    vec3 mean_before = face_centroid(ring, before_j, centre, before, here);
    if (ring.open && j == ring.faces) {
        r = (centre - before) / 3.0 + (2.0 * (centre + here) - 4.0 * mean_before) / 3.0;
        return r;
    }
    vec3 next = edge_neighbour(ring, j + 1u);
    vec3 mean = face_centroid(ring, j, centre, here, next);
    r = (next - before) / 6.0 + (2.0 / 3.0) * (mean - mean_before);
    return r;
}

// The transversal of edge j as the scheme has it; a and b are the tangent frame. Rust twin: `Scheme::transversal` in
// src/patch/scheme.rs.
vec3 scheme_transversal(Ring ring, uint j, vec3 centre, vec3 a, vec3 b) {
    precise vec3 r = transversal(ring, j, centre);
    if (ring.fitted) {
        // After the ring's cosine, its edges' directions and its frame's weights.
        uint at = ring.type + 1u + 2u * ring.edges + 3u * (1u + ring.edges + ring.faces) + 2u * j;
        vec2 direction = edge_direction(ring, j);
        r = ring_types[at] * r + ring_types[at + 1u] * (direction.x * b - direction.y * a);
    }
    return r;
}

#endif
