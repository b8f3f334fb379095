// The cached construction, once a frame: limit point, tangent frame and normal of every ring. One invocation for each.
#version 460
#extension GL_GOOGLE_include_directive : require
#define MAKES_FRAMES
#include "construct/framed_ring.glsl"
#include "draw/invocation.glsl"
#include "construct/kept_frames.glsl"

void main() {
    uint index = invocation_number();
    if (index >= invocations.count) {
        return;
    }
    FramedRing ring = framed_ring(index);
    keep_frame(index, KeptFrame(ring.p, ring.a, ring.b, ring_normal(ring)));
}
