// Gregory patches.
#ifdef TRIANGLE
#include "evaluate_gregory_triangle.glsl"
#else
#include "evaluate_gregory_quad.glsl"
#endif
