// The kind of patch that a shader which evaluates a lattice is compiled for, by the macro that its variant names: how many
// control points its corners own, and `evaluate_surface`. The names are those of `files` in src/renderer/stages.rs.
#ifndef KINDS_GLSL
#define KINDS_GLSL

#if defined(GREGORY_TRIANGLE) || defined(PM_TRIANGLE)
#define TRIANGLE
#define CORNERS 3
#elif defined(PM_PENTAGON)
// A piece of it.
#define TRIANGLE
#define PENTAGON
#define CORNERS 5
#else
#define CORNERS 4
#endif

#if defined(GREGORY_QUAD) || defined(GREGORY_TRIANGLE)
#define OWNED 5
#elif defined(PM_QUAD) || defined(PM_TRIANGLE) || defined(PM_PENTAGON)
#define OWNED 6
#elif defined(ACC)
#define OWNED 8
#else
#define OWNED 4
#endif

// The control points that each corner of the patch owns: to be there before `evaluate_surface`.
vec3 owned[CORNERS][OWNED];

#if defined(GREGORY_QUAD)
#include "evaluate/evaluate_gregory_quad.glsl"
#elif defined(GREGORY_TRIANGLE)
#include "evaluate/evaluate_gregory_triangle.glsl"
#elif defined(PM_QUAD)
#include "evaluate/evaluate_pm_quad.glsl"
#elif defined(PM_TRIANGLE)
#include "evaluate/evaluate_pm_triangle.glsl"
#elif defined(PM_PENTAGON)
#include "evaluate/evaluate_pm_pentagon.glsl"
#elif defined(ACC)
#include "evaluate/evaluate_acc.glsl"
#else
#include "evaluate/evaluate_bicubic.glsl"
#endif

#endif
