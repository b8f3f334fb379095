// A vertex that was evaluated by compute: see glsl/evaluate/lattice.comp.
// variants: TEXCOORD
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
#ifdef TEXCOORD
layout(location = 2) in vec2 texcoord;
layout(location = 2) out vec2 out_texcoord;
#endif

void main() {
    world_position = to_world(position);
    world_normal = normal_to_world(normal);
    gl_Position = to_clip(world_position);
#ifdef TEXCOORD
    out_texcoord = texcoord;
#endif
}
