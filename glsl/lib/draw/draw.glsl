// What every shader of a draw knows: the view and the draw's own constants.
// Rust twins: `ViewData` and `DrawConstants` in src/renderer/shader/gpu_data.rs, `ListConstants` in src/renderer/frame/lists.rs.
#ifndef DRAW_GLSL
#define DRAW_GLSL

layout(set = 0, binding = 0, std140) uniform View {
    mat4 view_projection;
    vec4 eye;    // xyz: in world space
    vec4 light;  // xyz: towards the light, in world space, of length one
    // The view that factors and culling go by.
    mat4 measured_view_projection;
    vec4 measured_eye;
    vec4 viewport;  // its width and height in pixels, the least distance of what is seen, and what a length of one at a
                    // distance of one is of half the height
} view;

// Written out: glslang leaves `dot` to be made of fused operations even where its result is `precise`.
float exact_row(vec4 row, vec3 x) {
    precise float sum = ((row.w + row.z * x.z) + row.y * x.y) + row.x * x.x;
    return sum;
}

#ifdef MAKES_LISTS
// What is looked at, and how it is to be drawn.
layout(push_constant, std430) uniform Draw {
    vec4 transform[3];  // rows: object to world
    float factor;
    uint flags;
    uint first_corner;
    uint first_patch;
    uint count;                 // of the patches
    uint vertices;              // of a patch in a draw: the points of its corners, or the indices of a lattice
    uint first_index;           // of a lattice
    uint patches_per_instance;  // 0: an indexed draw with an instance for each
    uint copies;                // the word of the list where they start
} draw;

float draw_factor() {
    return draw.factor;
}
#else
layout(push_constant, std430) uniform Draw {
    vec4 transform[3];         // rows: object to world
    vec4 normal_transform[3];  // rows; w: see below
    vec4 colour;
    uint first_corner;
    uint first_patch;
    uint patches_per_instance;
    uint flags;
} draw;

float draw_factor() {
    return draw.normal_transform[0].w;
}

// What a texel of the displacement map is multiplied with, and what is added then, in object space.
float displacement_scale() {
    return draw.normal_transform[1].w;
}

float displacement_bias() {
    return draw.normal_transform[2].w;
}

vec3 normal_to_world(vec3 normal) {
    vec4 x = draw.normal_transform[0], y = draw.normal_transform[1], z = draw.normal_transform[2];
    return vec3(exact_row(vec4(x.xyz, 0.0), normal), exact_row(vec4(y.xyz, 0.0), normal), exact_row(vec4(z.xyz, 0.0), normal));
}
#endif

vec3 to_world(vec3 position) {
    // The same bits in every pipeline: patches of two kinds meet at their edges on the screen, too.
    return vec3(exact_row(draw.transform[0], position), exact_row(draw.transform[1], position),
                exact_row(draw.transform[2], position));
}

vec4 to_clip(vec3 world) {
    precise vec4 clip = view.view_projection * vec4(world, 1.0);
    return clip;
}

#endif
