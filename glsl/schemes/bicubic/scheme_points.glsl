// What corner k of a bicubic Bezier patch keeps of the control points that it owns, its corner point, two edge points and an inner
// point: see CONTROL_POINT. Rust twin: `bicubic_points` in src/blend/bicubic.rs.
#ifndef BICUBIC_POINTS_GLSL
#define BICUBIC_POINTS_GLSL

void bicubic_points(uint k) {
    vec3 p = in_limit(k);
    OWNED_BY(k)[0] = p;
    vec3 plus = in_plus(k), minus = in_minus(k);
    OWNED_BY(k)[1] = plus;
    OWNED_BY(k)[2] = minus;
    vec3 beside = in_centre((k + 1u) & 3u) + in_centre((k + 3u) & 3u);
    vec3 inner = (4.0 * in_centre(k) + 2.0 * beside + in_centre(k ^ 2u)) / 9.0 - p;
    OWNED_BY(k)[3] = inner - (plus + minus);
}

#define POINT_STEPS STEP(bicubic_points)

#endif
