// Pm-patches.
#if defined(PENTAGON)
#include "evaluate_pm_pentagon.glsl"
#elif defined(TRIANGLE)
#include "evaluate_pm_triangle.glsl"
#else
#include "evaluate_pm_quad.glsl"
#endif
