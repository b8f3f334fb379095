// What corner k of a Gregory patch keeps of the control points that it owns, p, e+, e-, f+, f-: see CONTROL_POINT. Rust twin:
// `gregory_points` in src/patch/gregory.rs.
#ifndef GREGORY_POINTS_GLSL
#define GREGORY_POINTS_GLSL

// f+ or f- as seen from the corner: `near` and `far` are the edge points, `side` the transversal as seen from this face.
vec3 face_point(vec3 near, vec3 far, float cos_near, float cos_far, vec3 side) {
    const float d = CORNERS == 4u ? 3.0 : 4.0;
    return ((d - 2.0 * cos_near - cos_far) * near + (2.0 * cos_near) * far + side) / d;
}

void gregory_points(uint k) {
    uint next = k + 1u == CORNERS ? 0u : k + 1u;
    uint before = k == 0u ? CORNERS - 1u : k - 1u;
    vec3 limit = in_limit(k), plus = in_plus(k), minus = in_minus(k);
    vec3 far_plus = (in_limit(next) - limit) + in_minus(next);
    vec3 far_minus = (in_limit(before) - limit) + in_plus(before);
    float cosine = in_cosine(k);
    OWNED_BY(k)[0] = limit;
    OWNED_BY(k)[1] = plus;
    OWNED_BY(k)[2] = minus;
    vec3 f_plus = face_point(plus, far_plus, cosine, in_cosine(next), in_inner(k, 0));
    // The face lies on the right of its minus edge.
    vec3 f_minus = face_point(minus, far_minus, cosine, in_cosine(before), -in_inner(k, 1));
    OWNED_BY(k)[3] = CORNERS == 4u ? f_plus - (plus + minus) : f_plus;
    OWNED_BY(k)[4] = f_minus - f_plus;
}

#define POINT_STEPS STEP(gregory_points)

#endif
