// ACC as published (Loop and Schaefer 2008), for the bench, instanced: the tangents across the edges are made at every vertex.
// The surface is that of glsl/evaluate/instanced.vert with ACC, in whose place it is drawn; no face may fall back.
// variants: ATTRIBUTES
#version 460
#extension GL_GOOGLE_include_directive : require
#define CORNERS 4
#define OWNED 6
vec3 owned[CORNERS][OWNED];
float cosines[CORNERS];

#include "acc.glsl"
#define x_plus(k) across(k, edge_plus(k), edge_minus((k + 1) & 3), t_plus(k), (k + 1) & 3)
#define x_minus(k) across(k, edge_minus(k), edge_plus((k + 3) & 3), t_minus(k), (k + 3) & 3)
#define across(k, near, far, tangent, end) acc_across(inner(k), near, near, far, tangent, cosines[k], cosines[end])
#include "scheme_evaluate.glsl"
// A kind of patch of its own.
#define KINDS_GLSL
#include "evaluate/uniform_grid.glsl"
// And the cosine.
#define KEPT (3 * OWNED + 1)
// Of ours, which are eight vectors a corner.
#define ATTRIBUTE_TEXELS 6
#include "construct/cached.glsl"
#include "draw/draw.glsl"
#include "draw/instance_out.glsl"

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;

void main() {
    uint first_corner = draw.first_corner + uint(gl_InstanceIndex) * CORNERS;
    for (int k = 0; k < CORNERS; ++k) {
        vec4 texels[KEPT_TEXELS] = texels_of_patch(first_corner, k);
        for (int i = 0; i < OWNED; ++i) {
            owned[k][i] = kept_vector(texels, i);
        }
        cosines[k] = kept_number(texels, 3 * OWNED);
    }
    vec3 at = uniform_grid_parameter(uint(gl_VertexIndex), item.segments, first_corner);
    Sample surface = uniform_grid_sample(at);
    world_position = to_world(surface.position);
    world_normal = normal_to_world(surface.normal);
    gl_Position = to_clip(world_position);
}
