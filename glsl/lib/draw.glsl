// What every shader of a draw knows: the view, the draw's own constants, and the control vertices.
// Rust twins: `View` and `DrawConstants` in src/renderer/gpu_data.rs.
#ifndef DRAW_GLSL
#define DRAW_GLSL

layout(set = 0, binding = 0, std140) uniform View {
    mat4 view_projection;
    vec4 eye;    // xyz: in world space
    vec4 light;  // xyz: towards the light, in world space, of length one
} view;

layout(push_constant, std430) uniform Draw {
    vec4 transform[3];         // rows: object to world
    vec4 normal_transform[3];  // rows; w: outer factor, inner factor, unused
    vec4 colour;
    uint first_corner;
    uint first_patch;
    uint patches_per_instance;
    uint flags;
} draw;

vec3 to_world(vec3 position) {
    vec4 p = vec4(position, 1.0);
    // The same bits in every pipeline: patches of two kinds meet at their edges on the screen, too.
    precise vec3 world = vec3(dot(draw.transform[0], p), dot(draw.transform[1], p), dot(draw.transform[2], p));
    return world;
}

vec3 normal_to_world(vec3 normal) {
    return vec3(dot(draw.normal_transform[0].xyz, normal), dot(draw.normal_transform[1].xyz, normal),
                dot(draw.normal_transform[2].xyz, normal));
}

#endif
