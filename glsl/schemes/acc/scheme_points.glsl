// The control points that corner k of an ACC patch owns: b at the corner, along its plus and minus edge and inside, then t+,
// t-, x+, x-. Rust twin: `acc_points` in src/patch/acc.rs.
#ifndef ACC_POINTS_GLSL
#define ACC_POINTS_GLSL

#include "acc.glsl"

void acc_points(uint k) {
    uint next = (k + 1u) & 3u;
    uint before = (k + 3u) & 3u;
    vec3 inner = in_inner(k, 0), along_plus = in_inner(k, 3), along_minus = in_inner(k, 4);
    precise vec3 t_plus = 3.0 * in_plus(k);
    precise vec3 t_minus = 3.0 * in_minus(k);
    OWNED_BY(k)[0] = in_limit(k);
    OWNED_BY(k)[1] = along_plus;
    OWNED_BY(k)[2] = along_minus;
    OWNED_BY(k)[3] = inner;
    OWNED_BY(k)[4] = t_plus;
    OWNED_BY(k)[5] = t_minus;
    float cosine = in_cosine(k);
    OWNED_BY(k)[6] = acc_across(inner, in_inner(k, 1), along_plus, in_inner(next, 4), t_plus, cosine, in_cosine(next));
    OWNED_BY(k)[7] =
        acc_across(inner, in_inner(k, 2), along_minus, in_inner(before, 3), t_minus, cosine, in_cosine(before));
}

#define POINT_STEPS STEP(acc_points)

#endif
