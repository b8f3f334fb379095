// Evaluation of Pm-patches. Rust twin: `evaluate_sector` in src/patch/pm.rs.
#ifndef PM_GLSL
#define PM_GLSL

#include "pm_mu.glsl"

const float C = 1.0 - MU;

// What a corner owns.
struct PmCorner {
    vec3 v;
    vec3 t_plus;
    vec3 t_minus;
    vec3 b211;         // of the sector that starts here
    vec3 b121_before;  // of the sector that ends here
    vec3 b112;         // of the sector that starts here
};

// A spoke from a corner to the centre.
struct Spoke {
    vec3 b301;
    vec3 b202;
    vec3 b103;
};

vec3 pm_across(vec3 left, vec3 right, vec3 spoke) {
    precise vec3 across = (left + right - (2.0 * C) * spoke) / (2.0 * MU);
    return across;
}

Spoke pm_spoke(PmCorner corner, vec3 b112_before) {
    precise vec3 plus = 0.25 * (corner.v + 3.0 * corner.t_plus), minus = 0.25 * (corner.v + 3.0 * corner.t_minus);
    vec3 b301 = pm_across(plus, minus, corner.v);
    vec3 b202 = pm_across(corner.b211, corner.b121_before, b301);
    return Spoke(b301, b202, pm_across(corner.b112, b112_before, b202));
}

// The sector between corners i and j at barycentric (x, y, z), z = 1 at the centre: de Casteljau's algorithm on a quartic.
Surface evaluate_sector(PmCorner i, PmCorner j, Spoke si, Spoke sj, vec3 centre, float x, float y, float z) {
    precise vec3 r00 = i.v, r04 = j.v;
    precise vec3 r01 = 0.25 * (i.v + 3.0 * i.t_plus), r03 = 0.25 * (j.v + 3.0 * j.t_minus);
    precise vec3 r02 = 0.5 * (i.t_plus + j.t_minus);
    vec3 r10 = si.b301, r11 = i.b211, r12 = j.b121_before, r13 = sj.b301;
    vec3 r20 = si.b202, r21 = i.b112, r22 = sj.b202;
    vec3 r30 = si.b103, r31 = sj.b103;
#define STEP(p, q, r) ((x * (p) + y * (q)) + z * (r))
    precise vec3 s00 = STEP(r00, r01, r10), s01 = STEP(r01, r02, r11), s02 = STEP(r02, r03, r12), s03 = STEP(r03, r04, r13);
    precise vec3 s10 = STEP(r10, r11, r20), s11 = STEP(r11, r12, r21), s12 = STEP(r12, r13, r22);
    precise vec3 s20 = STEP(r20, r21, r30), s21 = STEP(r21, r22, r31);
    precise vec3 s30 = STEP(r30, r31, centre);
    precise vec3 q00 = STEP(s00, s01, s10), q01 = STEP(s01, s02, s11), q02 = STEP(s02, s03, s12);
    precise vec3 q10 = STEP(s10, s11, s20), q11 = STEP(s11, s12, s21);
    precise vec3 q20 = STEP(s20, s21, s30);
    precise vec3 a = STEP(q00, q01, q10), b = STEP(q01, q02, q11), c = STEP(q10, q11, q20);
    precise vec3 edge = j.v - i.v, spoke = centre - i.v;
    precise vec3 position = STEP(a, b, c), du = 4.0 * (a - c), dv = 4.0 * (b - c);
#undef STEP
    return Surface(position, du, dv, cross(edge, spoke));
}

#endif
