// Control points out of tables, with nothing for a vertex shader to do. The stencil construction: each is a weighted sum of the
// vertices around the patch, with the weights of its type of connectivity (Loop et al. 2009, section 4). The cached construction:
// they are there (glsl/compute/control_points.comp).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw/construction.glsl"
#define KEPT_FRAMES IS_CACHED
#ifdef MAY_BE_ADAPTIVE
#define READS_LEAVES
#endif
#include "construct/control.glsl"
#include "construct/stencils.glsl"
#ifdef SHARED
#include "edges/shared.glsl"
#include "edges/write_shared.glsl"
#endif
#include "construct/cached.glsl"
#ifdef DISPLACED
#include "displace/corner_lod.glsl"
#endif

layout(location = 0) in uint in_patch_number[];

// Within the draw, or its instance.
uint patch_number;

#ifdef SHARED
float level_of_map(uint corner, FramedRing own) {
#ifdef DISPLACED
    return corner_lod(corner, corner_owner(corner, own));
#else
    return 0.0;
#endif
}
#endif

// What the corner owns and shares, by stencils.
void sum_corner(uint corner) {
    stencil_points(draw.first_patch + patch_number, uint(gl_InvocationID), CORNERS, own);
#ifdef SHARED
    uvec2 place = patch_corner(corner);
    FramedRing ring = framed_ring(place.x), owner = ring;
#ifdef DISPLACED
    owner = corner_owner(corner, ring);
#endif
    SharedEdge plus = shared_edge(ring, place.y), minus = shared_edge(ring, edge_after(ring.ring, place.y));
    write_shared(corner, share_corner(corner, ring, owner, plus, minus), corner_sharp(corner), level_of_map(corner, ring));
#endif
}

// Likewise, as it was kept.
void read_corner(uint corner) {
    vec4 texels[KEPT_TEXELS] = kept_texels(corner);
    for (int i = 0; i < OWNED; ++i) {
        own[i] = kept_vector(texels, i);
    }
#ifdef SHARED
    vec3 with[SHARED_VECTORS];
    for (int i = 0; i < SHARED_VECTORS; ++i) {
        with[i] = kept_vector(texels, OWNED + i);
    }
    float lod = 0.0;
#ifdef DISPLACED
    lod = level_of_map(corner, framed_ring(patch_corner(corner).x));
#endif
    write_shared(corner, with, kept_number(texels, KEPT - 1), lod);
#endif
}

#ifdef READS_LEAVES
// What it has of its leaf: along its edges patches by leaves share what their owners make.
void look_up_corner(uint corner) {
    own = leaf_corner(patch_number, uint(gl_InvocationID));
#ifdef SHARED
    vec3 with[SHARED_VECTORS];
    for (int i = 0; i < SHARED_VECTORS; ++i) {
        with[i] = vec3(0.0);
    }
    float lod = 0.0;
#ifdef DISPLACED
    lod = leaf_corner_lod(corner, patch_number, uint(gl_InvocationID));
#endif
    write_shared(corner, with, 0.0, lod);
#endif
}
#endif

void main() {
    patch_number = take_instance(in_patch_number[0]);
    uint corner = draw.first_corner + patch_number * CORNERS + uint(gl_InvocationID);
#ifdef READS_LEAVES
    if (IS_BY_LEAVES) {
        look_up_corner(corner);
    } else
#endif
    if (IS_CACHED) {
        read_corner(corner);
    } else {
        sum_corner(corner);
    }
    finish_corner(patch_number);
    barrier();
    finish_patch(patch_number);
}
