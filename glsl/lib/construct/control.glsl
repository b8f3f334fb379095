// What all tessellation control shaders share: their outputs, factors and captures.
//
// There is one invocation for each corner of the patch, which writes the OWNED control points that the corner owns, in the
// order of `Scheme::corner_slots` in src/patch/scheme.rs.
#ifndef CONTROL_GLSL
#define CONTROL_GLSL

// Displacement needs all that is shared.
#ifdef DISPLACED
#define SHARED
#define TEXCOORD
#endif

#include "draw/draw.glsl"
#ifdef CAPTURE_POINTS
#include "capture/capture.glsl"
#endif

#include "scheme.glsl"

layout(vertices = CORNERS) out;

#include "draw/handed_on.glsl"
// Outputs of a vertex end at location 13: every Vulkan device has 16.
layout(location = 0) out vec4 handed_on[][HANDED_ROWS];
// What is to be handed on of the corner of this invocation.
float numbers[4 * HANDED_ROWS];

#if !defined(OWNED_IS_SHARED) || !defined(CONTROL_STAGE)
// The control points of the corner of this invocation, to write to; then, those of all corners.
vec3 own[OWNED];
#define OWNED_BY(k) own
vec3 owned[CORNERS][OWNED];
#else
// Invocations make their control points out of those of each other.
layout(location = 5) out vec3 owned[][OWNED];
#define OWNED_BY(k) owned[gl_InvocationID]
#endif
#ifdef TEXCOORD
#include "draw/tables.glsl"
#endif
#ifdef READS_LEAVES
#include "evaluate/leaves.glsl"
#endif
#ifdef CAPTURE
layout(location = 11) patch out uint captured_patch;
#endif

// The instance, where there are several.
layout(location = LOCATION_PATCH_INSTANCE) patch out uint instance_of_patch;

// For the first invocation to put together.
layout(location = 12) out uint outside[];
layout(location = 13) out vec4 pixel_box[];
#include "edges/culling.glsl"
#include "edges/edge_factors.glsl"
#ifdef MAY_BE_ADAPTIVE
#include "edges/hulls.glsl"
#endif
#ifdef READS_LEAVES
#include "construct/leaf.glsl"
#endif

// What culling looks at of the corner of this invocation.
Examined examine_corner(uint patch_number, vec3 points[OWNED]) {
#ifdef READS_LEAVES
    if (IS_BY_LEAVES) {
        return examine_leaf(patch_number);
    }
#endif
#ifdef MAY_BE_ADAPTIVE
    if (ADAPTIVE) {
        return examine_hull(draw.first_patch + patch_number, uint(gl_InvocationID), CORNERS);
    }
#endif
    return examine(points);
}

