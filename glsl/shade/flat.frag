// One colour, as for the lines of a wireframe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 0) out vec4 colour;

void main() {
    colour = draw.colour;
}
