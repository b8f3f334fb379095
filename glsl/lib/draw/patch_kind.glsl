// The control points that each corner of a patch owns, where one invocation has all of them. CORNERS and OWNED are those of the
// patch that a shader is compiled for: see src/renderer/shader/axes.rs.
#ifndef PATCH_KIND_GLSL
#define PATCH_KIND_GLSL

vec3 owned[CORNERS][OWNED];

#endif
