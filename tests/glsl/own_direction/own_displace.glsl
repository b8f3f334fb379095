// In the place of a position: the direction of displacement.
#ifndef DISPLACE_GLSL
#define DISPLACE_GLSL

vec3 displace(vec3 position, vec3 direction, vec2 texcoord, float lod) {
    return direction;
}

#endif
