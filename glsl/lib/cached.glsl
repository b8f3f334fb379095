// What the cached construction keeps of each corner: the control points that it owns and, after them, what it shares. Each vector
// takes four numbers, of which the last is unused. Rust twin: `ModelTables::kept_bytes` in src/renderer/tables.rs.
#ifndef CACHED_GLSL
#define CACHED_GLSL

#include "positions.glsl"

// Vectors that a corner has room for: as many as the corners of any patch of the model need.
layout(constant_id = 3) const uint STRIDE = 8u;

// `corner` counts through all patches.
#ifdef MAKES_POINTS
layout(set = 1, binding = 12, std430) writeonly buffer ControlPoints { vec4 control_points[]; };

void keep_vector(uint corner, uint i, vec3 x) {
    control_points[STRIDE * corner + i].xyz = x;
}
#else
layout(set = 1, binding = 12, std430) readonly buffer ControlPoints { vec4 control_points[]; };
layout(set = 1, binding = 20) uniform samplerBuffer control_point_texels;

vec4 kept_texel(uint corner, uint i) {
    uint at = STRIDE * corner + i;
    return READS_TEXELS ? texelFetch(control_point_texels, int(at)) : control_points[at];
}

vec3 kept_vector(uint corner, uint i) {
    return kept_texel(corner, i).xyz;
}
#endif

#endif
