// A vertex that was evaluated by compute: see glsl/evaluate/uniform_grid.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef DISPLACED
#define TEXCOORD
#include "displace/displaced.glsl"
#endif
#include "draw/draw.glsl"
#include "draw/instance_out.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

// The same bits in every pipeline: a pass for depth alone, and one that tests against it.
invariant gl_Position;
layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
#ifdef TEXCOORD
layout(location = 2) in vec2 texcoord;
layout(location = 2) out vec2 out_texcoord;
#endif
#ifdef DISPLACED
layout(location = 3) in vec3 direction;
layout(location = 4) in vec3 lookup;  // xy: where in the map; z: its level
#endif

void main() {
    instance_number = uint(gl_InstanceIndex);
    hand_on_instance();
#ifdef DISPLACED
    world_position = to_world(displace(position, direction, lookup.xy, lookup.z));
#else
    world_position = to_world(position);
#endif
    world_normal = normal_to_world(normal);
    gl_Position = to_clip(world_position);
#ifdef TEXCOORD
    out_texcoord = texcoord;
#endif
}
