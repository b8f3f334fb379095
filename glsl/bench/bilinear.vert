// A floor for the bench: a corner of a face as it is. One invocation for each corner of each patch.
#version 460
#extension GL_GOOGLE_include_directive : require
#define POSITION_TEXELS 2
#include "constants.glsl"
#include "draw/draw.glsl"
#include "draw/positions.glsl"

layout(constant_id = ID_CORNERS) const uint CORNERS = 4u;

layout(set = 1, binding = 1, std430) readonly buffer Corners { uint corners[]; };

layout(location = 0) out vec3 corner;

void main() {
    uint first = uint(gl_InstanceIndex) * draw.patches_per_instance;
    corner = vertex_position(corners[draw.first_corner + first * CORNERS + uint(gl_VertexIndex)]);
}
