// The cached construction, once a frame, after glsl/compute/frames.comp: what the corners of a patch own and share. The two stages
// of the two-stage construction in one invocation for each patch.
// variants: GREGORY, GREGORY+TRIANGLE, ACC, PM, PM+TRIANGLE, PM+PENTAGON
// variants: SHARED, GREGORY+SHARED, GREGORY+TRIANGLE+SHARED, DISPLACED, GREGORY+DISPLACED, GREGORY+TRIANGLE+DISPLACED
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef DISPLACED
#define SHARED
#endif
#define KEPT_FRAMES
#define MAKES_POINTS
#include "cached.glsl"
#include "corner.glsl"
#include "invocation.glsl"

#ifdef TRIANGLE
const uint CORNERS = 3u;
#elif defined(PENTAGON)
const uint CORNERS = 5u;
#else
const uint CORNERS = 4u;
#endif

#ifdef GREGORY
#define OWNED 5
#elif defined(ACC)
#define OWNED 8
#elif defined(PM)
#define OWNED 6
#else
#define OWNED 4
#endif

// What the vertex shader would hand on: see frames.glsl.
Corner corners[CORNERS];
#define in_centre(k) corners[k].centre
#define in_limit(k) corners[k].limit.xyz
#define in_cosine(k) corners[k].limit.w
#define in_plus(k) corners[k].plus
#define in_minus(k) corners[k].minus
#define in_inner(k, i) corners[k].inner[i]
vec3 owned[CORNERS][OWNED];
#define OWNED_BY(k) owned[k]

#ifdef GREGORY
#include "gregory_points.glsl"
#elif defined(ACC)
#include "acc_points.glsl"
#elif defined(PM)
vec3 centre_share[CORNERS];
vec3 b112_sum[CORNERS];
#include "pm_points.glsl"
#else
#include "bicubic_points.glsl"
#endif

#define EACH_CORNER(f) for (uint k = 0u; k < CORNERS; ++k) { f(k); }

void main() {
    uint index = invocation_number();
    if (index >= invocations.count) {
        return;
    }
    uint first = invocations.first_corner + index * CORNERS;
    for (uint k = 0u; k < CORNERS; ++k) {
        corners[k] = corner_of_patch(first + k);
#ifdef SHARED
        for (uint i = 0u; i < SHARED_VECTORS; ++i) {
            keep_vector(first + k, OWNED + i, corners[k].with[i]);
        }
        keep_number(first + k, 3u * (OWNED + SHARED_VECTORS), corner_bits(first + k) != 0u ? 1.0 : 0.0);
#endif
    }
#ifdef GREGORY
    EACH_CORNER(gregory_points)
#elif defined(ACC)
    EACH_CORNER(acc_points)
#elif defined(PM)
    EACH_CORNER(pm_outer_points)
    EACH_CORNER(pm_points_beside)
#ifdef PENTAGON
    EACH_CORNER(pm_sum_inside)
#endif
    EACH_CORNER(pm_point_inside)
#else
    EACH_CORNER(bicubic_points)
#endif
    for (uint k = 0u; k < CORNERS; ++k) {
        for (uint i = 0u; i < OWNED; ++i) {
            keep_vector(first + k, i, owned[k][i]);
        }
    }
}
