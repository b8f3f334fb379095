// A control vertex as it is: for the faces and edges of the control mesh itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw/draw.glsl"
#include "draw/instance_out.glsl"
#include "draw/positions.glsl"

// The same bits in every pipeline: a pass for depth alone, and one that tests against it.
invariant gl_Position;
layout(location = 0) out vec3 world_position;

void main() {
    instance_number = uint(gl_InstanceIndex);
    hand_on_instance();
    world_position = to_world(vertex_position(uint(gl_VertexIndex)));
    gl_Position = to_clip(world_position);
}
