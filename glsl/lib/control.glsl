// What all tessellation control shaders share: their outputs, factors and captures.
//
// There is one invocation for each corner of the patch, which writes the OWNED control points that the corner owns, in the
// order of `Scheme::corner_slots` in src/patch/scheme.rs.
#ifndef CONTROL_GLSL
#define CONTROL_GLSL

#include "draw.glsl"
#ifdef CAPTURE_POINTS
#include "capture.glsl"
#endif

#ifdef TRIANGLE
const uint CORNERS = 3u;
layout(vertices = 3) out;
#else
const uint CORNERS = 4u;
layout(vertices = 4) out;
#endif

layout(location = 0) out vec3 owned[][OWNED];
#ifdef TEXCOORD
layout(set = 1, binding = 8, std430) readonly buffer Texcoords { vec2 texcoords[]; };
layout(location = 8) out vec2 texcoord[];
#endif
#ifdef CAPTURE
layout(location = 9) patch out uint captured_patch;
#endif

void set_factors() {
    if (gl_InvocationID == 0) {
        float outer = draw.normal_transform[0].w;
        float inner = draw.normal_transform[1].w;
        gl_TessLevelOuter[0] = outer;
        gl_TessLevelOuter[1] = outer;
        gl_TessLevelOuter[2] = outer;
        gl_TessLevelOuter[3] = outer;
        gl_TessLevelInner[0] = inner;
        gl_TessLevelInner[1] = inner;
    }
}

// What is left to do when the corner's control points are written; `patch_number` counts within the draw.
void finish_corner(uint patch_number) {
    set_factors();
#ifdef TEXCOORD
    texcoord[gl_InvocationID] = texcoords[draw.first_corner + patch_number * CORNERS + uint(gl_InvocationID)];
#endif
#ifdef CAPTURE
    if (gl_InvocationID == 0) {
        captured_patch = draw.first_patch + patch_number;
    }
#endif
#ifdef CAPTURE_POINTS
    for (uint i = 0u; i < OWNED; ++i) {
        capture_point(draw.first_patch + patch_number, uint(gl_InvocationID) * OWNED + i, owned[gl_InvocationID][i]);
    }
#endif
}

#endif
