// First stage of the two-stage construction: a control vertex and its one-ring become what a corner of a patch takes from
// them (Loop et al. 2009, section 4): its limit point, the vectors from there to its edge points and, by scheme, what its
// inner points need. One invocation for each corner of each patch.
// variants: GREGORY, ACC, PM, SHARED, DISPLACED, GREGORY+SHARED, GREGORY+DISPLACED
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef DISPLACED
#define SHARED
#endif
#include "draw.glsl"
#include "corner_faces.glsl"
#ifdef GREGORY
#define INNER 2
#elif defined(ACC)
#include "corner_acc.glsl"
#elif defined(PM)
#include "corner_pm.glsl"
#endif
#ifdef SHARED
#include "shared.glsl"
#endif

layout(constant_id = 0) const uint CORNERS = 4u;

layout(location = 0) out vec3 centre;
layout(location = 1) out vec4 limit;  // w: the ring's cosine
layout(location = 2) out vec3 plus;
layout(location = 3) out vec3 minus;
layout(location = 4) out uint patch_number;
#ifdef INNER
layout(location = 5) out vec3 inner[INNER];
#endif
#ifdef SHARED
layout(location = 8) out vec3 shared_with[SHARED_VECTORS];
layout(location = 14) out uint shared_bits;
#ifdef DISPLACED
layout(location = 15) out float shared_lod;
#endif
#endif

void main() {
    // Not gl_PrimitiveID: lavapipe restarts it (bug B).
    uint vertex = uint(gl_VertexIndex);
    uint first = uint(gl_InstanceIndex) * draw.patches_per_instance;
    patch_number = first + vertex / CORNERS;
    uint corner = draw.first_corner + first * CORNERS + vertex;
    uvec2 place = patch_corners[corner];
    Ring ring = ring_at(place.x);
    uint minus_edge = edge_after(ring, place.y);
    centre = vertex_position(ring.vertex);
    vec3 p, a, b;
    ring_frame(ring, centre, p, a, b);
    limit = vec4(p, ring_cosine(ring));
    vec3 here = edge_neighbour(ring, place.y), next = edge_neighbour(ring, minus_edge);
    plus = edge_vector(ring, place.y, centre, here, a, b);
    minus = edge_vector(ring, minus_edge, centre, next, a, b);
#if defined(INNER) || defined(SHARED)
    CornerFaces faces = corner_faces(ring, place.y, minus_edge, centre, here, next);
#endif
#if defined(GREGORY) || defined(SHARED)
    vec3 r[2] = transversals(ring, place.y, minus_edge, faces, a, b);
#endif
#ifdef GREGORY
    inner = r;
#elif defined(ACC)
    inner = acc_corner(ring, faces, p, plus, minus);
#elif defined(PM)
    inner = pm_corner(faces);
#endif
#ifdef SHARED
    vec3 e_before = edge_vector(ring, edge_before(ring, place.y), centre, faces.before, a, b);
    vec3 e_after = edge_vector(ring, edge_after(ring, minus_edge), centre, faces.after, a, b);
    SharedEdge own_plus = SharedEdge(across(ring, place.y, e_before, plus, minus), r[0]);
    SharedEdge own_minus = SharedEdge(across(ring, minus_edge, plus, minus, e_after), r[1]);
    SharedCorner with = share_corner(corner, FramedRing(place.x, ring, centre, p, a, b), own_plus, own_minus);
    shared_with = with.vectors;
    shared_bits = with.bits;
#ifdef DISPLACED
    shared_lod = with.lod;
#endif
#endif
}
