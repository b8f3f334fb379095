// The factors of a patch's edges, of its `owned` control points, CORNERS of them. Rust twins: src/tessellator/factors.rs.
#ifndef EDGE_FACTORS_GLSL
#define EDGE_FACTORS_GLSL

#include "edges/factors.glsl"

// What the edge from corner k to the next asks for, not yet within limits. `patch_number` counts within the draw.
float plus_factor(uint patch_number, uint k) {
    uint next = k + 1u == CORNERS ? 0u : k + 1u;
    switch (metric()) {
    case METRIC_UNIFORM:
        return item.factor;
    case METRIC_EDGES:
        precise float factor = item.factor * corner_factors[draw.first_corner + patch_number * CORNERS + k];
        return factor;
    default:
        return edge_factor(owned[k][0], CONTROL_POINT(k, 1), CONTROL_POINT(next, 2), owned[next][0]);
    }
}

// What is no number counts as 1.
float within_limits(float factor) {
    return factor > 1.0 ? min(factor, MAX_FACTOR) : 1.0;
}

#endif
