// How far the surface is from the limit surface, as a colour. Rust twin: `ErrorMap` in src/cli/paint/errors.rs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw/draw.glsl"
#include "draw/output.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) centroid in vec3 world_normal;

layout(set = 2, binding = 0, std430) readonly restrict buffer Errors {
    uint side;     // samples along each side of a tile
    uint columns;  // tiles in a row
    float top;     // the error that has the last colour
    uint first;    // word of the values
    vec4 colours[256];  // linear
    // The tiles; then the values patch by patch, in rows.
    uint words[];
} errors;
#define TILE_WORD(i) errors.words[i]
#include "tiles.glsl"

float value(uint i) {
    return uintBitsToFloat(errors.words[errors.first + i]);
}

// Linear in both triangles of a cell: triangular patches have values only up to the diagonal.
float error_at(uint number, vec2 at) {
    uint side = errors.side;
    vec2 scaled = clamp(at, 0.0, 1.0) * float(side - 1u);
    uvec2 cell = min(uvec2(scaled), uvec2(side - 2u));
    vec2 t = scaled - vec2(cell);
    uint first = (number * side + cell.y) * side + cell.x;
    float b = value(first + 1u);
    float c = value(first + side);
    if (t.x + t.y <= 1.0) {
        float a = value(first);
        return a + t.x * (b - a) + t.y * (c - a);
    }
    float d = value(first + side + 1u);
    return d + (1.0 - t.x) * (c - d) + (1.0 - t.y) * (b - d);
}

void main() {
    Painted here = painted(errors.columns);
    float step = 255.0 * clamp(error_at(here.number, here.at) / errors.top, 0.0, 1.0);
    uint below = min(uint(step), 254u);
    vec3 error = mix(errors.colours[below], errors.colours[below + 1u], step - float(below)).rgb;
    write_colour(shaded(error, world_position, world_normal, view.eye.xyz), 1.0);
}
