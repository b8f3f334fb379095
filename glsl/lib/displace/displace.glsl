// Where a displaced surface goes: the one function to write anew for a displacement of your own.
//
// The evaluation shaders call `displace` with what all patches at a point share, so whatever it makes of these alone is
// without cracks. To have your own, write a file `own_displace.glsl` with a function like the one below. Then compile, of
// `ShaderId::ALL` in the library, those that you draw with: of the source `glsl/evaluate/tessellation.tese` (or `instanced.vert`,
// `uniform_grid.vert` or `strips.geom` without the tessellation stages) those whose arguments have `-DDISPLACED`, such as
//
//     glslangValidator -V --target-env vulkan1.2 -I. ARGUMENTS -DOWN_DISPLACE SOURCE -o shader.spv
//
// with `ShaderId::arguments` and `ShaderId::source`, in the folder of the crate, and give the SPIR-V to the renderer as
// `Options::shaders` (of `instanced.vert`, those with `-DATTRIBUTES` are faster, and may be left away). For the map include
// `displace/displacement_map.glsl`. Light knows nothing of your displacement: bring a fragment shader of your own.
#ifndef DISPLACE_GLSL
#define DISPLACE_GLSL

#include "constants.glsl"
#include "displace/displacement_map.glsl"
#include "draw/draw.glsl"


// Object space to object space. `direction` is of length one, `texcoord` that of the edge's or corner's owner on edges and
// corners, `lod` a level of the map at which a segment of the tessellation is about a texel long.
vec3 displace(vec3 position, vec3 direction, vec2 texcoord, float lod) {
    vec4 texel = textureLod(displacement_map, texcoord, lod);
    precise vec3 vector = item.displacement_scale * texel.xyz + item.displacement_bias;
    precise vec3 along = (item.displacement_scale * texel.x + item.displacement_bias) * direction;
    precise vec3 displaced = position + ((draw.flags & VECTOR_FLAG) != 0u ? vector : along);
    return displaced;
}

#ifdef FRAGMENT_STAGE
// The normal of the displaced surface in world space, so that light shows what is finer than the tessellation (Mikkelsen,
// Bump Mapping Unparametrized Surfaces on the GPU, 2010). `normal` is that of the surface before it was displaced.
vec3 displaced_normal(vec3 position, vec3 normal, vec2 texcoord) {
    vec3 dx = dFdx(position), dy = dFdy(position);
    if ((draw.flags & VECTOR_FLAG) != 0u) {
        // Of the triangle: the map says nothing of what lies between its vertices.
        vec3 plane = cross(dx, dy);
        return dot(plane, normal) < 0.0 ? -plane : plane;
    }
    float scale = item.displacement_scale * length(transform_row(0u).xyz);
    float height = texture(displacement_map, texcoord).x;
    float height_dx = scale * (texture(displacement_map, texcoord + dFdx(texcoord)).x - height);
    float height_dy = scale * (texture(displacement_map, texcoord + dFdy(texcoord)).x - height);
    vec3 n = normalize(normal);
    vec3 across_x = cross(dy, n), across_y = cross(n, dx);
    float area = dot(dx, across_x);
    return abs(area) * n - sign(area) * (height_dx * across_x + height_dy * across_y);
}
#endif

#endif
