// Where the cached construction keeps what glsl/compute/frames.comp makes of each ring: three vectors, and the fourth in what the
// others leave. Rust twin: `FRAME_BYTES` in src/table/model.rs.
#ifndef KEPT_FRAMES_GLSL
#define KEPT_FRAMES_GLSL

#include "constants.glsl"
#include "draw/positions.glsl"

struct KeptFrame {
    vec3 p, a, b, normal;
};

#ifdef MAKES_FRAMES
layout(set = 1, binding = BINDING_FRAMES, std430) writeonly buffer Frames { vec4 frames[]; };

void keep_frame(uint ring, KeptFrame frame) {
    frames[3u * ring] = vec4(frame.p, frame.normal.x);
    frames[3u * ring + 1u] = vec4(frame.a, frame.normal.y);
    frames[3u * ring + 2u] = vec4(frame.b, frame.normal.z);
}
#else
layout(set = 1, binding = BINDING_FRAMES, std430) readonly buffer Frames { vec4 frames[]; };
layout(set = 1, binding = BINDING_FRAME_TEXELS) uniform samplerBuffer frame_texels;

vec4 frame_vector(uint i) {
    return READS_TEXELS ? texelFetch(frame_texels, int(i)) : frames[i];
}

KeptFrame kept_frame(uint ring) {
    vec4 p = frame_vector(3u * ring), a = frame_vector(3u * ring + 1u), b = frame_vector(3u * ring + 2u);
    return KeptFrame(p.xyz, a.xyz, b.xyz, vec3(p.w, a.w, b.w));
}
#endif

#endif
