// Writing what one stage computed into a buffer, for tests, `subdiv patches` and `subdiv sample`.
// Rust twin: src/capture.rs.
#ifndef CAPTURE_GLSL
#define CAPTURE_GLSL

layout(set = 2, binding = 0, std430) buffer Capture {
    uint capture_first_patch;  // patches before this one are not captured
    uint capture_patches;      // nor those from first + patches on
    uint capture_grid;         // samples along a side of a patch, or 0: every evaluated vertex as it comes
    uint capture_capacity;     // records that fit
    uint capture_count;        // records written when capture_grid is 0
    float captured[];
};

const uint CONTROL_POINT_WORDS = 96u;
const uint RECORD_WORDS = 10u;

void put(uint at, vec3 x) {
    captured[at] = x.x;
    captured[at + 1u] = x.y;
    captured[at + 2u] = x.z;
}

// A control point of a patch, by its number when the corners' own are counted corner by corner.
void capture_point(uint patch_index, uint number, vec3 x) {
    uint slot = patch_index - capture_first_patch;
    if (slot < capture_patches) {
        put(slot * CONTROL_POINT_WORDS + 3u * number, x);
    }
}

// A vertex of a patch. With a grid, `place` is its number in the patch and `places` how many the patch has.
void capture_sample(uint patch_index, uint place, uint places, vec3 coordinate, vec3 position, vec3 normal) {
    uint slot = patch_index - capture_first_patch;
    if (slot >= capture_patches) {
        return;
    }
    uint record = capture_grid > 0u ? slot * places + place : atomicAdd(capture_count, 1u);
    if (record < capture_capacity) {
        uint at = record * RECORD_WORDS;
        put(at, coordinate);
        captured[at + 3u] = uintBitsToFloat(patch_index);
        put(at + 4u, position);
        put(at + 7u, normal);
    }
}

#endif
