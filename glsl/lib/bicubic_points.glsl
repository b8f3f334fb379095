// The control points that corner k of a bicubic Bezier patch owns: its corner point and, as seen from there, two edge points and
// an inner point. Rust twin: `bicubic_points` in src/patch/bicubic.rs.
#ifndef BICUBIC_POINTS_GLSL
#define BICUBIC_POINTS_GLSL

void bicubic_points(uint k) {
    vec3 p = in_limit[k].xyz;
    OWNED_BY(k)[0] = p;
    OWNED_BY(k)[1] = in_plus[k];
    OWNED_BY(k)[2] = in_minus[k];
    vec3 beside = in_centre[(k + 1u) & 3u] + in_centre[(k + 3u) & 3u];
    OWNED_BY(k)[3] = (4.0 * in_centre[k] + 2.0 * beside + in_centre[k ^ 2u]) / 9.0 - p;
}

#endif
