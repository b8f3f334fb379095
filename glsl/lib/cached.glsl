// The control points of the cached construction, corner by corner. Rust twin: `ModelTables::control_point_bytes` in
// src/renderer/tables.rs.
#ifndef CACHED_GLSL
#define CACHED_GLSL

// Control points that a corner has room for: as many as the corners of any patch of the model own.
layout(constant_id = 3) const uint STRIDE = 8u;

#ifndef CACHED_ACCESS
#define CACHED_ACCESS readonly
#endif
layout(set = 1, binding = 12, std430) CACHED_ACCESS buffer ControlPoints { float control_points[]; };

// Where the points of a corner start; `corner` counts through all patches.
uint corner_points(uint corner) {
    return 3u * STRIDE * corner;
}

#endif
