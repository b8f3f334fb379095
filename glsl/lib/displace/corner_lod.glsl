// The level of the displacement map for a corner of a patch. Rust twin: `corner_lod` in src/tessellator/factors.rs.
#ifndef CORNER_LOD_GLSL
#define CORNER_LOD_GLSL

#include "edges/factors.glsl"
#include "construct/framed_ring.glsl"
#include "displace/map_lod.glsl"
#include "edges/shared_texcoords.glsl"

// At which an edge at the corner has as many texels as segments; `owner` is the ring that owns the corner.
float corner_lod(uint corner, FramedRing owner) {
    return map_lod(shared_texcoord_of(corner).scale.x, vertex_factor(owner.p, owner.a, owner.b));
}

#endif
