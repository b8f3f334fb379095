// A Pm-patch of a triangle. Rust twin: `evaluate_pm_triangle` in src/patch/pm.rs.
// Of the control points `owned[corner][number]` of whatever stage includes it.
#ifndef EVALUATE_PM_TRIANGLE_GLSL
#define EVALUATE_PM_TRIANGLE_GLSL

#include "evaluate/patch.glsl"
#include "pm.glsl"

// A sum with the weights of the sector's corner: constant indices into the inputs are much faster than varying ones.
vec3 pick(vec3 which, vec3 x0, vec3 x1, vec3 x2) {
    precise vec3 sum = (which.x * x0 + which.y * x1) + which.z * x2;
    return sum;
}

#define PICK(which, n) pick(which, owned[0][n], owned[1][n], owned[2][n])

PmCorner corner_of(vec3 which) {
    return PmCorner(PICK(which, 0), PICK(which, 1), PICK(which, 2), PICK(which, 3), PICK(which, 4), PICK(which, 5));
}

Surface evaluate_pm_triangle(float u, float v, float w) {
    // A sector is where its opposite corner's coordinate is the least.
    bool first = w <= u && w <= v;
    bool second = u <= v;
    vec3 which = first ? vec3(1, 0, 0) : second ? vec3(0, 1, 0) : vec3(0, 0, 1);
    precise vec3 at = first ? vec3(u - w, v - w, 3.0 * w) : second ? vec3(v - u, w - u, 3.0 * u) : vec3(w - v, u - v, 3.0 * v);
    PmCorner i = corner_of(which);
    PmCorner j = corner_of(which.zxy);
    PmCorner k = corner_of(which.yzx);
    Spoke si = pm_spoke(i, k.b112);
    Spoke sj = pm_spoke(j, i.b112);
    Spoke sk = pm_spoke(k, j.b112);
    precise vec3 centre = (si.b103 + sj.b103 + sk.b103) / 3.0;
    return evaluate_sector(i, j, si, sj, centre, at.x, at.y, at.z);
}

Surface evaluate_surface(vec3 at) {
    return evaluate_pm_triangle(at.x, at.y, at.z);
}

#endif
