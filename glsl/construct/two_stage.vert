// First stage of the two-stage construction: a control vertex and its one-ring become the limit point and its tangent
// frame (Loop et al. 2009, section 4). One invocation for each corner of each patch.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"
#include "rings.glsl"

layout(constant_id = 0) const uint CORNERS = 4u;

layout(location = 0) out vec3 centre;
layout(location = 1) out vec4 limit;  // w: the ring's cosine
layout(location = 2) out vec3 tangent_a;
layout(location = 3) out vec3 tangent_b;
layout(location = 4) out uint patch_number;

void main() {
    // Not gl_PrimitiveID: lavapipe restarts it (bug B).
    uint vertex = uint(gl_VertexIndex);
    uint first = uint(gl_InstanceIndex) * draw.patches_per_instance;
    patch_number = first + vertex / CORNERS;
    Ring ring = ring_at(patch_corners[draw.first_corner + first * CORNERS + vertex].x);
    centre = vertex_position(ring.vertex);
    vec3 p;
    ring_frame(ring, centre, p, tangent_a, tangent_b);
    limit = vec4(p, ring_cosine(ring));
}
