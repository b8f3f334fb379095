// What both patches at an edge evaluate alike, from data of the edge alone. Rust twins: src/patch/edge.rs.
#ifndef EDGES_GLSL
#define EDGES_GLSL

#include "patch.glsl"
#include "shared_bits.glsl"

struct Edge {
    vec3 p0, e0, e1, p1;        // its curve
    vec3 across0, across1;      // across it at either end, as the vertex there sees it
    vec3 transversal0, transversal1;
};

vec3 edge_position(Edge edge, float t) {
    return symmetric_sum(cubic_basis(t).value, edge.p0, edge.e0, edge.e1, edge.p1);
}

vec3 edge_normal(Edge edge, float t, vec3 fallback) {
    precise float s = 1.0 - t;
    precise float ss = s * s;
    precise float st = 2.0 * (s * t);
    precise float tt = t * t;
    precise vec3 along = (edge.e0 - edge.p0) * ss + (edge.e1 - edge.e0) * st + (edge.p1 - edge.e1) * tt;
    precise vec3 across = (edge.across0 * (ss * s) - edge.across1 * (tt * t))
        + (edge.transversal0 * (3.0 * ss * t) - edge.transversal1 * (3.0 * tt * s));
    return unit_normal(along, across, fallback);
}

#ifdef SHARED
// What the corners of the patch share with others: see glsl/lib/shared.glsl.
layout(location = 16) in vec3 shared_with[][SHARED_VECTORS];
layout(location = 22) in uint shared_bits[];
#ifdef DISPLACED
layout(location = 23) in vec2 shared_texcoord[][3];
layout(location = 26) in float shared_lod[];
#endif

// A point of the surface. Where it is displaced it goes along `direction`, which is that of all patches that meet there;
// `normal` is, too, but at creases.
struct SharedSample {
    vec3 position;
    vec3 normal;
    vec3 direction;
#ifdef DISPLACED
    vec2 texcoord;  // where the displacement is looked up
    float lod;
#endif
};

// Puts what is shared in the place of what the patch alone makes of it.
SharedSample share(Sample own, vec3 at) {
#ifdef DISPLACED
    SharedSample surface =
        SharedSample(own.position, own.normal, own.normal, INTERPOLATED(texcoord, at), INTERPOLATED(shared_lod, at));
#else
    SharedSample surface = SharedSample(own.position, own.normal, own.normal);
#endif
    // On which edge, and how far from its corner on the way around the patch.
#ifdef TRIANGLE
    bvec4 on = bvec4(at.z == 0.0, at.x == 0.0, at.y == 0.0, false);
    float way = on.x ? at.y : on.y ? at.z : at.x;
#define PICK(of) (on.x ? of(0, 1) : on.y ? of(1, 2) : of(2, 0))
#else
    bvec4 on = bvec4(at.y == 0.0, at.x == 1.0, at.y == 1.0, at.x == 0.0);
    precise float left = 1.0 - at.x;
    precise float up = 1.0 - at.y;
    float way = on.x ? at.x : on.y ? at.y : on.z ? left : up;
#define PICK(of) (on.x ? of(0, 1) : on.y ? of(1, 2) : on.z ? of(2, 3) : of(3, 0))
#endif
    if (!any(on)) {
        return surface;
    }
#define P0(k, n) owned[k][0]
#define E0(k, n) CONTROL_POINT(k, 1)
#define E1(k, n) CONTROL_POINT(n, 2)
#define P1(k, n) owned[n][0]
#define ACROSS0(k, n) shared_with[k][0]
#define TRANSVERSAL0(k, n) shared_with[k][1]
#define ACROSS1(k, n) shared_with[n][2]
#define TRANSVERSAL1(k, n) shared_with[n][3]
#define NORMAL0(k, n) shared_with[k][4]
#define NORMAL1(k, n) shared_with[n][4]
#define DIRECTION0(k, n) shared_with[k][SHARED_VECTORS - 1]
#define DIRECTION1(k, n) shared_with[n][SHARED_VECTORS - 1]
#define BITS(k, n) shared_bits[k]
    Edge edge = Edge(PICK(P0), PICK(E0), PICK(E1), PICK(P1), PICK(ACROSS0), PICK(ACROSS1), PICK(TRANSVERSAL0),
                     PICK(TRANSVERSAL1));
    vec3 direction0 = PICK(DIRECTION0), direction1 = PICK(DIRECTION1);
    uint bits = PICK(BITS);
    // From the lower vertex to the higher.
#ifdef FAULT_OWN_ORDER
    bool reversed = false;
#else
    bool reversed = (bits & REVERSED_BIT) != 0u;
#endif
    precise float back = 1.0 - way;
    float t = reversed ? back : way;
    edge = reversed ? Edge(edge.p1, edge.e1, edge.e0, edge.p0, edge.across1, edge.across0, edge.transversal1,
                           edge.transversal0)
                    : edge;
    surface.position = edge_position(edge, t);
#ifndef FAULT_OWN_NORMAL
    // A sum of two is the same both ways.
    precise vec3 fallback = direction0 + direction1;
    vec3 along_edge = edge_normal(edge, t, fallback);
    surface.direction = way == 0.0 ? direction0 : way == 1.0 ? direction1 : along_edge;
    bool sharp = (bits & SHARP_EDGE_BIT) != 0u;
    surface.normal = way == 0.0 ? PICK(NORMAL0) : way == 1.0 ? PICK(NORMAL1) : sharp ? own.normal : along_edge;
#endif
#ifdef DISPLACED
#define TEXCOORD0(k, n) shared_texcoord[k][0]
#define TEXCOORD1(k, n) shared_texcoord[n][1]
#define CORNER_TEXCOORD0(k, n) shared_texcoord[k][2]
#define CORNER_TEXCOORD1(k, n) shared_texcoord[n][2]
#define LOD0(k, n) shared_lod[k]
#define LOD1(k, n) shared_lod[n]
    vec2 texcoord0 = PICK(TEXCOORD0), texcoord1 = PICK(TEXCOORD1);
    float lod0 = PICK(LOD0), lod1 = PICK(LOD1);
    precise float s = 1.0 - t;
    precise vec2 on_edge = s * (reversed ? texcoord1 : texcoord0) + t * (reversed ? texcoord0 : texcoord1);
    precise float lod = s * (reversed ? lod1 : lod0) + t * (reversed ? lod0 : lod1);
    surface.texcoord = way == 0.0 ? PICK(CORNER_TEXCOORD0) : way == 1.0 ? PICK(CORNER_TEXCOORD1) : on_edge;
    surface.lod = lod;
#endif
    return surface;
}
#endif

#endif
