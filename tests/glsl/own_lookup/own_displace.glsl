// In the place of a position: where and at which level the displacement would be looked up.
#ifndef DISPLACE_GLSL
#define DISPLACE_GLSL

vec3 displace(vec3 position, vec3 direction, vec2 texcoord, float lod) {
    return vec3(texcoord, lod);
}

#endif
