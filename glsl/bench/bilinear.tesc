// A floor for the bench: the corners pass through.
// variants: TRIANGLE
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 1
#include "control.glsl"

layout(location = 0) in vec3 corner[];

void main() {
    owned[gl_InvocationID][0] = corner[gl_InvocationID];
    finish_corner(0u);
}
