#version 460
#extension GL_GOOGLE_include_directive : require
// A caller's fragment shader: the words of an item as a colour, in 1/255, and the colour of the draw beneath it.
#define FRAGMENT_STAGE
#include "draw/draw.glsl"

layout(location = 0) out vec4 colour;

void main() {
    colour = vec4(vec3(draw_words().xyz) / 255.0, 1.0) + 0.5 * draw_colour();
}
