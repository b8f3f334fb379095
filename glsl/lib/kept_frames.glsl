// Where the cached construction keeps what glsl/compute/frames.comp makes of each ring. Rust twin: `FRAME_FLOATS` in
// src/renderer/tables.rs.
#ifndef KEPT_FRAMES_GLSL
#define KEPT_FRAMES_GLSL

#ifdef MAKES_FRAMES
#define FRAMES_ACCESS writeonly
#else
#define FRAMES_ACCESS readonly
#endif
// The binding of the stencil table, which the cached construction does without.
layout(set = 1, binding = 5, std430) FRAMES_ACCESS buffer Frames { float frames[]; };

const uint FRAME_FLOATS = 12u;

// What there is of a ring: its limit point, the vectors of its tangent frame and its normal.
const uint LIMIT = 0u;
const uint TANGENT_A = 1u;
const uint TANGENT_B = 2u;
const uint NORMAL = 3u;

uint kept_frame(uint ring, uint number) {
    return FRAME_FLOATS * ring + 3u * number;
}

#ifdef MAKES_FRAMES
void keep_frame_vector(uint ring, uint number, vec3 x) {
    uint at = kept_frame(ring, number);
    frames[at] = x.x;
    frames[at + 1u] = x.y;
    frames[at + 2u] = x.z;
}
#else
vec3 kept_frame_vector(uint ring, uint number) {
    uint at = kept_frame(ring, number);
    return vec3(frames[at], frames[at + 1u], frames[at + 2u]);
}
#endif

#endif
