// The patch that a shader is compiled for, where it is evaluated outside of the tessellation stages: the control points that its
// corners own, to be there before `evaluate_surface`.
#ifndef KINDS_GLSL
#define KINDS_GLSL

#ifdef PENTAGON
// A piece of it.
#define TRIANGLE
#endif

#include "draw/patch_kind.glsl"
#include "scheme_evaluate.glsl"

#endif
