// The cached construction, once a frame: limit point, tangent frame and normal of every ring. One invocation for each.
#version 460
#extension GL_GOOGLE_include_directive : require
#define MAKES_FRAMES
#include "framed_ring.glsl"
#include "invocation.glsl"
#include "kept_frames.glsl"

void main() {
    uint index = invocation_number();
    if (index >= invocations.count) {
        return;
    }
    FramedRing ring = framed_ring(index);
    keep_frame_vector(index, LIMIT, ring.p);
    keep_frame_vector(index, TANGENT_A, ring.a);
    keep_frame_vector(index, TANGENT_B, ring.b);
    keep_frame_vector(index, NORMAL, ring_normal(ring));
}
