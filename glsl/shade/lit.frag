// The smooth surface under one light and the sky.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FRAGMENT_STAGE
#include "draw/draw.glsl"
#include "shade/lighting.glsl"
#include "draw/output.glsl"
#include "evaluate/surface.glsl"

void main() {
    vec3 normal = surface_normal();
    write_colour(lit(draw_colour().rgb, world_position, normal, view.eye.xyz, view.light.xyz), draw_colour().a);
}
