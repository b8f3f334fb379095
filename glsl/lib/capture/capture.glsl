// Writing what one stage computed into a buffer, for tests, `subdiv patches` and `subdiv sample`.
// Rust twin: src/capture/draws.rs.
#ifndef CAPTURE_GLSL
#define CAPTURE_GLSL

#include "constants.glsl"

#ifndef CAPTURE_BINDING
#define CAPTURE_BINDING 0
#endif

layout(set = 2, binding = CAPTURE_BINDING, std430) buffer Capture {
    uint capture_first_patch;  // patches before this one are not captured
    uint capture_patches;      // nor those from first + patches on
    uint capture_grid;         // samples along a side of a patch, or 0: every evaluated vertex as it comes, or EDGES_ONLY
    uint capture_capacity;     // records that fit
    uint capture_count;        // records written when capture_grid is 0
    float captured[];
};


void put(uint at, vec3 x) {
    captured[at] = x.x;
    captured[at + 1u] = x.y;
    captured[at + 2u] = x.z;
}

// A control point of a patch, by its number when the corners' own are counted corner by corner.
void capture_point(uint patch_index, uint number, vec3 x) {
    uint slot = patch_index - capture_first_patch;
    if (slot < capture_patches) {
        put(slot * (CONTROL_POINT_WORDS + FACTOR_WORDS) + 3u * number, x);
    }
}

// The factors that its edges ask for, in order from the first corner's plus edge; its inner factors; whether it is culled.
void capture_factors(uint patch_index, vec4 asked, vec2 inner, bool culled) {
    uint slot = patch_index - capture_first_patch;
    if (slot < capture_patches) {
        uint at = slot * (CONTROL_POINT_WORDS + FACTOR_WORDS) + CONTROL_POINT_WORDS;
        put(at, asked.xyz);
        put(at + 3u, vec3(asked.w, inner));
        captured[at + 6u] = culled ? 1.0 : 0.0;
    }
}

void put_record(uint record, uint patch_index, vec3 coordinate, vec3 position, vec3 normal) {
    uint at = record * RECORD_WORDS;
    put(at, coordinate);
    captured[at + 3u] = uintBitsToFloat(patch_index);
    put(at + 4u, position);
    put(at + 7u, normal);
}

// A vertex of a patch. With a grid, `place` is its number in the patch and `places` how many the patch has.
void capture_sample(uint patch_index, uint place, uint places, vec3 coordinate, vec3 position, vec3 normal) {
    uint slot = patch_index - capture_first_patch;
    if (slot >= capture_patches) {
        return;
    }
#ifdef TRIANGLE
    bool on_edge = any(equal(coordinate, vec3(0.0)));
#else
    bool on_edge = any(equal(coordinate.xy, vec2(0.0))) || any(equal(coordinate.xy, vec2(1.0)));
#endif
    if (capture_grid == EDGES_ONLY && !on_edge) {
        return;
    }
    uint record = capture_grid > 0u && capture_grid != EDGES_ONLY ? slot * places + place : atomicAdd(capture_count, 1u);
    if (record < capture_capacity) {
        put_record(record, patch_index, coordinate, position, normal);
    }
}

#endif
