// What a fragment shader gets of the surface.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL

layout(location = 0) in vec3 world_position;
// Taken inside the triangle: at a silhouette, a normal from beyond its edge may face away.
layout(location = 1) centroid in vec3 world_normal;
#ifdef DISPLACED
layout(location = 2) in vec2 texcoord;
#include "displace/displace.glsl"
#endif

// Not of length one.
vec3 surface_normal() {
#ifdef DISPLACED
    return displaced_normal(world_position, world_normal, texcoord);
#else
    return world_normal;
#endif
}

#endif
