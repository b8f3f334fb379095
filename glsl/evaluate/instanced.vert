// Instanced tessellation (the Direct3D 10 path of Loop et al. 2009): one uniform grid for all patches, an instance for each. A
// vertex of it is evaluated from the control points of the instance's patch.
// With ATTRIBUTES the control points come as vertex attributes that every instance has anew.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "evaluate/uniform_grid.glsl"
#include "construct/read_cached.glsl"
#include "draw/draw.glsl"
#include "draw/instance_out.glsl"
#include "draw/visible.glsl"
#ifdef DISPLACED
#include "displace/displaced.glsl"
#endif
#ifdef CAPTURE
#include "capture/capture.glsl"
#endif

// The same bits in every pipeline: a pass for depth alone, and one that tests against it.
invariant gl_Position;
layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
#ifdef TEXCOORD
layout(location = 2) out vec2 out_texcoord;
#endif

void main() {
    uint patch_number = take_instance(patch_drawn(uint(gl_InstanceIndex)));
    hand_on_instance();
    uint first_corner = draw.first_corner + patch_number * CORNERS;
    uint segments = item.segments;
    read_cached(draw.first_patch + patch_number, first_corner, segments);
    vec3 at = uniform_grid_parameter(uint(gl_VertexIndex), segments, first_corner);
    UniformGridSample surface = uniform_grid_sample(at);
#ifdef DISPLACED
    surface.position = displace(surface.position, surface.direction, surface.texcoord, surface.lod);
#endif
#ifdef CAPTURE
    capture_sample(draw.first_patch + patch_number, 0u, 0u, at, surface.position, surface.normal);
#endif
#ifdef TEXCOORD
    out_texcoord = INTERPOLATED(texcoord, at);
#endif
    world_position = to_world(surface.position);
    world_normal = normal_to_world(surface.normal);
    gl_Position = to_clip(world_position);
}
