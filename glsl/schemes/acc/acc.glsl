// The tangents across the edges of an ACC patch, wherever they are made. Rust twin: `acc_points` in src/patch/acc.rs.
#ifndef ACC_GLSL
#define ACC_GLSL

// x+ or x-: `near` and `far` are the geometry's points along the edge, `middle` is that between its faces.
vec3 acc_across(vec3 inner, vec3 middle, vec3 near, vec3 far, vec3 tangent, float cos_near, float cos_far) {
    return 2.0 * cos_near * (far - near) - (cos_far / 3.0) * tangent + 3.0 * (inner - middle);
}

#endif
