// The ring table of the two-stage and the cached construction. Rust twin: src/table/rings.rs.
#ifndef RINGS_GLSL
#define RINGS_GLSL

#include "constants.glsl"
#include "draw/positions.glsl"
#include "draw/tables.glsl"

layout(set = 1, binding = BINDING_TABLE_TEXELS) uniform usamplerBuffer ring_header_texels;
layout(set = 1, binding = BINDING_TABLE_TEXELS + 1) uniform usamplerBuffer ring_entry_texels;
layout(set = 1, binding = BINDING_TABLE_TEXELS + 2) uniform samplerBuffer ring_type_texels;
layout(set = 1, binding = BINDING_TABLE_TEXELS + 3) uniform usamplerBuffer patch_corner_texels;


// What no ring of the scheme has need not be looked for. Rust twin: `PatchStages::specialization` in
// src/renderer/shader/key.rs.
layout(constant_id = ID_MAY_BE_FITTED) const bool MAY_BE_FITTED = true;
layout(constant_id = ID_MAY_HAVE_PENTAGONS) const bool MAY_HAVE_PENTAGONS = true;

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

uint ring_entry(uint i) {
    return READS_TEXELS ? texelFetch(ring_entry_texels, int(i)).x : table_words[tables.ring_entries + i];
}

vec4 ring_type(uint i) {
    return READS_TEXELS ? texelFetch(ring_type_texels, int(i))
                        : uintBitsToFloat(table_fours[tables.ring_types / 4u + i]);
}

// The ring of a corner by its number among all, and which of its edges is the corner's plus edge.
uvec2 patch_corner(uint number) {
    return READS_TEXELS ? texelFetch(patch_corner_texels, int(number)).xy
                        : table_pairs[tables.patch_corners / 2u + number];
}

Ring ring_at(uint index) {
    uvec4 header = READS_TEXELS ? texelFetch(ring_header_texels, int(index))
                                : table_fours[tables.ring_headers / 4u + index];
    bool open = (header.w & OPEN_BIT) != 0u;
    uint faces = header.w & ~(OPEN_BIT | CONE_BIT | FALLBACK_BIT | FITTED_BIT);
    return Ring(header.x, header.y, header.z, faces, faces + uint(open), open, (header.w & CONE_BIT) != 0u,
                (header.w & FALLBACK_BIT) != 0u, (header.w & FITTED_BIT) != 0u);
}

// cos_k: of the angle between neighbouring edges.
float ring_cosine(Ring ring) {
    return ring_type(ring.type).w;
}

// Cosine and sine of the direction of edge j, and its transversal's weights where the ring is fitted.
vec4 edge_type(Ring ring, uint j) {
    return ring_type(ring.type + 1u + j);
}

// a_j, at the other end of edge j < edges + faces.
vec3 edge_neighbour(Ring ring, uint j) {
    uint wrapped = j >= ring.edges ? j - ring.edges : j;
    return vertex_position(ring_entry(ring.entries + 2u * wrapped));
}

// What a ring entry stands for: a vertex, or the middle of the far edge of a pentagon.
vec3 entry_position(uint entry) {
    if (MAY_HAVE_PENTAGONS && (entry & PENTAGON_BIT) != 0u) {
        uint at = entry & ~PENTAGON_BIT;
        precise vec3 middle = 0.5 * (vertex_position(ring_entry(at)) + vertex_position(ring_entry(at + 1u)));
        return middle;
    }
    return vertex_position(entry & ~TRIANGLE_BIT);
}

