// The control vertices of a model, packed without gaps.
#ifndef POSITIONS_GLSL
#define POSITIONS_GLSL

layout(set = 1, binding = 0, std430) readonly buffer Positions { float positions[]; };

vec3 vertex_position(uint vertex) {
    return vec3(positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]);
}

#endif
