// Patches that are refined: their leaves inside, on edges and at corners those of the owner. See leaves.glsl.
#ifndef ADAPTIVE_GLSL
#define ADAPTIVE_GLSL

#include "evaluate/leaves.glsl"

// Whether leaves make a point of an edge or a corner.
bool is_of_leaves(bvec4 on) {
    return ADAPTIVE && owner_of(edge_or_corner(on)) != OWNER_NONE;
}

// The patch as if it were not refined: the scheme's.
Surface evaluate_whole(vec3 at);

// The control points of a leaf: of a patch by leaves, those of the patch itself come from the control shader.
LeafPoints points_of(uint leaf, bool own) {
#if defined(HANDS_ON_LEAVES) && !defined(TRIANGLE)
    if (IS_BY_LEAVES && own) {
        LeafPoints of_leaf;
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) {
                of_leaf.points[i][j] = owned[i][j];
            }
            of_leaf.others[i] = owned[i][4];
        }
        return of_leaf;
    }
#endif
    return leaf_points(leaf);
}

// A patch that is refined: its leaves inside; on edges and at corners those of the owner, with its normal as `facing`. Where a
// neighbour is not refined, what both make of their corners.
Surface evaluate_leaves(vec3 at) {
    bvec4 on = edges_of(at);
    uint owner = 0u, of_normal = 0u, edge = 0u;
    Spot spot = own_spot(at);
    bool own = true;
    float back = 0.0;
    if (any(on)) {
        edge = edge_or_corner(on);
        owner = owner_of(edge);
        if (owner == OWNER_NONE) {
            return evaluate_whole(at);
        }
        of_normal = normal_owner_of(edge);
        back = way_back(on, at);
        own = is_own(owner, edge);
        spot = spot_of(owner, edge, at, back);
    }
    Spot of_leaf = in_leaf(spot);
    Surface surface = evaluate_leaf(leaf_four(LEAF_FOURS * of_leaf.root), points_of(of_leaf.root, own), of_leaf.at);
#ifdef DISPLACED
    surface.facing = unit_normal(surface.du, surface.dv, vec3(0.0));
#endif
    if (of_normal != owner) {
        Surface side = evaluate_spot(spot_of(of_normal, edge, at, back));
        surface.du = side.du;
        surface.dv = side.dv;
    }
    return surface;
}

Surface evaluate_surface(vec3 at) {
    return ADAPTIVE ? evaluate_leaves(at) : evaluate_whole(at);
}

#endif
