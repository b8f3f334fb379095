// One colour, as for the lines of a wireframe.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FRAGMENT_STAGE
#include "draw/draw.glsl"
#include "draw/output.glsl"

void main() {
    write_colour(draw_colour().rgb, draw_colour().a);
}