// Limit point and tangent frame.
void ring_frame(Ring ring, vec3 centre, out vec3 p_out, out vec3 a_out, out vec3 b_out) {
    uint first = ring.type + 1u + ring.edges;
    uint last = ring.faces + ring.edges - 1u;
    // The first entry and the last before all else: at a crease these are its ends, which the ring on the other side has
    // the other way round, and so both get the same bits.
    vec3 x0 = vertex_position(ring_entry(ring.entries));
    vec3 x1 = entry_position(ring_entry(ring.entries + last));
    vec3 weights = ring_type(ring.type).xyz, weights0 = ring_type(first).xyz, weights1 = ring_type(first + last).xyz;
    precise vec3 p = weights0.x * x0 + weights1.x * x1;
    precise vec3 a = weights0.y * x0 + weights1.y * x1;
    precise vec3 b = weights0.z * x0 + weights1.z * x1;
    p += weights.x * centre;
    a += weights.y * centre;
    b += weights.z * centre;
    // Not below `last`: lanes of lavapipe (22.3.6) without a vertex read a ring of nothing from storage buffers, of which that is the
    // largest number, and have all loops of the others end after 65 535 steps together.
    for (uint i = 1u; i + 1u < ring.faces + ring.edges; ++i) {
        vec3 x = entry_position(ring_entry(ring.entries + i));
        weights = ring_type(first + i).xyz;
        p += weights.x * x;
        a += weights.y * x;
        b += weights.z * x;
    }
    p_out = p;
    a_out = a;
    b_out = b;
}

// e_j as seen from p.
vec3 edge_vector(Ring ring, uint j, vec3 centre, vec3 here, vec3 a, vec3 b) {
    vec2 direction = edge_type(ring, j).xy;
    precise vec3 in_plane = direction.x * a + direction.y * b;
    precise vec3 straight = (here - centre) / 3.0;
    return ring.cone ? straight : in_plane;
}

// A face of the ring.
struct Face {
    bool triangle;
    vec3 diagonal;  // the vertex opposite; of a triangle any
};

Face ring_face(Ring ring, uint i) {
    uint entry = ring_entry(ring.entries + 2u * i + 1u);
    return Face((entry & TRIANGLE_BIT) != 0u, entry_position(entry));
}

// c_i, the mean of the vertices of a face; `first` and `second` are the ends of its edges.
vec3 face_centroid(Face face, vec3 centre, vec3 first, vec3 second) {
    precise vec3 sum = centre + first + second;
    precise vec3 of_three = sum / 3.0;
    precise vec3 of_four = (sum + face.diagonal) / 4.0;
    return face.triangle ? of_three : of_four;
}

// What the transversal of an edge is made of: its other end and those of the edges before and after it, and the means of the
// faces between.
struct Beside {
    bool first, last;  // there is nothing before or after it
    vec3 centre, before, here, next, mean_before, mean;
};

// r_j, the transversal of edge j.
vec3 transversal(Beside at) {
    precise vec3 inside = (at.next - at.before) / 6.0 + (2.0 / 3.0) * (at.mean - at.mean_before);
    precise vec3 first = (at.next - at.centre) / 3.0 + (4.0 * at.mean - 2.0 * (at.centre + at.here)) / 3.0;
    precise vec3 last = (at.centre - at.before) / 3.0 + (2.0 * (at.centre + at.here) - 4.0 * at.mean_before) / 3.0;
    return at.first ? first : at.last ? last : inside;
}

// The transversal of edge j as the scheme has it; a and b are the tangent frame. Rust twin: `Scheme::transversal` in
// src/patch/scheme.rs.
vec3 scheme_transversal(Ring ring, uint j, Beside beside, vec3 a, vec3 b) {
    precise vec3 r = transversal(beside);
    if (MAY_BE_FITTED && ring.fitted) {
        vec4 type = edge_type(ring, j);
        r = type.z * r + type.w * (type.x * b - type.y * a);
    }
    return r;
}

// Edges and faces before and after an edge; where there is none, any.
uint edge_before(Ring ring, uint j) {
    return j > 0u ? j - 1u : ring.open ? 0u : ring.edges - 1u;
}

uint edge_after(Ring ring, uint j) {
    return j + 1u < ring.edges ? j + 1u : 0u;
}

#endif
