// Evaluation without the tessellation stages: each patch on a lattice with the same number of segments along every side.
// Rust twins: src/table/lattice.rs, and `grid_parameters` in src/table/cpu.rs for the order.
#ifndef LATTICE_GLSL
#define LATTICE_GLSL

#include "kinds.glsl"
#include "patch.glsl"

#ifdef TEXCOORD
layout(set = 1, binding = 8, std430) readonly buffer Texcoords { vec2 texcoords[]; };

// Of a patch whose first corner this is, at a point of it.
vec2 texcoord_at(uint first_corner, vec3 at) {
    vec2 texcoord[CORNERS];
    for (uint k = 0u; k < CORNERS; ++k) {
        texcoord[k] = texcoords[first_corner + k];
    }
    return INTERPOLATED(texcoord, at);
}
#endif

// The parameter of vertex i along a side, with 16 bits after the point: from both ends of an edge the same vertices, for
// `1 - t` is exact. As tessellators that follow Direct3D's have it, which step by a rounded 1 / n; they end at 64 segments.
float along_side(uint i, uint segments) {
    uint near = min(i, segments - i);
    precise float step_size = 65536.0 / float(segments);
    precise float t = round(float(near) * (segments <= 64u ? round(step_size) : step_size)) / 65536.0;
    t = 2u * near == segments ? 0.5 : t;
    return i == near ? t : 1.0 - t;
}

// (u, v) of a quad, (u, v, w) of a triangle, whose row r has r + 1 vertices.
vec3 lattice_parameter(uint row, uint place, uint segments) {
#ifdef TRIANGLE
    float v = along_side(row - place, segments), w = along_side(place, segments);
    return vec3(1.0 - v - w, v, w);
#else
    return vec3(along_side(place, segments), along_side(row, segments), 0.0);
#endif
}

// Of vertex i of the patch.
vec3 lattice_parameter(uint i, uint segments) {
#ifdef TRIANGLE
    // Row r starts with vertex r (r + 1) / 2.
    uint row = uint((sqrt(float(8u * i + 1u)) - 1.0) / 2.0);
    row += (row + 1u) * (row + 2u) / 2u <= i ? 1u : 0u;
    row -= row * (row + 1u) / 2u > i ? 1u : 0u;
    return lattice_parameter(row, i - row * (row + 1u) / 2u, segments);
#else
    uint side = segments + 1u;
    // By floating point, which devices divide faster: right up to the 1024 segments that there may be.
    uint row = uint((float(i) + 0.5) / float(side));
    return lattice_parameter(row, i - row * side, segments);
#endif
}

#endif
