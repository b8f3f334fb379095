// The table for subdivision of faces: fans and the weights around them. Rust twin: src/table/subdivision.rs.
#ifndef SUBDIVISION_GLSL
#define SUBDIVISION_GLSL

#include "constants.glsl"
#include "draw/positions.glsl"
#include "draw/tables.glsl"



// All faces around a corner of a face, and where that face is among them.
struct Fan {
    uint vertex;
    uint entries;  // words of the tables
    uint type;
    int faces;
    int edges;
    int face;
};

// Corners are counted through all patches.
Fan fan_at(uint corner) {
    uvec2 place = table_pairs[tables.patch_corners / 2u + corner];
    uvec4 header = table_fours[tables.ring_headers / 4u + place.x];
    int faces = int(header.w & ~FAN_OPEN_BIT);
    int edges = faces + int((header.w & FAN_OPEN_BIT) != 0u);
    // Of the entries: a_i, d_i, and the profile of edge i.
    uint entries = tables.ring_entries + 3u * header.y;
    return Fan(header.x, entries, tables.ring_types + header.z, faces, edges, int(place.y));
}

// The number of edge j, which may be some edges before the first or after the last. Of an open fan the nearest that there is:
// what comes of it is not used.
int fan_edge(Fan fan, int j) {
    int edges = fan.edges;
    return edges > fan.faces ? clamp(j, 0, edges - 1) : (j + 2 * edges) % edges;
}

// a_j, at the other end of edge j.
vec3 fan_neighbour(Fan fan, int j) {
    return vertex_position(table_words[fan.entries + 3u * uint(fan_edge(fan, j))]);
}

// d_j, in the face to the left of edge j.
vec3 fan_diagonal(Fan fan, int j) {
    return vertex_position(table_words[fan.entries + 3u * uint(fan_edge(fan, j)) + 1u]);
}

uint fan_profile(Fan fan, int j) {
    return tables.ring_types + table_words[fan.entries + 3u * uint(fan_edge(fan, j)) + 2u];
}

float fan_weight(uint word) {
    return uintBitsToFloat(table_words[word]);
}

// The rules, each with the same bits from every face that a point is in: sums in pairs that are opposite. Rust twin of the rules:
// src/limit/refine.rs.

vec3 face_point(vec3 x0, vec3 x1, vec3 x2, vec3 x3) {
    precise vec3 mean = 0.25 * ((x0 + x2) + (x1 + x3));
    return mean;
}

vec3 sharpened(vec3 point, vec3 sharp, float weight) {
    precise vec3 mixed = (1.0 - weight) * point + weight * sharp;
    return mixed;
}

vec3 smooth_edge_point(vec3 from, vec3 to, vec3 left, vec3 right) {
    precise vec3 mean = 0.25 * ((from + to) + (left + right));
    return mean;
}

vec3 sharp_edge_point(vec3 from, vec3 to) {
    precise vec3 mean = 0.5 * (from + to);
    return mean;
}

// Between four faces: neighbours and face points in order around the vertex.
vec3 smooth_vertex_point(vec3 vertex, vec3 a0, vec3 a1, vec3 a2, vec3 a3, vec3 f0, vec3 f1, vec3 f2, vec3 f3) {
    precise vec3 around = ((a0 + a2) + (a1 + a3)) + ((f0 + f2) + (f1 + f3));
    precise vec3 mean = 0.5 * vertex + 0.0625 * around;
    return mean;
}

vec3 crease_vertex_point(vec3 vertex, vec3 before, vec3 after) {
    precise vec3 mean = 0.75 * vertex + 0.125 * (before + after);
    return mean;
}

#endif
