#version 460
#extension GL_GOOGLE_include_directive : require
#include "level.glsl"

layout(vertices = 4) out;

layout(location = 0) in vec2 corner[];
layout(location = 1) in uint patch_id[];
layout(location = 0) out vec2 patch_corner[];
layout(location = 1) patch out uint id;

void main()
{
    patch_corner[gl_InvocationID] = corner[gl_InvocationID];
    if (gl_InvocationID == 0) {
        id = patch_id[0];
        set_levels(LEVEL);
    }
}
