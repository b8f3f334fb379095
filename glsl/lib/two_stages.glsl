// The two stages of the two-stage construction in one invocation for each patch: see glsl/construct/two_stage.vert and the control
// shaders beside it.
#ifndef TWO_STAGES_GLSL
#define TWO_STAGES_GLSL

#include "corner.glsl"
#include "patch_kind.glsl"

// What the first hands on to the second, by corner.
vec3 in_centre[CORNERS];
vec4 in_limit[CORNERS];
vec3 in_plus[CORNERS];
vec3 in_minus[CORNERS];
#ifdef INNER
vec3 in_inner[CORNERS][INNER];
#endif
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

// Of corner k of the patch whose first corner this is, among all corners.
Corner first_stage(uint first, uint k) {
    Corner corner = corner_of_patch(first + k);
    in_centre[k] = corner.centre;
    in_limit[k] = corner.limit;
    in_plus[k] = corner.plus;
    in_minus[k] = corner.minus;
#ifdef INNER
    in_inner[k] = corner.inner;
#endif
    return corner;
}

#define EACH_CORNER(f) for (uint k = 0u; k < CORNERS; ++k) { f(k); }

// After the first for all corners: the points that they own.
void second_stage() {
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
}

#endif
