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

#include "draw.glsl"
#ifdef CAPTURE_POINTS
#include "capture.glsl"
#endif

#ifdef TRIANGLE
const uint CORNERS = 3u;
layout(vertices = 3) out;
#elif defined(PENTAGON)
const uint CORNERS = 5u;
layout(vertices = 5) out;
#else
const uint CORNERS = 4u;
layout(vertices = 4) out;
#endif

layout(location = 0) out vec3 owned[][OWNED];
// To write to: of the corner of this invocation.
#define OWNED_BY(k) owned[gl_InvocationID]
#ifdef TEXCOORD
layout(set = 1, binding = 8, std430) readonly buffer Texcoords { vec2 texcoords[]; };
layout(location = 8) out vec2 texcoord[];
#endif
#ifdef CAPTURE
layout(location = 9) patch out uint captured_patch;
#endif

// For the first invocation to put together.
layout(location = 28) out uint outside[];
layout(location = 29) out vec4 pixel_box[];
#include "culling.glsl"
#include "edge_factors.glsl"

// What is left to do when all control points are written and a barrier is passed. `patch_number` counts within the draw.
void finish_patch(uint patch_number) {
    if (gl_InvocationID != 0) {
        return;
    }
    float asked[CORNERS], outer[CORNERS];
    float largest = 1.0, smallest = MAX_FACTOR;
    for (uint k = 0u; k < CORNERS; ++k) {
        asked[k] = plus_factor(patch_number, k);
        outer[k] = within_limits(asked[k]);
        largest = max(largest, outer[k]);
        smallest = min(smallest, outer[k]);
    }
    bool culled = (DRAW_FLAGS & CULL_FLAGS) != 0u && is_culled(1.0 / smallest);
    // With fractional spacing an inner factor of nearly 1 would put vertices of the inside on the edge.
    float least = largest > 1.0 && metric() != METRIC_UNIFORM ? min(1.5, MAX_FACTOR) : 1.0;
    vec2 inner = vec2(max(least, largest));
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

// What is left to do when the corner's control points are written; `patch_number` counts within the draw. A barrier and
// `finish_patch` have to follow.
void finish_corner(uint patch_number) {
#ifdef TEXCOORD
    texcoord[gl_InvocationID] = texcoords[draw.first_corner + patch_number * CORNERS + uint(gl_InvocationID)];
#endif
    if ((DRAW_FLAGS & CULL_FLAGS) != 0u) {
        Examined examined = examine(uint(gl_InvocationID));
        outside[gl_InvocationID] = examined.outside;
        pixel_box[gl_InvocationID] = examined.pixel_box;
    }
#ifdef CAPTURE_POINTS
    for (uint i = 0u; i < OWNED; ++i) {
        capture_point(draw.first_patch + patch_number, uint(gl_InvocationID) * OWNED + i,
                      i == 0u ? owned[gl_InvocationID][0] : CONTROL_POINT(gl_InvocationID, i));
    }
#endif
}

#endif
