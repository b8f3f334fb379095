// A floor for the bench: a vertex that was evaluated long ago.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;

void main() {
    world_position = to_world(position);
    world_normal = normal_to_world(normal);
    gl_Position = view.view_projection * vec4(world_position, 1.0);
}
