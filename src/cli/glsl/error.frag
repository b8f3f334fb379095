// How far the surface is from the limit surface, as a colour. Rust twin: `ErrorMap` in src/cli/paint/errors.rs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw/draw.glsl"
#include "draw/output.glsl"
#include "tiles.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) centroid in vec3 world_normal;

layout(set = 2, binding = 0, std430) readonly restrict buffer Errors {
    uint side;     // samples along each side of a tile
    uint columns;  // tiles in a row
    float top;     // the error that has the last colour
    uint unused;
    vec4 colours[256];  // linear
    float values[];     // tile by tile, in rows
} errors;

// Linear in both triangles of a cell: triangular patches have values only up to the diagonal.
float error_at(uint tile, vec2 at) {
    uint side = errors.side;
    vec2 scaled = clamp(at, 0.0, 1.0) * float(side - 1u);
    uvec2 cell = min(uvec2(scaled), uvec2(side - 2u));
    vec2 t = scaled - vec2(cell);
    uint first = (tile * side + cell.y) * side + cell.x;
    float b = errors.values[first + 1u];
    float c = errors.values[first + side];
    if (t.x + t.y <= 1.0) {
        float a = errors.values[first];
        return a + t.x * (b - a) + t.y * (c - a);
    }
    float d = errors.values[first + side + 1u];
    return d + (1.0 - t.x) * (c - d) + (1.0 - t.y) * (b - d);
}

void main() {
    float value = error_at(painted_patch(errors.columns), painted_at());
    float step = 255.0 * clamp(value / errors.top, 0.0, 1.0);
    uint below = min(uint(step), 254u);
    vec3 error = mix(errors.colours[below], errors.colours[below + 1u], step - float(below)).rgb;
    write_colour(shaded(error, world_position, world_normal, view.eye.xyz), 1.0);
}
