// Patches by leaves in the control shader: their control points, factors and hulls.
#ifndef LEAF_GLSL
#define LEAF_GLSL

#include "edges/culling.glsl"
#include "edges/factors.glsl"
#include "evaluate/leaves.glsl"
#ifdef DISPLACED
#include "displace/map_lod.glsl"
#include "edges/shared_texcoords.glsl"
#endif

// Where corner k of a patch is, in the patch's own parameters.
vec3 corner_place(uint k) {
#ifdef TRIANGLE
    return k == 0u ? vec3(1.0, 0.0, 0.0) : k == 1u ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
#else
    return k == 0u ? vec3(0.0) : k == 1u ? vec3(1.0, 0.0, 0.0) : k == 2u ? vec3(1.0, 1.0, 0.0) : vec3(0.0, 1.0, 0.0);
#endif
}

// What of the edge of a whole face the edge from corner k is: a power of two, the same from either side.
float edge_part(uint k) {
    uint piece = face_word(evaluated_patch, 1u);
    precise float part = exp2(-float(piece_level(piece)));
#ifdef TRIANGLE
    precise vec2 way = piece_corner(piece, k) - piece_corner(piece, k == 2u ? 0u : k + 1u);
    precise float of_leaf = part * max(abs(way.x), abs(way.y));
    return of_leaf;
#else
    return part;
#endif
}

// What the edge from corner k of the patch asks for, by its owner, so that both sides ask for the same.
float leaf_factor(uint patch_number, uint k) {
    evaluated_patch = draw.first_patch + patch_number;
    if (metric() == METRIC_UNIFORM) {
        precise float factor = item.factor * edge_part(k);
        return factor;
    }
    if (metric() == METRIC_EDGES) {
        return plus_factor(patch_number, k);
    }
    uint owner = owner_of(k), next = k + 1u == CORNERS ? 0u : k + 1u;
    Spot start = spot_of(owner, k, corner_place(k), 1.0), end = spot_of(owner, k, corner_place(next), 0.0);
    Surface from = evaluate_spot(start), to = evaluate_spot(end);
    // A third of the derivative along the edge. Seen from the other side, it has another sign, and the ends are swapped.
    precise vec2 along = (end.at - start.at) / 3.0;
    precise vec3 e0 = from.position + (along.x * from.du + along.y * from.dv);
    precise vec3 e1 = to.position - (along.x * to.du + along.y * to.dv);
    return edge_factor(from.position, e0, e1, to.position);
}

// Control points of the patch's leaf: those in row k, and of an end cap the other face point of corner k.
vec3[5] leaf_row(uint leaf, uint k) {
    uvec4 head = leaf_four(LEAF_FOURS * leaf), row = leaf_four(LEAF_FOURS * leaf + 1u + k);
    vec3 points[5];
    for (int j = 0; j < 4; ++j) {
        points[j] = vertex_position(row[j]);
    }
    points[4] = head.x == LEAF_CAP ? vertex_position(head.y + k) : points[0];
    return points;
}

// What the control points of the leaf say: the surface lies between them. Those of corner k are row k; of a triangle, the first corner
// has the last row, too.
Examined examine_leaf(uint patch_number) {
    uint leaf = face_word(draw.first_patch + patch_number, 0u);
    Examined examined = examine_points(leaf_row(leaf, uint(gl_InvocationID)));
#ifdef TRIANGLE
    if (gl_InvocationID == 0) {
        Examined last = examine_points(leaf_row(leaf, 3u));
        examined.outside &= last.outside;
        examined.pixel_box = vec4(min(examined.pixel_box.xy, last.pixel_box.xy), max(examined.pixel_box.zw, last.pixel_box.zw));
    }
#endif
    return examined;
}

// What corner k hands on.
vec3[5] leaf_corner(uint patch_number, uint k) {
#ifdef TRIANGLE
    return vec3[5](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
#else
    return leaf_row(face_word(draw.first_patch + patch_number, 0u), k);
#endif
}

#ifdef DISPLACED
// The level of the displacement map at corner k of the patch: see `corner_lod`.
float leaf_corner_lod(uint corner, uint patch_number, uint k) {
    evaluated_patch = draw.first_patch + patch_number;
    uint owner = owner_of(4u + k);
    precise float factor = item.factor * exp2(-float(piece_level(face_word(owner >> OWNER_SHIFT, 1u))));
    if (metric() == METRIC_PIXELS || metric() == METRIC_CURVATURE) {
        Surface at = evaluate_spot(spot_of(owner, 4u + k, corner_place(k), 0.0));
        precise vec3 a = at.du / 3.0, b = at.dv / 3.0;
        factor = vertex_factor(at.position, a, b);
    }
    return map_lod(shared_texcoord_of(corner).scale.x, clamp(factor, 1.0, MAX_FACTOR));
}
#endif

#endif
