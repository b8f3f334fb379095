#ifndef PM_MU_GLSL
#define PM_MU_GLSL

// 1 - cos(2 pi / CORNERS). Rust twin: `mu` in src/patch/pm.rs.
const float MU = int(CORNERS) == 3 ? 1.5 : int(CORNERS) == 4 ? 1.0 : 0.690983005625;

#endif
