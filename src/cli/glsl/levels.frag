// The leaves of an adaptive surface, by level and kind, with lines between them. Rust twin: `LevelMap` in src/cli/paint/levels.rs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw/draw.glsl"
#include "draw/output.glsl"
#include "tiles.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) centroid in vec3 world_normal;

layout(set = 2, binding = 0, std430) readonly restrict buffer Levels {
    uint columns;  // tiles in a row
    uint patches;
    uvec2 unused;
    vec4 colours[3 * (MAX_DEPTH + 1)];  // linear: of each level the kinds of leaves
    // The root of each patch; then the quadtrees, whose leaves are colours with the leaf bit.
    uint words[];
} levels;

const vec3 LINE = vec3(0.012, 0.014, 0.02);

void main() {
    vec2 at = clamp(painted_at(), 0.0, 1.0);
    // Before the walk, which differs from pixel to pixel. Of a patch seen from its side, no less than some of it.
    vec2 pixel = max(fwidth(at), 1e-6);
    uint node = levels.words[levels.patches + levels.words[painted_patch(levels.columns)]];
    for (uint level = 0u; level < MAX_DEPTH && (node & LEAF_BIT) == 0u; ++level) {
        uvec2 far = uvec2(greaterThanEqual(at, vec2(0.5)));
        at = 2.0 * at - vec2(far);
        pixel *= 2.0;
        node = levels.words[levels.patches + node + far.x + 2u * far.y];
    }
    // Half a line, on each side of the edge; none on leaves that would be nothing but lines.
    vec2 to_edge = min(at, 1.0 - at) / pixel;
    float line = 1.0 - smoothstep(0.4, 1.0, min(to_edge.x, to_edge.y));
    line *= 1.0 - smoothstep(0.15, 0.35, max(pixel.x, pixel.y));
    vec3 colour = mix(levels.colours[node & ~LEAF_BIT].rgb, LINE, 0.8 * line);
    write_colour(shaded(colour, world_position, world_normal, view.eye.xyz), 1.0);
}
