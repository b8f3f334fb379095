// What the cached construction keeps of each corner: the control points that it owns and, after them, what it shares and whether its
// plus edge is sharp; number by number without gaps, up to whole texels of four. Rust twin: `Sharing::kept_texels` in src/table/sharing.rs.
#ifndef CACHED_GLSL
#define CACHED_GLSL

#include "constants.glsl"
#include "draw/packed.glsl"
#include "draw/positions.glsl"

// Texels that a corner has room for: as many as the corners of any patch of the model need.
layout(constant_id = ID_STRIDE) const uint STRIDE = 8u;

// `corner` counts through all patches.
#ifdef MAKES_POINTS
layout(set = 1, binding = BINDING_CONTROL_POINTS, std430) writeonly buffer ControlPoints { float control_points[]; };

void keep_number(uint corner, uint i, float x) {
    control_points[4u * STRIDE * corner + i] = x;
}

void keep_vector(uint corner, uint i, vec3 x) {
    keep_number(corner, 3u * i, x.x);
    keep_number(corner, 3u * i + 1u, x.y);
    keep_number(corner, 3u * i + 2u, x.z);
}
#else
// KEPT numbers are read of a corner: if not said otherwise, all that there are.
#ifdef SHARED
#include "edges/shared_bits.glsl"
#endif
#ifndef KEPT
#ifdef SHARED
#define KEPT (3 * (OWNED + SHARED_VECTORS) + 1)
#else
#define KEPT (3 * OWNED)
#endif
#endif
#define KEPT_TEXELS PACKED_ROWS(KEPT)

layout(set = 1, binding = BINDING_CONTROL_POINTS, std430) readonly buffer ControlPoints { vec4 control_points[]; };
layout(set = 1, binding = BINDING_CONTROL_POINT_TEXELS) uniform samplerBuffer control_point_texels;

vec4 kept_texel(uint corner, uint i) {
    uint at = STRIDE * corner + i;
    return READS_TEXELS ? texelFetch(control_point_texels, int(at)) : control_points[at];
}

// The i-th vector of those in some texels, and the i-th number.
#define kept_vector(texels, i) PACKED_VECTOR(texels, 3 * (i))
#define kept_number(texels, i) PACKED_NUMBER(texels, i)

#ifdef ATTRIBUTES
// Of the patch that the instance is, corner by corner.
#ifndef ATTRIBUTE_TEXELS
#define ATTRIBUTE_TEXELS KEPT_TEXELS
#endif
layout(location = 0) in vec4 attributes[CORNERS * ATTRIBUTE_TEXELS];

// Those of corner k of the patch whose first corner this is.
vec4[KEPT_TEXELS] texels_of_patch(uint first_corner, int k) {
    vec4 texels[KEPT_TEXELS];
    for (int i = 0; i < KEPT_TEXELS; ++i) {
        texels[i] = attributes[k * ATTRIBUTE_TEXELS + i];
    }
    return texels;
}
#else
#define texels_of_patch(first_corner, k) kept_texels(first_corner + k)
#endif

#ifdef SHARED
// As in `shared_bits`.
uint kept_bits(vec4 texels[KEPT_TEXELS]) {
    return kept_number(texels, KEPT - 1) != 0.0 ? SHARP_EDGE_BIT : 0u;
}
#endif

vec4[KEPT_TEXELS] kept_texels(uint corner) {
    vec4 texels[KEPT_TEXELS];
    for (int i = 0; i < KEPT_TEXELS; ++i) {
        texels[i] = kept_texel(corner, uint(i));
    }
    return texels;
}
#endif

#endif
