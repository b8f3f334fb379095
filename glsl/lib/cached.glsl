// What the cached construction keeps of each corner: the control points that it owns and, after them, what it shares. Rust twin:
// `ModelTables::kept_bytes` in src/renderer/tables.rs.
#ifndef CACHED_GLSL
#define CACHED_GLSL

// Vectors that a corner has room for: as many as the corners of any patch of the model need.
layout(constant_id = 3) const uint STRIDE = 8u;

#ifdef MAKES_POINTS
layout(set = 1, binding = 12, std430) writeonly buffer ControlPoints { float control_points[]; };
#else
layout(set = 1, binding = 12, std430) readonly buffer ControlPoints { float control_points[]; };
#endif

// Where vector i of a corner starts; `corner` counts through all patches.
uint kept_at(uint corner, uint i) {
    return 3u * (STRIDE * corner + i);
}

#ifdef MAKES_POINTS
void keep_vector(uint corner, uint i, vec3 x) {
    uint at = kept_at(corner, i);
    control_points[at] = x.x;
    control_points[at + 1u] = x.y;
    control_points[at + 2u] = x.z;
}
#else
vec3 kept_vector(uint corner, uint i) {
    uint at = kept_at(corner, i);
    return vec3(control_points[at], control_points[at + 1u], control_points[at + 2u]);
}
#endif

#endif
