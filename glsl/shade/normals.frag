// The direction of the normal as a colour: x red, y green, z blue, from -1 at 0 to 1 at full.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FRAGMENT_STAGE
#include "draw/draw.glsl"
#include "draw/output.glsl"
#include "evaluate/surface.glsl"

void main() {
    write_colour(0.5 + 0.5 * normalize(surface_normal()), draw_colour().a);
}
