// The colour that goes into the attachment.
#ifndef OUTPUT_GLSL
#define OUTPUT_GLSL

#include "constants.glsl"

// Whether the attachment holds sRGB values in a format that does not encode them by itself.
layout(constant_id = ID_ENCODE_SRGB) const bool ENCODE_SRGB = false;

layout(location = 0) out vec4 colour;

void write_colour(vec3 linear, float alpha) {
    vec3 encoded = mix(1.055 * pow(max(linear, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, 12.92 * linear,
                       lessThanEqual(linear, vec3(0.0031308)));
    colour = vec4(ENCODE_SRGB ? encoded : linear, alpha);
}

#endif
