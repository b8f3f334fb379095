// Evaluation without the tessellation stages: each patch on a uniform grid with the same number of segments along every side; but
// edges with factors of their own have fewer.
// Rust twins: src/table/uniform_grid.rs, and `grid_parameters` in src/table/cpu.rs for the order.
#ifndef UNIFORM_GRID_GLSL
#define UNIFORM_GRID_GLSL

#ifdef DISPLACED
#define SHARED
#ifndef TEXCOORD
#define TEXCOORD
#endif
#endif
#include "constants.glsl"
#include "evaluate/uniform_grid_sample.glsl"

// The parameter of vertex i along a side, with 16 bits after the point: from both ends of an edge the same vertices, for
// `1 - t` is exact. As tessellators that follow Direct3D's have it, which step by a rounded 1 / n; they end at 64 segments.
// (Of signed numbers, which processors turn into floating point faster.)
float along_side(uint i, uint segments) {
    int near = min(int(i), int(segments - i));
    precise float step_size = 65536.0 / float(int(segments));
    precise float t = round(float(near) * (segments <= 64u ? round(step_size) : step_size)) / 65536.0;
    t = 2 * near == int(segments) ? 0.5 : t;
    precise float from_end = 1.0 - t;
    return int(i) == near ? t : from_end;
}

// Whether edges have factors of their own.
layout(constant_id = ID_HAS_EDGE_FACTORS) const bool HAS_EDGE_FACTORS = false;
layout(set = 1, binding = BINDING_EDGE_FACTORS, std430) readonly buffer CornerFactors { float corner_factors[]; };

// The parameter of vertex i along the plus edge of a corner, which may have fewer segments than the uniform grid: then the vertex
// goes to the nearest of the edge's own, and so both its patches have those and no others.
float along_edge(uint i, uint segments, uint corner) {
    // What is no number counts as 1.
    float factor = corner_factors[corner];
    uint own = uint(factor > 1.0 ? min(ceil(factor), float(segments)) : 1.0);
    return along_side((2u * i * own + segments) / (2u * segments), own);
}

// (u, v) of a quad, (u, v, w) of a triangle, whose row r has r + 1 vertices.
vec3 uniform_grid_parameter(uint row, uint place, uint segments, uint first_corner) {
#ifdef TRIANGLE
    precise float v = along_side(row - place, segments), w = along_side(place, segments);
    if (HAS_EDGE_FACTORS) {
        if (place == 0u) {
            v = along_edge(row, segments, first_corner);
        }
#ifndef PENTAGON
        // Other sides of a piece of a pentagon are inside the face.
        if (place == row) {
            w = along_edge(row, segments, first_corner + 2u);
        }
        if (row == segments) {
            w = along_edge(place, segments, first_corner + 1u);
            v = 1.0 - w;
        }
#endif
    }
    precise float u = 1.0 - v - w;
    return vec3(u, v, w);
#else
    float u = along_side(place, segments), v = along_side(row, segments);
    if (HAS_EDGE_FACTORS) {
        if (row == 0u || row == segments) {
            u = along_edge(place, segments, first_corner + (row == 0u ? 0u : 2u));
        }
        if (place == 0u || place == segments) {
            v = along_edge(row, segments, first_corner + (place == 0u ? 3u : 1u));
        }
    }
    return vec3(u, v, 0.0);
#endif
}

// Of vertex i of the patch.
vec3 uniform_grid_parameter(uint i, uint segments, uint first_corner) {
#ifdef TRIANGLE
    // Row r starts with vertex r (r + 1) / 2.
    uint row = uint((sqrt(float(8u * i + 1u)) - 1.0) / 2.0);
    row += (row + 1u) * (row + 2u) / 2u <= i ? 1u : 0u;
    row -= row * (row + 1u) / 2u > i ? 1u : 0u;
    return uniform_grid_parameter(row, i - row * (row + 1u) / 2u, segments, first_corner);
#else
    uint side = segments + 1u;
    // By floating point, which devices divide faster: right up to the 1024 segments that there may be.
    uint row = uint(int((float(int(i)) + 0.5) * (1.0 / float(int(side)))));
    return uniform_grid_parameter(row, i - row * side, segments, first_corner);
#endif
}

#endif
