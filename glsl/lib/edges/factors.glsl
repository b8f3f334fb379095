// Tessellation factors and patches that need not be drawn.
//
// The factor of an edge comes from the edge alone (its Bezier points, which both its patches have to the bit), by sums that
// are the same from either end; so it is the same for both, whether one of them is culled or not. Rust twins:
// src/tessellator/factors.rs, src/tessellator/draw.rs.
#ifndef FACTORS_GLSL
#define FACTORS_GLSL

#include "constants.glsl"
#include "draw/draw.glsl"
#include "evaluate/patch.glsl"

layout(constant_id = ID_MAX_FACTOR) const float MAX_FACTOR = 64.0;

layout(set = 1, binding = BINDING_EDGE_FACTORS, std430) readonly buffer CornerFactors { float corner_factors[]; };

// Metric of the factors, and which patches are culled: what a draw does not ask for is not in its pipeline. Rust twin:
// `Cut` in src/renderer/shader/cut.rs.
layout(constant_id = ID_DRAW_FLAGS) const uint DRAW_FLAGS = 0u;

const uint CULL_FLAGS = CULL_FRUSTUM_FLAG | CULL_BACK_FLAG | CULL_SMALL_FLAG;

// How much of a bend towards the eye counts: it is seen in the shading only.
const float DEPTH_WEIGHT = 0.25;

uint metric() {
    return DRAW_FLAGS & METRIC_MASK;
}

// x, y in pixels and the distance from the eye's plane. What is behind the eye is taken as just before it.
vec3 to_pixels(vec3 position) {
    precise vec4 clip = view.measured_view_projection * vec4(to_world(position), 1.0);
    precise float w = max(clip.w, view.viewport.z);
    precise vec3 pixels = vec3(0.5 * view.viewport.xy * (clip.xy / w), w);
    return pixels;
}

float pixel_distance(vec3 a, vec3 b) {
    precise vec2 d = a.xy - b.xy;
    precise float squared = d.x * d.x + d.y * d.y;
    return sqrt(squared);
}

// The length in pixels of an edge's curve, as that of a polyline.
float edge_pixels(vec3 p0, vec3 e0, vec3 e1, vec3 p1) {
    vec3 a = to_pixels(p0), e = to_pixels(p1);
    vec3 b = to_pixels(symmetric_sum(cubic_basis(0.25), p0, e0, e1, p1));
    vec3 c = to_pixels(symmetric_sum(cubic_basis(0.5), p0, e0, e1, p1));
    vec3 d = to_pixels(symmetric_sum(cubic_basis(0.75), p0, e0, e1, p1));
    precise float pixels =
        (pixel_distance(a, b) + pixel_distance(d, e)) + (pixel_distance(b, c) + pixel_distance(c, d));
    return pixels;
}

// How far in pixels an edge's curve bends away from its chord, at most: what is seen from the side fully, what comes towards
// the eye in part.
float bend_pixels(vec3 p0, vec3 p1, vec3 bend) {
    precise vec3 middle = 0.5 * (p0 + p1);
    vec3 at = to_pixels(middle);
    precise vec3 moved = middle + bend;
    float across = pixel_distance(to_pixels(moved), at);
    vec3 world = to_world(moved), from = to_world(middle);
    precise vec3 d = world - from;
    precise float scale = 0.5 * view.viewport.y * view.viewport.w / at.z;
    precise float along = DEPTH_WEIGHT * scale * sqrt(exact_dot(d, d));
    return max(across, along);
}

// The segments of an edge that its metric asks for, not yet within limits.
float edge_factor(vec3 p0, vec3 e0, vec3 e1, vec3 p1) {
    if (metric() == METRIC_PIXELS) {
        precise float segments = edge_pixels(p0, e0, e1, p1) / item.factor;
        return segments;
    }
    // A cubic lies within max |P_i - 2 P_i+1 + P_i+2| * 6 / 8 of its chord, and within 1/n^2 of that when cut in n.
    precise vec3 bend0 = 0.75 * ((p0 + e1) - 2.0 * e0);
    precise vec3 bend1 = 0.75 * ((p1 + e0) - 2.0 * e1);
    float bend = max(bend_pixels(p0, p1, bend0), bend_pixels(p1, p0, bend1));
    precise float strayed = bend / item.factor;
    // A segment shorter than a pixel shows nothing.
    return min(sqrt(strayed), edge_pixels(p0, e0, e1, p1));
}

// The factor of edges at a vertex, from what all patches there have: the mean length of its tangents.
float vertex_factor(vec3 p, vec3 a, vec3 b) {
    precise float factor = item.factor;
    if (metric() == METRIC_PIXELS || metric() == METRIC_CURVATURE) {
        precise vec3 along_a = p + 3.0 * a;
        precise vec3 along_b = p + 3.0 * b;
        vec3 from = to_pixels(p);
        factor = max(pixel_distance(to_pixels(along_a), from), pixel_distance(to_pixels(along_b), from)) / factor;
    }
    return clamp(factor, 1.0, MAX_FACTOR);
}

#endif
