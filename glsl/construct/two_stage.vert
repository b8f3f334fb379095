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
#include "corner.glsl"
#include "visible.glsl"
#ifdef DISPLACED
#include "corner_lod.glsl"
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
    patch_number = patch_drawn(uint(gl_InstanceIndex) * draw.patches_per_instance + vertex / CORNERS);
    uint number = draw.first_corner + patch_number * CORNERS + vertex % CORNERS;
    Corner corner = corner_of_patch(number);
    centre = corner.centre;
    limit = corner.limit;
    plus = corner.plus;
    minus = corner.minus;
#ifdef INNER
    inner = corner.inner;
#endif
#ifdef SHARED
    shared_with = corner.with;
    shared_bits = corner_bits(number);
#ifdef DISPLACED
    shared_lod = corner_lod(number, corner.speaker);
#endif
#endif
}
