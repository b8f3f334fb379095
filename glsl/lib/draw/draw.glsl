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

// What changes from draw to draw of an item. There is room for 100 bytes more.
layout(push_constant, std430) uniform Draw {
    uint first_corner;
    uint first_patch;
    uint patches_per_instance;  // of a list 0: an indexed draw with an instance for each
    uint flags;
    // Of a draw of instances: the patches of each (or tiles of them), the word where the first instance starts, and words from one to
    // the next.
    uint patches;
    uint first_word;
    uint instance_stride;
#ifdef MAKES_LISTS
    uint count;        // of the patches
    uint vertices;     // of a patch in a draw: the points of its corners, or the indices of a uniform grid
    uint first_index;  // of a uniform grid
    uint copies;       // the word of the list where they start
#endif
} draw;

// Whether a draw is of instances of its item, each with a transform, a colour and words in place of the item's. Set in
// src/renderer/pipelines/draw.rs.
layout(constant_id = ID_INSTANCES) const bool INSTANCES = false;

// Rust twin: `Instance` in src/renderer/options/instances.rs.
layout(set = 0, binding = 3, std430) readonly buffer Instances { uint instance_words[]; };

// The number within the draw of the instance that an invocation is about. Fragment shaders of yours define FRAGMENT_STAGE to have it;
// other stages set it first.
#ifdef FRAGMENT_STAGE
layout(location = LOCATION_INSTANCE) flat in uint instance_number;
#else
uint instance_number;

// Has an invocation be about an instance: of what a draw counts through all instances, the number within its own.
uint take_instance(uint number) {
    if (!INSTANCES) {
        return number;
    }
    instance_number = number / draw.patches;
    return number % draw.patches;
}
#endif

uvec4 instance_four(uint i) {
    uint word = draw.first_word + instance_number * draw.instance_stride + 4u * i;
    return uvec4(instance_words[word], instance_words[word + 1u], instance_words[word + 2u], instance_words[word + 3u]);
}

// A row of the matrix from object to world.
vec4 transform_row(uint i) {
    return INSTANCES ? uintBitsToFloat(instance_four(i)) : item.transform[i];
}

// The caller's words: `DrawItem::words`, or those of the instance.
uvec4 draw_words() {
    return INSTANCES ? instance_four(4u) : item.words;
}

// The colour of the patches that are drawn.
vec4 draw_colour() {
    if (INSTANCES) {
        return uintBitsToFloat(instance_four(3u));
    }
    return item.colours[draw.flags >> KIND_SHIFT & KIND_MASK];
}

// A row of the cofactors of that matrix, as the host has them (`ItemRecord::new`).
vec4 normal_row(uint i) {
    if (!INSTANCES) {
        return item.normal_transform[i];
    }
    vec3 a = transform_row((i + 1u) % 3u).xyz, b = transform_row((i + 2u) % 3u).xyz;
    precise vec3 left = a.yzx * b.zxy, right = b.yzx * a.zxy;
    precise vec3 cofactors = left - right;
    return vec4(cofactors, 0.0);
}

vec3 normal_to_world(vec3 normal) {
    return vec3(exact_row(normal_row(0u), normal), exact_row(normal_row(1u), normal), exact_row(normal_row(2u), normal));
}

vec3 to_world(vec3 position) {
    // The same bits in every pipeline: patches of two kinds meet at their edges on the screen, too.
    return vec3(exact_row(transform_row(0u), position), exact_row(transform_row(1u), position),
                exact_row(transform_row(2u), position));
}

vec4 to_clip(vec3 world) {
    precise vec4 clip = view.view_projection * vec4(world, 1.0);
    return clip;
}

#endif
