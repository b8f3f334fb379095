// The level of the displacement map for a corner of a patch.
#ifndef CORNER_LOD_GLSL
#define CORNER_LOD_GLSL

#include "displacement_map.glsl"
#include "factors.glsl"
#include "framed_ring.glsl"
#include "shared_texcoords.glsl"

// At which an edge at the corner has as many texels as segments; `speaker` is the ring that speaks for the corner.
float corner_lod(uint corner, FramedRing speaker) {
    precise float texels =
        shared_texcoords[corner].scale.x * displacement_texels() / vertex_factor(speaker.p, speaker.a, speaker.b);
    return max(log2(texels), 0.0);
}

#endif
