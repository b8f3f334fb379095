// A character's control vertices, skinned: what a vertex was bound to moves it. One invocation for each.
#version 460

layout(local_size_x = 64) in;

struct Influence {
    uint matrix;
    float weight;
};

layout(set = 0, binding = 0, std430) readonly buffer Bound { vec4 bound[]; };
layout(set = 0, binding = 1, std430) readonly buffer Influences { Influence influences[]; };
layout(set = 0, binding = 2, std430) readonly buffer Matrices { mat4 matrices[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Skinned { vec4 skinned[]; };

layout(push_constant, std430) uniform Vertices {
    uint influences;  // of each, those without weight too
    uint count;
} vertices;

void main() {
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= vertices.count) {
        return;
    }
    vec4 position = vec4(bound[vertex].xyz, 1.0), sum = vec4(0.0);
    for (uint i = 0; i < vertices.influences; ++i) {
        Influence of = influences[vertex * vertices.influences + i];
        sum += of.weight * (matrices[of.matrix] * position);
    }
    skinned[vertex] = sum.w > 0.0 ? sum : position;
}
