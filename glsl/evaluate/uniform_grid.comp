// Evaluation by compute: the vertices of each patch on a uniform grid, for draws to share. A workgroup takes some of the vertices
// of one patch. Rust twin: `Dispatch` in src/renderer/evaluate/uniform_grid.rs.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TEXCOORD
#include "constants.glsl"
#include "evaluate/uniform_grid.glsl"
#include "construct/read_cached.glsl"

layout(local_size_x = 32) in;


// Rust twin: `vertex_bytes` in src/renderer/pipelines/vertex_input.rs.
#ifdef DISPLACED
const uint VERTEX_WORDS = 14u;
#else
// Whether vertices have texture coordinates.
layout(constant_id = ID_HAS_TEXCOORDS) const bool HAS_TEXCOORDS = false;
const uint VERTEX_WORDS = HAS_TEXCOORDS ? 8u : 6u;
#endif
layout(set = 2, binding = 0, std430) writeonly buffer Vertices { float vertices[]; };

// One patch for each workgroup along x.
layout(push_constant, std430) uniform Patches {
    uint first_patch;
    uint first_corner;
    uint first_vertex;
    uint segments;
    uint vertices;  // of a patch
} patches;

void put(uint at, vec3 x) {
    vertices[at] = x.x;
    vertices[at + 1u] = x.y;
    vertices[at + 2u] = x.z;
}

void main() {
    uint first_corner = patches.first_corner + gl_WorkGroupID.x * CORNERS;
    read_cached(patches.first_patch + gl_WorkGroupID.x, first_corner, patches.segments);
    uint first_vertex = patches.first_vertex + gl_WorkGroupID.x * patches.vertices;
    uint start = gl_WorkGroupID.y * GROUP_VERTICES;
    uint end = min(start + GROUP_VERTICES, patches.vertices);
    for (uint i = start + gl_LocalInvocationID.x; i < end; i += gl_WorkGroupSize.x) {
        vec3 at = uniform_grid_parameter(i, patches.segments, first_corner);
        UniformGridSample surface = uniform_grid_sample(at);
        uint word = VERTEX_WORDS * (first_vertex + i);
        put(word, surface.position);
        put(word + 3u, surface.normal);
#ifndef DISPLACED
        if (!HAS_TEXCOORDS) {
            continue;
        }
#endif
        precise vec2 x = INTERPOLATED(texcoord, at);
        vertices[word + 6u] = x.x;
        vertices[word + 7u] = x.y;
#ifdef DISPLACED
        put(word + 8u, surface.direction);
        put(word + 11u, vec3(surface.texcoord, surface.lod));
#endif
    }
}
