// Evaluation by compute: the vertices of each patch on a lattice with the same number of segments along every side. A
// workgroup takes some of the vertices of one patch. Rust twins: `Dispatch` in
// src/renderer/lattice.rs, `grid_parameters` in src/table/cpu.rs for the order.
#ifndef LATTICE_GLSL
#define LATTICE_GLSL

#ifndef CORNERS
#ifdef TRIANGLE
#define CORNERS 3
#else
#define CORNERS 4
#endif
#endif

#include "cached.glsl"
#include "patch.glsl"

layout(local_size_x = 32) in;

// Vertices of a patch that a workgroup takes: enough that reading the control points is little beside them.
const uint GROUP_VERTICES = 256u;

#ifdef TEXCOORD
const uint VERTEX_WORDS = 8u;
layout(set = 1, binding = 8, std430) readonly buffer Texcoords { vec2 texcoords[]; };
vec2 texcoord[CORNERS];
#else
const uint VERTEX_WORDS = 6u;
#endif
layout(set = 2, binding = 0, std430) writeonly buffer Vertices { float vertices[]; };

// One patch for each workgroup along x.
layout(push_constant, std430) uniform Patches {
    uint first_corner;
    uint first_vertex;
    uint segments;
    uint vertices;  // of a patch
} patches;

// The control points that each corner of the patch owns.
vec3 owned[CORNERS][OWNED];

Surface evaluate_surface(vec3 at);

// The parameter of vertex i along a side, with 16 bits after the point: from both ends of an edge the same vertices, for
// `1 - t` is exact. As tessellators that follow Direct3D's have it, which step by a rounded 1 / n; they end at 64 segments.
float along_side(uint i) {
    uint near = min(i, patches.segments - i);
    precise float step_size = 65536.0 / float(patches.segments);
    precise float t = round(float(near) * (patches.segments <= 64u ? round(step_size) : step_size)) / 65536.0;
    t = 2u * near == patches.segments ? 0.5 : t;
    return i == near ? t : 1.0 - t;
}

// (u, v) of a quad, (u, v, w) of a triangle.
vec3 lattice_parameter(uint i) {
#ifdef TRIANGLE
    // Row r starts with vertex r (r + 1) / 2.
    uint row = uint((sqrt(float(8u * i + 1u)) - 1.0) / 2.0);
    row += (row + 1u) * (row + 2u) / 2u <= i ? 1u : 0u;
    row -= row * (row + 1u) / 2u > i ? 1u : 0u;
    uint place = i - row * (row + 1u) / 2u;
    float v = along_side(row - place), w = along_side(place);
    return vec3(1.0 - v - w, v, w);
#else
    uint side = patches.segments + 1u;
    // By floating point, which devices divide faster: right up to the 1024 segments that there may be.
    uint row = uint((float(i) + 0.5) / float(side));
    return vec3(along_side(i - row * side), along_side(row), 0.0);
#endif
}

void put(uint at, vec3 x) {
    vertices[at] = x.x;
    vertices[at + 1u] = x.y;
    vertices[at + 2u] = x.z;
}

void evaluate_lattice() {
    uint first_corner = patches.first_corner + gl_WorkGroupID.x * CORNERS;
    for (uint k = 0u; k < CORNERS; ++k) {
        uint from = corner_points(first_corner + k);
        for (uint i = 0u; i < OWNED; ++i) {
            uint x = from + 3u * i;
            owned[k][i] = vec3(control_points[x], control_points[x + 1u], control_points[x + 2u]);
        }
#ifdef TEXCOORD
        texcoord[k] = texcoords[first_corner + k];
#endif
    }
    uint first_vertex = patches.first_vertex + gl_WorkGroupID.x * patches.vertices;
    uint start = gl_WorkGroupID.y * GROUP_VERTICES;
    uint end = min(start + GROUP_VERTICES, patches.vertices);
    for (uint i = start + gl_LocalInvocationID.x; i < end; i += gl_WorkGroupSize.x) {
        vec3 at = lattice_parameter(i);
        Sample surface = sample_of(evaluate_surface(at));
        uint word = VERTEX_WORDS * (first_vertex + i);
        put(word, surface.position);
        put(word + 3u, surface.normal);
#ifdef TEXCOORD
        vec2 x = INTERPOLATED(texcoord, at);
        vertices[word + 6u] = x.x;
        vertices[word + 7u] = x.y;
#endif
    }
}

#endif
