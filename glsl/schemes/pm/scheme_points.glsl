// The control points that corner k of a Pm-patch (of a quad: a c-patch) owns: v, t+, t-, b211 of sector k, b121 of sector k - 1 and
// b112 of sector k. Made step by step, as each needs those of the other corners. Rust twin: `pm_points` in src/patch/pm.rs.
#ifndef PM_POINTS_GLSL
#define PM_POINTS_GLSL

#include "pm_mu.glsl"

// What each corner gives to the centre of the patch; of a pentagon, the sum of b112 of sectors i - 1 and i.
#ifdef CONTROL_STAGE
layout(location = 14) patch out vec3 centre_share[CORNERS];
#ifdef PENTAGON
layout(location = 19) patch out vec3 b112_sum[CORNERS];
#endif
#else
vec3 centre_share[CORNERS];
vec3 b112_sum[CORNERS];
#endif

// b211 at the near end of an edge, or b121 at its far end, seen from there; `across` is f - e.
vec3 pm_beside(vec3 v, vec3 t0, vec3 t1, vec3 across, float cos_near, float cos_far) {
    float sines = sqrt(max(1.0 - cos_near * cos_near, 0.0)) + sqrt(max(1.0 - cos_far * cos_far, 0.0));
    return 0.25 * (v + 3.0 * t0) + (1.0 + cos_near) / (4.0 * MU) * (t1 - t0) +
        (2.0 * MU - 1.0 - cos_far) / (8.0 * MU) * (t0 - v) + 3.0 / (4.0 * MU * sines) * across;
}

#ifdef PENTAGON
// b202 of the spoke from corner k.
vec3 pm_b202(uint k) {
    const float c = 1.0 - MU;
    vec3 b301 = (0.5 * owned[k][0] + 0.75 * (owned[k][1] + owned[k][2]) - 2.0 * c * owned[k][0]) / (2.0 * MU);
    return (owned[k][3] + owned[k][4] - 2.0 * c * b301) / (2.0 * MU);
}

// What `pm_centre_of_pentagon` in src/patch/pm.rs sums for the spoke from corner i.
vec3 pm_b112_sum(uint i, vec3 q) {
    const float c = 1.0 - MU;
    const float theta = 1.2566370614359172;
    vec3 sum = 2.0 * MU * q + 2.0 * c * pm_b202(i);
    for (uint j = 0u; j < 5u; ++j) {
        uint next = j == 4u ? 0u : j + 1u;
        uint before = j == 0u ? 4u : j - 1u;
        float angle = theta * (float(i) - float(j));
        float turn = sin(angle) / (5.0 * MU * tan(0.5 * theta));
        // b211 of sector j is owned[j][3], b121 of sector j is owned[j + 1][4].
        sum += turn * (owned[next][4] - owned[before][3] + 2.0 * c * (owned[j][4] - owned[j][3])) -
            0.8 * c * cos(angle) * pm_b202(j);
    }
    return sum;
}
#endif

// The first step: all but what lies inside, and what the corner gives to the centre of the patch.
void pm_outer_points(uint k) {
    precise vec3 v = in_limit(k);
    precise vec3 t_plus = v + in_plus(k);
    precise vec3 t_minus = v + in_minus(k);
    vec3 f = in_inner(k, 0), e_plus = in_inner(k, 1), e_minus = in_inner(k, 2);
    OWNED_BY(k)[0] = v;
    OWNED_BY(k)[1] = t_plus;
    OWNED_BY(k)[2] = t_minus;
    const float weight = CORNERS == 3u ? 2.0 : 1.0;
    centre_share[k] = (weight * v + 3.0 * (e_plus + e_minus) + 9.0 * f) / (float(CORNERS) * (15.0 + weight));
}

// The second: b211 and b121.
void pm_points_beside(uint k) {
    uint next = k + 1u == CORNERS ? 0u : k + 1u;
    uint before = k == 0u ? CORNERS - 1u : k - 1u;
    vec3 v = owned[k][0], f = in_inner(k, 0), e_plus = in_inner(k, 1), e_minus = in_inner(k, 2);
    float cosine = in_cosine(k);
    OWNED_BY(k)[3] = pm_beside(v, owned[k][1], owned[next][2], f - e_plus, cosine, in_cosine(next));
    OWNED_BY(k)[4] = pm_beside(v, owned[k][2], owned[before][1], f - e_minus, cosine, in_cosine(before));
}

#ifdef PENTAGON
// The third of a pentagon: the sum of b112 of sectors k - 1 and k.
void pm_sum_inside(uint k) {
    vec3 q = (centre_share[0] + centre_share[1]) + (centre_share[2] + centre_share[3]) + centre_share[4];
    b112_sum[k] = pm_b112_sum(k, q);
}
#endif

// The last: b112.
void pm_point_inside(uint k) {
    uint next = k + 1u == CORNERS ? 0u : k + 1u;
    uint before = k == 0u ? CORNERS - 1u : k - 1u;
    // b211 of sector i is owned[i][3], b121 of sector i is owned[i + 1][4].
#ifdef TRIANGLE
    vec3 q = centre_share[0] + centre_share[1] + centre_share[2];
    OWNED_BY(k)[5] = 1.5 * q - owned[before][0] / 12.0 - (owned[before][1] + owned[before][2]) / 24.0 -
        (owned[before][3] + owned[before][4]) / 6.0;
#elif defined(PENTAGON)
    uint opposite = (k + 3u) % 5u;
    OWNED_BY(k)[5] = 0.5 * (b112_sum[k] + b112_sum[next] - b112_sum[(k + 2u) % 5u] + b112_sum[opposite] - b112_sum[before]);
#else
    uint opposite = k ^ 2u;
    vec3 q = (centre_share[0] + centre_share[1]) + (centre_share[2] + centre_share[3]);
    OWNED_BY(k)[5] = q +
        (3.0 / 16.0) * (owned[k][3] + owned[next][4] - owned[opposite][4] - owned[before][3]) +
        (1.0 / 16.0) * (owned[next][3] + owned[k][4] - owned[before][4] - owned[opposite][3]);
#endif
}

// Each step needs what the corners made in the one before.
#ifdef PENTAGON
#define POINT_STEPS STEP(pm_outer_points) BETWEEN STEP(pm_points_beside) BETWEEN STEP(pm_sum_inside) BETWEEN STEP(pm_point_inside)
#else
#define POINT_STEPS STEP(pm_outer_points) BETWEEN STEP(pm_points_beside) BETWEEN STEP(pm_point_inside)
#endif

#endif
