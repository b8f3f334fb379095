// What all tessellation evaluation shaders share: the domain, the control points, and what goes to the fragment stage.
// The documented stage interface: location 0 the position and 1 the normal in world space, 2 the texture coordinate.
#ifndef EVALUATION_GLSL
#define EVALUATION_GLSL

#ifdef PENTAGON
// A piece of it.
#define TRIANGLE
#endif

// Displacement needs all that is shared.
#ifdef DISPLACED
#define SHARED
#define TEXCOORD
#endif

#include "draw/draw.glsl"
#include "draw/instance_out.glsl"
#include "evaluate/patch.glsl"

// The renderer puts other spacings in the place of this one (`spaced` in src/renderer/shader/spirv.rs).
// Clockwise in the parameter domain, whose v points down in Vulkan: counter-clockwise seen from outside.
// A captured grid of a triangle is laid over a quad domain: the tessellator's own triangles are no grid.
#if defined(TRIANGLE) && !defined(CAPTURE_GRID)
layout(triangles, equal_spacing, cw) in;
#else
layout(quads, equal_spacing, cw) in;
#endif

#include "draw/handed_on.glsl"
layout(location = 0) in vec4 handed_on[][HANDED_ROWS];
layout(location = LOCATION_PATCH_INSTANCE) patch in uint instance_of_patch;
// The control points that each corner owns.
vec3 owned[CORNERS][OWNED];

// The same bits in every pipeline: a pass for depth alone, and one that tests against it.
invariant gl_Position;
layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
#ifdef TEXCOORD
vec2 texcoord[CORNERS];
layout(location = 2) out vec2 out_texcoord;
#endif

#ifdef MAY_BE_ADAPTIVE
#define HANDS_ON_LEAVES
#include "evaluate/adaptive.glsl"
#endif
#ifdef SHARED
#include "edges/edges.glsl"
#endif
#ifdef DISPLACED
#include "displace/displaced.glsl"
#endif

#if defined(CAPTURE) || defined(CAPTURE_GRID)
#include "capture/capture.glsl"
layout(location = 11) patch in uint captured_patch;
// For glsl/capture/triangles.geom.
layout(location = 6) out vec3 out_coordinate;
layout(location = 7) out uint out_patch;
uint capture_place;
uint capture_places;
#endif

// Takes what was handed on of the patch.
void read_patch() {
    if (INSTANCES) {
        instance_number = instance_of_patch;
    }
#ifdef MAY_BE_ADAPTIVE
    uint low = uint(PACKED_NUMBER(handed_on[0], HANDED_PATCH)), high = uint(PACKED_NUMBER(handed_on[1], HANDED_PATCH));
    evaluated_patch = high << 24 | low;
#endif
    for (int k = 0; k < CORNERS; ++k) {
        for (int i = 0; i < OWNED; ++i) {
            owned[k][i] = PACKED_VECTOR(handed_on[k], 3 * i);
        }
#ifdef SHARED
        for (int i = 0; i < SHARED_VECTORS; ++i) {
            shared_with[k][i] = PACKED_VECTOR(handed_on[k], HANDED_SHARED + 3 * i);
        }
        shared_bits[k] = PACKED_NUMBER(handed_on[k], HANDED_SHARP) != 0.0 ? SHARP_EDGE_BIT : 0u;
#endif
#ifdef DISPLACED
        for (int i = 0; i < 3; ++i) {
            shared_texcoord[k][i] = PACKED_PAIR(handed_on[k], HANDED_MAP + 2 * i);
        }
        shared_lod[k] = PACKED_NUMBER(handed_on[k], HANDED_LOD);
#endif
#ifdef TEXCOORD
        texcoord[k] = PACKED_PAIR(handed_on[k], HANDED_TEXCOORD);
#endif
    }
}

// Where to evaluate the patch, which is then there: (u, v) of a quad, (u, v, w) of a triangle.
vec3 parameter() {
    read_patch();
#ifdef CAPTURE_GRID
    uint n = capture_grid;
    uint i = uint(round(gl_TessCoord.x * float(n - 1u)));
    uint j = uint(round(gl_TessCoord.y * float(n - 1u)));
#ifdef TRIANGLE
    // Row j has j + 1 samples; the rest of the square repeats the last one.
    i = min(i, j);
    capture_place = j * (j + 1u) / 2u + i;
    capture_places = n * (n + 1u) / 2u;
    precise float w = float(i) / float(n - 1u);
    precise float v = float(j - i) / float(n - 1u);
    precise float u = 1.0 - v - w;
    return vec3(u, v, w);
#else
    capture_place = j * n + i;
    capture_places = n * n;
    precise vec2 uv = vec2(float(i), float(j)) / float(n - 1u);
    return vec3(uv, 0.0);
#endif
#else
    return gl_TessCoord;
#endif
}

// Hands on a vertex.
void emit_sample(Sample surface, vec3 at) {
#ifdef CAPTURE
    capture_sample(captured_patch, 0u, 0u, at, surface.position, surface.normal);
#endif
#ifdef CAPTURE_GRID
    capture_sample(captured_patch, capture_place, capture_places, at, surface.position, surface.normal);
#endif
#if defined(CAPTURE) || defined(CAPTURE_GRID)
    out_coordinate = at;
    out_patch = captured_patch;
#endif
#ifdef TEXCOORD
    out_texcoord = INTERPOLATED(texcoord, at);
#endif
    hand_on_instance();
    world_position = to_world(surface.position);
    world_normal = normal_to_world(surface.normal);
    gl_Position = to_clip(world_position);
}

// A vertex of the surface, as all patches at an edge have it.
void emit(Surface surface, vec3 at) {
#ifdef DISPLACED
    SharedSample of_all = share(surface, at);
    vec3 displaced = displace(of_all.position, of_all.direction, of_all.texcoord, of_all.lod);
    emit_sample(Sample(displaced, of_all.normal), at);
#elif defined(SHARED)
    SharedSample of_all = share(surface, at);
    emit_sample(Sample(of_all.position, of_all.normal), at);
#else
    emit_sample(sample_of(surface), at);
#endif
}

#endif
