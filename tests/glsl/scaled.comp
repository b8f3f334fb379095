#version 460
// A caller's compute shader: positions that move from frame to frame.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Rest { vec4 rest[]; };
layout(set = 0, binding = 1, std430) buffer Moved { float moved[]; };

layout(push_constant, std430) uniform Motion {
    float scale;
    uint count;
    uint first;   // float of the first position
    uint stride;  // floats from one to the next
} motion;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= motion.count) {
        return;
    }
    for (uint axis = 0u; axis < 3u; ++axis) {
        moved[motion.first + i * motion.stride + axis] = motion.scale * rest[i][axis];
    }
}
