// The direction of the normal as a colour: x red, y green, z blue, from -1 at 0 to 1 at full.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"
#include "output.glsl"

layout(location = 0) in vec3 world_position;
// Taken inside the triangle: at a silhouette, a normal from beyond its edge may face away.
layout(location = 1) centroid in vec3 world_normal;

void main() {
    write_colour(0.5 + 0.5 * normalize(world_normal), draw.colour.a);
}
