// The displacement map of a model.
#ifndef DISPLACEMENT_MAP_GLSL
#define DISPLACEMENT_MAP_GLSL

#include "constants.glsl"

// Heights in red, or vectors in object space.
layout(set = 1, binding = BINDING_DISPLACEMENT_MAP) uniform sampler2D displacement_map;

// Texels along its longer side.
float displacement_texels() {
    vec2 size = vec2(textureSize(displacement_map, 0));
    return max(size.x, size.y);
}

#endif
