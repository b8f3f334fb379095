// Which patches of a draw can be seen: one invocation for each patch, by the rules of the control shaders. Control points that are
// cached are read; others are made, as in a draw of the two-stage or the stencil construction, for nothing but this; of refined faces,
// hulls are read. Each workgroup lists those of its patches that can be seen, and writes the indirect draws of them; for instances to have
// what is kept of them as attributes, it also copies that, one after the other as on the list.
#version 460
#extension GL_GOOGLE_include_directive : require
#define MAKES_LISTS
#include "constants.glsl"
#include "draw/draw.glsl"
#include "draw/patch_kind.glsl"
#include "draw/visible.glsl"
#include "draw/construction.glsl"
#include "construct/two_stages.glsl"
#include "construct/stencils.glsl"
#include "construct/cached.glsl"

// Whether what is kept of patches is copied. Set in src/renderer/frame/lists.rs.
layout(constant_id = ID_COPIES) const bool COPIES = false;

layout(local_size_x = REGION) in;

// A bit for each patch that can be seen wholly, and for each that can be in part; then their numbers.
shared uint seen[2][REGION / 32u];
shared uint listed[REGION];

uint outside[CORNERS];
vec4 pixel_box[CORNERS];
#include "edges/culling.glsl"
#include "edges/edge_factors.glsl"
#ifdef MAY_BE_ADAPTIVE
#include "edges/hulls.glsl"
#else
const bool ADAPTIVE = false;

Examined examine_hull(uint patch_number, uint first, uint step) {
    return Examined(0u, vec4(0.0), true);
}
#endif

// Not in a loop: Mesa (22.3) unrolls none that has another in it, and so has the arrays that it goes through in memory. That took
// half as long again.
#ifdef TRIANGLE
#define CORNER_BY_CORNER(f) f(0u); f(1u); f(2u);
#else
#define CORNER_BY_CORNER(f) f(0u); f(1u); f(2u); f(3u);
#endif

// Has the control points of a patch in `owned`, by its number within the draw.
void find_points(uint patch_number) {
    uint first = draw.first_corner + patch_number * CORNERS;
#define BEGIN(k) corners[k] = corner_of_patch(first + k)
#define MAKE(k) stencil_points(draw.first_patch + patch_number, k, CORNERS, owned[k])
    if (CONSTRUCTION == TWO_STAGE) {
        CORNER_BY_CORNER(BEGIN)
        second_stage();
    } else if (CONSTRUCTION == STENCIL) {
        CORNER_BY_CORNER(MAKE)
    } else {
        for (uint k = 0u; k < CORNERS; ++k) {
            vec4 texels[KEPT_TEXELS] = kept_texels(first + k);
            for (int i = 0; i < OWNED; ++i) {
                owned[k][i] = kept_vector(texels, i);
            }
        }
    }
}

// How much of a patch there is to see: nothing, some of it, or all that faces the eye.
const uint NOTHING = 0u, SOME = 1u, ALL = 2u;

uint to_see(uint patch_number) {
    if (!ADAPTIVE) {
        find_points(patch_number);
    }
    bool crosses = false;
    float smallest = MAX_FACTOR;
    for (uint k = 0u; k < CORNERS; ++k) {
        Examined examined;
        if (ADAPTIVE) {
            examined = examine_hull(draw.first_patch + patch_number, k, CORNERS);
        } else {
            examined = examine(owned[k]);
            smallest = min(smallest, within_limits(plus_factor(patch_number, k)));
        }
        outside[k] = examined.outside;
        pixel_box[k] = examined.pixel_box;
        crosses = crosses || examined.crosses;
    }
    return is_culled(1.0 / smallest) ? NOTHING : crosses ? SOME : ALL;
}

void write_words(uint at, uvec4 words) {
    for (uint i = 0u; i < 4u; ++i) {
        visible.words[at + i] = words[i];
    }
}

// Draws of the patches that are on the visible list from `start` on.
void write_commands(uint start, uint count) {
    if (draw.patches_per_instance == 0u) {
        // VkDrawIndexedIndirectCommand: an instance for each patch.
        uint at = draw.count + 5u * gl_WorkGroupID.x;
        write_words(at, uvec4(draw.vertices, count, draw.first_index, 0u));
        visible.words[at + 4u] = start;
        return;
    }
    // VkDrawIndirectCommand: whole instances, and what is left as one more; the draws start where the list ends.
    uint at = draw.count + 8u * gl_WorkGroupID.x, first_vertex = start * draw.vertices;
    uint whole = count / draw.patches_per_instance, rest = count % draw.patches_per_instance;
    write_words(at, uvec4(draw.patches_per_instance * draw.vertices, whole, first_vertex, 0u));
    write_words(at + 4u, uvec4(rest * draw.vertices, rest > 0u ? 1u : 0u, first_vertex, whole));
}

void main() {
    uint id = gl_LocalInvocationID.x, start = gl_WorkGroupID.x * REGION, patch_number = start + id;
    uint word = id / 32u, bit = 1u << id % 32u;
    if (id < REGION / 32u) {
        seen[0][id] = 0u;
        seen[1][id] = 0u;
    }
    barrier();
    uint there = patch_number < draw.count ? to_see(patch_number) : NOTHING;
    uint part = there == ALL ? 0u : 1u;
    if (there != NOTHING) {
        atomicOr(seen[part][word], bit);
    }
    barrier();
    // In their order, but first those that can be seen wholly: instances in which nothing is clipped are faster on lavapipe.
    uint count = 0u, before = 0u;
    for (uint of = 0u; of < 2u; ++of) {
        for (uint i = 0u; i < REGION / 32u; ++i) {
            uint bits = seen[of][i];
            bool earlier = of < part || of == part && i < word;
            before += bitCount(earlier ? bits : of == part && i == word ? bits & bit - 1u : 0u);
            count += bitCount(bits);
        }
    }
    if (id == 0u) {
        write_commands(start, count);
    }
    if (there != NOTHING) {
        visible.words[start + before] = patch_number;
        listed[before] = patch_number;
    }
    if (!COPIES) {
        return;
    }
    barrier();
    const uint TEXELS = CORNERS * STRIDE;
    for (uint i = id; i < count * TEXELS; i += REGION) {
        uvec4 texel = floatBitsToUint(kept_texel(draw.first_corner + listed[i / TEXELS] * CORNERS, i % TEXELS));
        write_words(draw.copies + 4u * (start * TEXELS + i), texel);
    }
}
