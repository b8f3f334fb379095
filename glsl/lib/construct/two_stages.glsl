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

#include "scheme_points.glsl"

#define STEP(f) for (uint k = 0u; k < CORNERS; ++k) { f(k); }
#define BETWEEN

// The points that the corners own, when all of `corners` are there.
void second_stage() {
    POINT_STEPS
}

#endif
