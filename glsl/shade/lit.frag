// The smooth surface under one light and the sky.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"
#include "lighting.glsl"
#include "output.glsl"

layout(location = 0) in vec3 world_position;
// Taken inside the triangle: at a silhouette, a normal from beyond its edge may face away.
layout(location = 1) centroid in vec3 world_normal;

void main() {
    write_colour(lit(draw.colour.rgb, world_position, world_normal, view.eye.xyz, view.light.xyz), draw.colour.a);
}
