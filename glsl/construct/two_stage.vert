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
#include "rings.glsl"
#ifdef GREGORY
#include "corner_gregory.glsl"
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
#ifdef INNER
    // The edges before and after the corner's own, and the three faces between.
    uint before = edge_before(ring, place.y), after = edge_after(ring, minus_edge);
    bool has_before = !(ring.open && place.y == 0u), has_after = !(ring.open && minus_edge == ring.faces);
    CornerFaces faces = CornerFaces(has_before, has_after, centre, edge_neighbour(ring, before), here, next, edge_neighbour(ring, after),
                          ring_face(ring, before), ring_face(ring, place.y), ring_face(ring, has_after ? minus_edge : 0u));
    inner_values(ring, place.y, minus_edge, faces, plus, minus, p, a, b, inner);
#endif
#ifdef SHARED
    SharedCorner with = share_corner(corner, FramedRing(place.x, ring, centre, p, a, b));
    shared_with = with.vectors;
    shared_bits = with.bits;
#ifdef DISPLACED
    shared_lod = with.lod;
#endif
#endif
}
