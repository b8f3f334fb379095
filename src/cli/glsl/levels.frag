// The leaves of an adaptive surface, by level and kind, with lines between them. Rust twin: `LevelMap` in src/cli/paint/levels.rs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw/draw.glsl"
#include "draw/output.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) centroid in vec3 world_normal;

layout(set = 2, binding = 0, std430) readonly restrict buffer Levels {
    uint columns;  // tiles in a row
    uint patches;
    uint first;    // word of the roots
    uint unused;
    vec4 colours[3 * (MAX_DEPTH + 1)];  // linear: of each level the kinds of leaves
    // The tiles; the two roots of each patch, which are the same but of wedges; the quadtrees, whose leaves are colours with the
    // leaf bit.
    uint words[];
} levels;
#define TILE_WORD(i) levels.words[i]
#include "tiles.glsl"

const vec3 LINE = vec3(0.012, 0.014, 0.02);

void main() {
    Painted here = painted(levels.columns);
    uint roots = levels.first + 2u * here.number, nodes = levels.first + 2u * levels.patches;
    uint root = levels.words[roots], next = levels.words[roots + 1u];
    vec2 at = clamp(here.at, 0.0, 1.0), pixel = here.pixel;
    if (root != next) {
        // Rust twin: `in_wedge` in src/table/cpu.rs.
        float to = at.x, centre = at.y, from = 1.0 - to - centre;
        bool is_next = from < to;
        root = is_next ? next : root;
        at = clamp(is_next ? vec2(centre, 2.0 * from + centre) : vec2(2.0 * to + centre, centre), 0.0, 1.0);
        pixel = is_next ? pixel.yx : pixel;
    }
    uint node = levels.words[nodes + root];
    for (uint level = 0u; level < MAX_DEPTH && (node & LEAF_BIT) == 0u; ++level) {
        uvec2 far = uvec2(greaterThanEqual(at, vec2(0.5)));
        at = 2.0 * at - vec2(far);
        pixel *= 2.0;
        node = levels.words[nodes + node + far.x + 2u * far.y];
    }
    // Half a line, on each side of the edge; none on leaves that would be nothing but lines.
    vec2 to_edge = min(at, 1.0 - at) / pixel;
    float line = 1.0 - smoothstep(0.4, 1.0, min(to_edge.x, to_edge.y));
    line *= 1.0 - smoothstep(0.15, 0.35, max(pixel.x, pixel.y));
    vec3 colour = mix(levels.colours[node & ~LEAF_BIT].rgb, LINE, 0.8 * line);
    write_colour(shaded(colour, world_position, world_normal, view.eye.xyz), 1.0);
}
