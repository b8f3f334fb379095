// Where the displacement is looked up along an edge and at a corner. Rust twin: src/table/shared.rs.
#ifndef SHARED_LOOKUP_GLSL
#define SHARED_LOOKUP_GLSL

#include "displace.glsl"
#include "factors.glsl"
#include "framed_ring.glsl"

// Texture coordinates at a corner: on its plus edge, on its minus edge, at the corner itself; and x: the mean length of an
// edge there. Rust twin: `SharedTexcoord` in src/table/shared.rs.
struct SharedTexcoord { vec2 plus, minus, corner, scale; };
layout(set = 1, binding = 10, std430) readonly buffer SharedTexcoords { SharedTexcoord shared_texcoords[]; };

// The level at which an edge at a corner has as many texels as segments; `speaker` is the ring that speaks for the corner.
float corner_lod(uint corner, FramedRing speaker) {
    vec2 size = vec2(textureSize(displacement_map, 0));
    precise float texels =
        shared_texcoords[corner].scale.x * max(size.x, size.y) / vertex_factor(speaker.p, speaker.a, speaker.b);
    return max(log2(texels), 0.0);
}

#endif
