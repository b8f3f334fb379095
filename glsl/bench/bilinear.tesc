// A floor for the bench: the corners pass through.
// variants: TRIANGLE
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw/draw.glsl"

#ifdef TRIANGLE
layout(vertices = 3) out;
#else
layout(vertices = 4) out;
#endif

layout(location = 0) in vec3 corner[];
layout(location = 0) out vec4 handed_on[][1];
layout(location = LOCATION_PATCH_INSTANCE) patch out uint instance_of_patch;

void main() {
    handed_on[gl_InvocationID][0] = vec4(corner[gl_InvocationID], 0.0);
    if (gl_InvocationID == 0) {
        float factor = item.factor;
        gl_TessLevelOuter[0] = factor;
        gl_TessLevelOuter[1] = factor;
        gl_TessLevelOuter[2] = factor;
        gl_TessLevelOuter[3] = factor;
        gl_TessLevelInner[0] = factor;
        gl_TessLevelInner[1] = factor;
    }
}
