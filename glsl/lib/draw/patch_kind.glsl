// The corners of a patch, and what each owns, where one invocation has all of them: by the scheme and the kind of patches that a
// shader is compiled for.
#ifndef PATCH_KIND_GLSL
#define PATCH_KIND_GLSL

#ifdef TRIANGLE
const uint CORNERS = 3u;
#elif defined(PENTAGON)
const uint CORNERS = 5u;
#else
const uint CORNERS = 4u;
#endif

#ifdef GREGORY
#define OWNED 5
#elif defined(ACC)
#define OWNED 8
#elif defined(PM)
#define OWNED 6
#else
#define OWNED 4
#endif

vec3 owned[CORNERS][OWNED];

#endif
