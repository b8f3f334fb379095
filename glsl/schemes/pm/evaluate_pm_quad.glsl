// A Pm-patch of a quad: a c-patch. Rust twin: `evaluate_pm_quad` in src/patch/pm.rs.
// Of the control points `owned[corner][number]` of whatever stage includes it.
#ifndef EVALUATE_PM_QUAD_GLSL
#define EVALUATE_PM_QUAD_GLSL

#include "evaluate/patch.glsl"
#include "pm.glsl"

// A sum with the weights of the sector's corner: constant indices into the inputs are much faster than varying ones.
vec3 pick(vec4 which, vec3 x0, vec3 x1, vec3 x2, vec3 x3) {
    precise vec3 sum = (which.x * x0 + which.y * x1) + (which.z * x2 + which.w * x3);
    return sum;
}

#define PICK(which, n) pick(which, owned[0][n], owned[1][n], owned[2][n], owned[3][n])

PmCorner corner_of(vec4 which) {
    return PmCorner(PICK(which, 0), PICK(which, 1), PICK(which, 2), PICK(which, 3), PICK(which, 4), PICK(which, 5));
}

Surface evaluate_pm_quad(float u, float v) {
    bool below = v <= u;
    bool left = u + v <= 1.0;
    vec4 which = below ? (left ? vec4(1, 0, 0, 0) : vec4(0, 1, 0, 0)) : (left ? vec4(0, 0, 0, 1) : vec4(0, 0, 1, 0));
    precise vec3 at = below ? (left ? vec3(1.0 - u - v, u - v, 2.0 * v) : vec3(u - v, u + v - 1.0, 2.0 - 2.0 * u))
                    : (left ? vec3(v - u, 1.0 - u - v, 2.0 * u) : vec3(u + v - 1.0, v - u, 2.0 - 2.0 * v));
    PmCorner i = corner_of(which);
    PmCorner j = corner_of(which.wxyz);
    Spoke si = pm_spoke(i, PICK(which.yzwx, 5));
    Spoke sj = pm_spoke(j, i.b112);
    precise vec3 centre = 0.25 * ((owned[0][5] + owned[1][5]) + (owned[2][5] + owned[3][5]));
    return evaluate_sector(i, j, si, sj, centre, at.x, at.y, at.z);
}

Surface evaluate_surface(vec3 at) {
    return evaluate_pm_quad(at.x, at.y);
}

#endif
