// A Gregory quad. Rust twin: `evaluate_gregory_quad` in src/patch/gregory.rs.
// Of the control points `owned[corner][number]` of whatever stage includes it.
#ifndef EVALUATE_GREGORY_QUAD_GLSL
#define EVALUATE_GREGORY_QUAD_GLSL

#include "evaluate/patch.glsl"

Surface evaluate_gregory_quad(float u, float v) {
    precise float s = 1.0 - u;
    precise float t = 1.0 - v;
#define CORNER(k, x, y) TensorCorner(owned[k][0], owned[k][1], owned[k][2], blend(owned[k][3], x, owned[k][4], y))
    return evaluate_tensor(CORNER(0, u, v), CORNER(1, v, s), CORNER(2, s, t), CORNER(3, t, u), u, v);
#undef CORNER
}

#include "evaluate/leaves.glsl"

// A face that is refined: its leaves inside; on edges and at corners those of the owner, with its normal as `facing`. Where a
// neighbour is not refined, what both make of their corners.
Surface evaluate_leaves(vec3 at) {
    bvec4 on = bvec4(at.y == 0.0, at.x == 1.0, at.y == 1.0, at.x == 0.0);
    uint owner = evaluated_patch << OWNER_SHIFT, of_normal = owner;
    vec2 place = at.xy;
    float back = 0.0;
    uint edge = 0u;
    if (any(on)) {
        edge = edge_or_corner(on);
        owner = owner_of(edge);
        if (owner == OWNER_NONE) {
            return evaluate_gregory_quad(at.x, at.y);
        }
        of_normal = normal_owner_of(edge);
        precise float left = 1.0 - at.x, up = 1.0 - at.y;
        back = on.x ? left : on.y ? up : on.z ? at.x : at.y;
        place = place_of(owner, edge, at.xy, back);
    }
    Surface surface = evaluate_face(owner >> OWNER_SHIFT, place);
#ifdef DISPLACED
    surface.facing = unit_normal(surface.du, surface.dv, vec3(0.0));
#endif
    if (of_normal != owner) {
        Surface side = evaluate_face(of_normal >> OWNER_SHIFT, place_of(of_normal, edge, at.xy, back));
        surface.du = side.du;
        surface.dv = side.dv;
    }
    return surface;
}

Surface evaluate_surface(vec3 at) {
    return ADAPTIVE ? evaluate_leaves(at) : evaluate_gregory_quad(at.x, at.y);
}

#endif