// What is left to do when all control points are written and a barrier is passed. `patch_number` counts within the draw.
void finish_patch(uint patch_number) {
    if (gl_InvocationID != 0) {
        return;
    }
#if !defined(OWNED_IS_SHARED) || !defined(CONTROL_STAGE)
    for (uint k = 0u; k < CORNERS; ++k) {
        for (int i = 0; i < OWNED; ++i) {
            owned[k][i] = PACKED_VECTOR(handed_on[k], 3 * i);
        }
    }
#endif
    if (INSTANCES) {
        instance_of_patch = instance_number;
    }
    float asked[CORNERS], outer[CORNERS];
    float largest = 1.0, smallest = MAX_FACTOR;
    for (uint k = 0u; k < CORNERS; ++k) {
#ifdef READS_LEAVES
        asked[k] = IS_BY_LEAVES ? leaf_factor(patch_number, k) : plus_factor(patch_number, k);
#else
        asked[k] = plus_factor(patch_number, k);
#endif
        outer[k] = within_limits(asked[k]);
        largest = max(largest, outer[k]);
        smallest = min(smallest, outer[k]);
    }
    bool culled = (DRAW_FLAGS & CULL_FLAGS) != 0u && is_culled(1.0 / smallest);
    // With fractional spacing an inner factor of nearly 1 would put vertices of the inside on the edge.
    float least = largest > 1.0 && metric() != METRIC_UNIFORM ? min(1.5, MAX_FACTOR) : 1.0;
    float inside = largest;
#if defined(READS_LEAVES) && defined(TRIANGLE)
    // A triangle of a leaf is half as wide along one edge as along the others.
    precise float mean = sqrt(smallest * largest);
    inside = IS_BY_LEAVES ? mean : largest;
#endif
    vec2 inner = vec2(max(least, inside));
#if defined(PENTAGON)
    // One of five pieces: the edge from its first corner, and two spokes, for which all pieces have the same factor.
    gl_TessLevelOuter[0] = largest;
    gl_TessLevelOuter[1] = largest;
    gl_TessLevelOuter[2] = outer[0];
    gl_TessLevelOuter[3] = largest;
#elif defined(TRIANGLE)
    gl_TessLevelOuter[0] = culled ? 0.0 : outer[1];
    gl_TessLevelOuter[1] = culled ? 0.0 : outer[2];
    gl_TessLevelOuter[2] = culled ? 0.0 : outer[0];
    // Of no use but where a grid is captured, which is laid over a quad domain.
    gl_TessLevelOuter[3] = outer[0];
#else
    inner = max(vec2(least), vec2(max(outer[0], outer[2]), max(outer[1], outer[3])));
    gl_TessLevelOuter[0] = culled ? 0.0 : outer[3];
    gl_TessLevelOuter[1] = culled ? 0.0 : outer[0];
    gl_TessLevelOuter[2] = culled ? 0.0 : outer[1];
    gl_TessLevelOuter[3] = culled ? 0.0 : outer[2];
#endif
    gl_TessLevelInner[0] = inner.x;
    gl_TessLevelInner[1] = inner.y;
#ifdef CAPTURE
    captured_patch = draw.first_patch + patch_number;
#endif
#ifdef CAPTURE_POINTS
#ifdef TRIANGLE
    vec4 of_edges = vec4(asked[0], asked[1], asked[2], 0.0);
#else
    vec4 of_edges = vec4(asked[0], asked[1], asked[2], asked[3]);
#endif
    capture_factors(draw.first_patch + patch_number, of_edges, inner, culled);
#endif
}

// What is left to do when the corner's control points are written, and `write_shared` was called; `patch_number` counts within the
// draw. A barrier and `finish_patch` have to follow.
void finish_corner(uint patch_number) {
    vec3 points[OWNED] = OWNED_BY(gl_InvocationID);
    for (int i = 0; i < OWNED; ++i) {
        PUT_VECTOR(numbers, 3 * i, points[i]);
    }
#ifdef TEXCOORD
    vec2 texcoord = corner_texcoord(draw.first_corner + patch_number * CORNERS + uint(gl_InvocationID));
    PUT_PAIR(numbers, HANDED_TEXCOORD, texcoord);
#endif
#ifdef MAY_BE_ADAPTIVE
    uint of_all = draw.first_patch + patch_number;
    numbers[HANDED_PATCH] = float(gl_InvocationID == 0 ? of_all & 0xffffffu : of_all >> 24);
#endif
    for (int i = 0; i < HANDED_ROWS; ++i) {
        handed_on[gl_InvocationID][i] = ROW_OF(numbers, i);
    }
    if ((DRAW_FLAGS & CULL_FLAGS) != 0u) {
        Examined examined = examine_corner(patch_number, points);
        outside[gl_InvocationID] = examined.outside;
        pixel_box[gl_InvocationID] = examined.pixel_box;
    }
#ifdef CAPTURE_POINTS
    for (uint i = 0u; i < OWNED; ++i) {
        capture_point(draw.first_patch + patch_number, uint(gl_InvocationID) * OWNED + i,
                      i == 0u ? points[0] : POINT_OF(points, i));
    }
#endif
}

#endif
