// What culling looks at of faces that are refined, in the place of control points: leaves may reach beyond these. The surface lies
// between the vertices around the face, or the control points of its leaves, but for end caps, which lie between their own. Rust twin: src/table/hulls.rs.
#ifndef HULLS_GLSL
#define HULLS_GLSL

#include "draw/patches.glsl"
#include "draw/positions.glsl"
#include "draw/tables.glsl"
#include "edges/culling.glsl"

// What the hull of a patch says, by the number of the patch among all: of its entries every `step`-th from `first` on.
Examined examine_hull(uint patch_number, uint first, uint step) {
    Extents extents = no_extents();
    if ((DRAW_FLAGS & (CULL_FRUSTUM_FLAG | CULL_SMALL_FLAG)) == 0u) {
        return Examined(0u, extents.box, false);
    }
    uint start = tables.hulls + table_words[tables.faces + FACE_WORDS * patch_number + FACE_HULL];
    uint count = table_words[start];
    for (uint i = first; i < count; i += step) {
        uint entry = table_words[start + 1u + i], vertex = entry & ~HULL_CAP_BIT;
        uint end = vertex + (entry == vertex ? 1u : CAP_VERTICES);
        for (; vertex < end; ++vertex) {
            include_point(extents, vertex_position(vertex));
        }
    }
    return examined_points(extents);
}

#endif
