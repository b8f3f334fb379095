// Reflection lines: the surface as a mirror in a room of stripes. Where normals turn suddenly, stripes break or have corners.
// variants: DISPLACED
#version 460
#extension GL_GOOGLE_include_directive : require
#define FRAGMENT_STAGE
#include "draw/draw.glsl"
#include "draw/output.glsl"
#include "evaluate/surface.glsl"

const vec3 DARK = vec3(0.015, 0.025, 0.05), LIGHT = vec3(0.82, 0.83, 0.80);

// The part of a step from 0 on that is light, summed up.
float light_until(float s) {
    return 0.5 * floor(s) + max(fract(s) - 0.5, 0.0);
}

void main() {
    vec3 to_eye = normalize(view.eye.xyz - world_position);
    vec3 normal = normalize(surface_normal());
    // The same for both sides.
    vec3 reflected = reflect(-to_eye, normal);
    // Pairs of a dark and a light stripe, from the middle of the dark one straight up to straight down. Not by the arc cosine,
    // which is rough there.
    float s = float(item.words.x) * atan(length(reflected.xz), reflected.y) / 3.14159265 + 0.25;
    // What a pixel sees of the stripes; of many the mean.
    float width = max(fwidth(s), 1e-4);
    float light = (light_until(s + 0.5 * width) - light_until(s - 0.5 * width)) / width;
    // So that the shape is seen, too.
    float facing = mix(0.55, 1.0, abs(dot(normal, to_eye)));
    write_colour(mix(DARK, LIGHT * facing, light), draw_colour().a);
}
