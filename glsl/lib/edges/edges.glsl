// What both patches at an edge evaluate alike, from data of the edge alone. Rust twins: src/patch/edge.rs,
// src/tessellator/edges.rs.
#ifndef EDGES_GLSL
#define EDGES_GLSL

#include "evaluate/patch.glsl"
#include "edges/shared_bits.glsl"
#ifdef MAY_BE_ADAPTIVE
#include "evaluate/adaptive.glsl"
#endif

// Across an edge at `t` from its start, by what its ends see across it and their transversals: the same from either end, but for
// its sign. With the derivative along the edge it makes the normal of both patches. Rust twin: `edge_across`.
vec3 edge_across(vec3 across0, vec3 transversal0, vec3 transversal1, vec3 across1, float t) {
    precise float s = 1.0 - t;
    precise float ss = s * s;
    precise float tt = t * t;
#ifdef FAULT_ONE_WAY
    precise vec3 across = ((across0 * (ss * s) + transversal0 * (3.0 * ss * t)) - transversal1 * (3.0 * tt * s))
        - across1 * (tt * t);
#else
    precise vec3 across = (across0 * (ss * s) - across1 * (tt * t))
        + (transversal0 * (3.0 * ss * t) - transversal1 * (3.0 * tt * s));
#endif
    return across;
}

#ifdef SHARED
// What the corners of the patch share with others: see glsl/lib/edges/shared.glsl.
vec3 shared_with[CORNERS][SHARED_VECTORS];
uint shared_bits[CORNERS];
#ifdef DISPLACED
vec2 shared_texcoord[CORNERS][3];
float shared_lod[CORNERS];
#endif

// A point of the surface. Where it is displaced it goes along `direction`, which is that of all patches that meet there;
// `normal` is, too, but at creases.
struct SharedSample {
    vec3 position;
    vec3 normal;
#ifdef DISPLACED
    vec3 direction;
    vec2 texcoord;  // where the displacement is looked up
    float lod;
#endif
};

// The surface with what is shared in the place of what the patch alone makes of it. Positions on edges are the same in any
// case. Rust twin: `share`. Displaced, of the `texcoord` of the patch's corners in whatever stage includes it, too.
SharedSample share(Surface own, vec3 at) {
    // On which edge, and how far from its corner on the way around the patch.
    bvec4 on = edges_of(at);
#ifdef TRIANGLE
    float way = on.x ? at.y : on.y ? at.z : at.x;
#define PICK(of) (on.x ? of(0, 1) : on.y ? of(1, 2) : of(2, 0))
#else
    precise float left = 1.0 - at.x;
    precise float up = 1.0 - at.y;
    float way = on.x ? at.x : on.y ? at.y : on.z ? left : up;
#define PICK(of) (on.x ? of(0, 1) : on.y ? of(1, 2) : on.z ? of(2, 3) : of(3, 0))
#endif
#define ACROSS0(k, n) shared_with[k][0]
#define TRANSVERSAL0(k, n) shared_with[k][1]
#define ACROSS1(k, n) shared_with[n][2]
#define TRANSVERSAL1(k, n) shared_with[n][3]
#define NORMAL0(k, n) shared_with[k][4]
#define NORMAL1(k, n) shared_with[n][4]
#define DIRECTION0(k, n) shared_with[k][SHARED_VECTORS - 1]
#define DIRECTION1(k, n) shared_with[n][SHARED_VECTORS - 1]
#define SHARP(k, n) (shared_bits[k] & SHARP_EDGE_BIT) != 0u
#define START(k, n) owned[k][0]
#define AFTER(k, n) owned[k][1]
#define BEFORE(k, n) owned[n][2]
#define END(k, n) owned[n][0]
#define TEXCOORD0(k, n) shared_texcoord[k][0]
#define TEXCOORD1(k, n) shared_texcoord[n][1]
#define CORNER_TEXCOORD0(k, n) shared_texcoord[k][2]
#define CORNER_TEXCOORD1(k, n) shared_texcoord[n][2]
#define LOD0(k, n) shared_lod[k]
#define LOD1(k, n) shared_lod[n]
    SharedSample surface;
    surface.position = own.position;
#ifdef DISPLACED
    surface.direction = sample_of(own).normal;
    precise vec2 inside = INTERPOLATED(texcoord, at);
    precise float lod_inside = INTERPOLATED(shared_lod, at);
    surface.texcoord = inside;
    surface.lod = lod_inside;
#endif
    if (any(on)) {
        vec3 across = edge_across(PICK(ACROSS0), PICK(TRANSVERSAL0), PICK(TRANSVERSAL1), PICK(ACROSS1), way);
#ifdef TRIANGLE
        vec3 along = curve_slope(curve_basis(way), PICK(START), PICK(AFTER), PICK(BEFORE), PICK(END));
#else
        vec3 along = on.x ? own.du : on.y ? own.dv : on.z ? -own.du : -own.dv;
#endif
        // A sum of two is the same both ways.
        precise vec3 facing = PICK(DIRECTION0) + PICK(DIRECTION1);
#ifdef MAY_BE_ADAPTIVE
        bool of_leaves = is_of_leaves(on);
#else
        const bool of_leaves = false;
#endif
#ifdef DISPLACED
        surface.direction = own.facing;
#endif
#ifndef FAULT_OWN_NORMAL
        if (!of_leaves) {
#ifdef DISPLACED
            vec3 of_edge = unit_normal(along, across, facing);
            surface.direction = way == 0.0 ? PICK(DIRECTION0) : way == 1.0 ? PICK(DIRECTION1) : of_edge;
#endif
            if (way == 0.0) {
                own = Surface(own.position, vec3(0.0), vec3(0.0), PICK(NORMAL0));
            } else if (way == 1.0) {
                own = Surface(own.position, vec3(0.0), vec3(0.0), PICK(NORMAL1));
            } else if (!(PICK(SHARP))) {
                own = Surface(own.position, along, across, facing);
            }
        }
#endif
#ifdef DISPLACED
        precise float s = 1.0 - way;
        precise vec2 on_edge = s * PICK(TEXCOORD0) + way * PICK(TEXCOORD1);
        precise float lod = s * PICK(LOD0) + way * PICK(LOD1);
        surface.texcoord = way == 0.0 ? PICK(CORNER_TEXCOORD0) : way == 1.0 ? PICK(CORNER_TEXCOORD1) : on_edge;
        surface.lod = lod;
#endif
    }
    surface.normal = sample_of(own).normal;
    return surface;
}
#endif

#endif
