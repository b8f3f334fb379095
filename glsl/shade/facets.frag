// The faces of the control mesh, each lit by its own plane.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FRAGMENT_STAGE
#include "draw/draw.glsl"
#include "shade/lighting.glsl"
#include "draw/output.glsl"

layout(location = 0) in vec3 world_position;

void main() {
    vec3 normal = cross(dFdx(world_position), dFdy(world_position));
    write_colour(lit(draw_colour().rgb, world_position, normal, view.eye.xyz, view.light.xyz), draw_colour().a);
}
