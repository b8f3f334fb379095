// What every shader of a draw knows: the view, the item, and where its patches are.
// Rust twins: `ViewData`, `ItemRecord` and `DrawConstants` in src/renderer/shader/gpu_data.rs, `ListConstants` in
// src/renderer/frame/lists.rs.
#ifndef DRAW_GLSL
#define DRAW_GLSL

#include "constants.glsl"

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

// The item that is drawn, whatever its patches: its place in a buffer of the in-flight frame is a dynamic offset.
layout(set = 0, binding = 2, std140) uniform Item {
    vec4 transform[3];         // rows: object to world
    vec4 normal_transform[3];  // rows: its cofactors; w is zero
    vec4 colours[4];           // by kind of patch: regular quads, irregular quads, triangles, pentagons
    uvec4 words;               // the caller's: `DrawItem::words`
    float factor;              // tessellation factor, or what its rule multiplies with
    // A texel of the displacement map is multiplied with the scale, then the bias is added: in object space.
    float displacement_scale;
    float displacement_bias;
    float displacement_reach;  // the longest way that a point is displaced
    uint segments;             // of the uniform grid, if patches are drawn on one
} item;

// What changes from draw to draw of an item. There is room for 112 bytes more.
layout(push_constant, std430) uniform Draw {
    uint first_corner;
    uint first_patch;
    uint patches_per_instance;  // of a list 0: an indexed draw with an instance for each
    uint flags;
#ifdef MAKES_LISTS
    uint count;        // of the patches
    uint vertices;     // of a patch in a draw: the points of its corners, or the indices of a uniform grid
    uint first_index;  // of a uniform grid
    uint copies;       // the word of the list where they start
#endif
} draw;

// The colour of the patches that are drawn.
vec4 draw_colour() {
    return item.colours[draw.flags >> KIND_SHIFT & KIND_MASK];
}

vec3 normal_to_world(vec3 normal) {
    return vec3(exact_row(item.normal_transform[0], normal), exact_row(item.normal_transform[1], normal),
                exact_row(item.normal_transform[2], normal));
}

vec3 to_world(vec3 position) {
    // The same bits in every pipeline: patches of two kinds meet at their edges on the screen, too.
    return vec3(exact_row(item.transform[0], position), exact_row(item.transform[1], position),
                exact_row(item.transform[2], position));
}

vec4 to_clip(vec3 world) {
    precise vec4 clip = view.view_projection * vec4(world, 1.0);
    return clip;
}

#endif
