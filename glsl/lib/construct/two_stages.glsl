// The two stages of the two-stage construction in one invocation for each patch: see glsl/construct/two_stage.vert and the control
// shaders beside it.
#ifndef TWO_STAGES_GLSL
#define TWO_STAGES_GLSL

#include "construct/corner.glsl"
#include "draw/patch_kind.glsl"

// What the first hands on to the second: see frames.glsl.
Corner corners[CORNERS];
#define in_centre(k) corners[k].centre
#define in_limit(k) corners[k].limit.xyz
#define in_cosine(k) corners[k].limit.w
#define in_plus(k) corners[k].plus
#define in_minus(k) corners[k].minus
#define in_inner(k, i) corners[k].inner[i]
#define OWNED_BY(k) owned[k]

#ifdef GREGORY
#include "construct/gregory_points.glsl"
#elif defined(ACC)
#include "construct/acc_points.glsl"
#elif defined(PM)
vec3 centre_share[CORNERS];
vec3 b112_sum[CORNERS];
#include "construct/pm_points.glsl"
#else
#include "construct/bicubic_points.glsl"
#endif

#define EACH_CORNER(f) for (uint k = 0u; k < CORNERS; ++k) { f(k); }

// The points that the corners own, when all of `corners` are there.
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
