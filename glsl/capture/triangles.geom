// Writes down the triangles that the tessellator made, three vertices each. Rust twin: `Captured::triangles` in
// src/capture/mod.rs.
#version 460
#extension GL_GOOGLE_include_directive : require
// The evaluation shader has a buffer of its own.
#define CAPTURE_BINDING 1
#include "capture/capture.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

layout(location = 0) in vec3 world_position[];
layout(location = 1) in vec3 world_normal[];
layout(location = 6) in vec3 coordinate[];
layout(location = 7) in uint patch_index[];

void main() {
    if (patch_index[0] - capture_first_patch >= capture_patches) {
        return;
    }
    uint first = atomicAdd(capture_count, 3u);
    if (first + 3u <= capture_capacity) {
        for (uint k = 0u; k < 3u; ++k) {
            put_record(first + k, patch_index[k], coordinate[k], world_position[k], world_normal[k]);
        }
    }
}
