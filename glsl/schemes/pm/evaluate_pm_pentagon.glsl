// The first sector of a Pm-patch of a pentagon. Rust twin: `evaluate_pm_pentagon` in src/patch/pm.rs.
// Of the control points `owned[corner][number]` of whatever stage includes it.
#ifndef EVALUATE_PM_PENTAGON_GLSL
#define EVALUATE_PM_PENTAGON_GLSL

#include "evaluate/patch.glsl"
#include "pm.glsl"

PmCorner corner_of(uint k) {
    return PmCorner(owned[k][0], owned[k][1], owned[k][2], owned[k][3], owned[k][4], owned[k][5]);
}

Surface evaluate_pm_pentagon(float x, float y, float z) {
    PmCorner i = corner_of(0);
    PmCorner j = corner_of(1);
    Spoke si = pm_spoke(i, owned[4][5]);
    Spoke sj = pm_spoke(j, owned[0][5]);
    precise vec3 sum = si.b103 + sj.b103 + pm_spoke(corner_of(2), owned[1][5]).b103 + pm_spoke(corner_of(3), owned[2][5]).b103 +
        pm_spoke(corner_of(4), owned[3][5]).b103;
    precise vec3 centre = sum / 5.0;
    return evaluate_sector(i, j, si, sj, centre, x, y, z);
}

Surface evaluate_surface(vec3 at) {
    return evaluate_pm_pentagon(at.x, at.y, at.z);
}

#endif
