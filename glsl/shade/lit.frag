// The smooth surface under one light and the sky.
// variants: DISPLACED
#version 460
#extension GL_GOOGLE_include_directive : require
#define FRAGMENT_STAGE
#include "draw.glsl"
#include "lighting.glsl"
#include "output.glsl"
#include "surface.glsl"

void main() {
    vec3 normal = surface_normal();
    write_colour(lit(draw.colour.rgb, world_position, normal, view.eye.xyz, view.light.xyz), draw.colour.a);
}
