// A vertex of a uniform grid: of the `owned` control points and, with SHARED, of what the corners of the patch share.
#ifndef UNIFORM_GRID_SAMPLE_GLSL
#define UNIFORM_GRID_SAMPLE_GLSL

#include "draw/kinds.glsl"

#ifdef TEXCOORD
#include "draw/tables.glsl"
vec2 texcoord[CORNERS];
#endif

#ifdef SHARED
#include "edges/edges.glsl"

// One name for the type of either.
#define UniformGridSample SharedSample

UniformGridSample uniform_grid_sample(vec3 at) {
    return share(evaluate_surface(at), at);
}
#else
#define UniformGridSample Sample

UniformGridSample uniform_grid_sample(vec3 at) {
    return sample_of(evaluate_surface(at));
}
#endif

#endif
