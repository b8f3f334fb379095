// What all tessellation control shaders share: their outputs, factors and the record of texture coordinates.
// One invocation a corner of the patch, which writes the control points that the corner owns.
#ifndef CONTROL_GLSL
#define CONTROL_GLSL

#include "draw.glsl"
#ifdef CAPTURE_POINTS
#include "capture.glsl"
#endif

layout(location = 0) out vec3 corner[];
layout(location = 1) out vec3 edge_plus[];
layout(location = 2) out vec3 edge_minus[];
layout(location = 3) out vec3 face_plus[];
#ifndef REGULAR
layout(location = 4) out vec3 face_minus[];
#endif
#ifdef TEXCOORD
layout(set = 1, binding = 5, std430) readonly buffer Texcoords { vec2 texcoords[]; };
layout(location = 5) out vec2 texcoord[];
#endif
#ifdef CAPTURE
layout(location = 6) patch out uint captured_patch;
#endif

void set_factors() {
    if (gl_InvocationID == 0) {
        float outer = draw.normal_transform[0].w;
        float inner = draw.normal_transform[1].w;
        gl_TessLevelOuter[0] = outer;
        gl_TessLevelOuter[1] = outer;
        gl_TessLevelOuter[2] = outer;
        gl_TessLevelOuter[3] = outer;
        gl_TessLevelInner[0] = inner;
        gl_TessLevelInner[1] = inner;
    }
}

// `patch_number` counts within the draw.
void finish_corner(uint patch_number, uint corners) {
    set_factors();
#ifdef TEXCOORD
    texcoord[gl_InvocationID] = texcoords[draw.first_corner + patch_number * corners + uint(gl_InvocationID)];
#endif
#ifdef CAPTURE
    if (gl_InvocationID == 0) {
        captured_patch = draw.first_patch + patch_number;
    }
#endif
#ifdef CAPTURE_POINTS
    uint patch_index = draw.first_patch + patch_number;
    uint k = uint(gl_InvocationID);
#ifdef REGULAR
    const uint slots[16] = uint[](0, 4, 1, 5, 12, 13, 8, 9, 15, 11, 14, 10, 3, 2, 7, 6);
    capture_point(patch_index, slots[4u * k], corner[gl_InvocationID]);
    capture_point(patch_index, slots[4u * k + 1u], edge_plus[gl_InvocationID]);
    capture_point(patch_index, slots[4u * k + 2u], edge_minus[gl_InvocationID]);
    capture_point(patch_index, slots[4u * k + 3u], face_plus[gl_InvocationID]);
#else
    capture_point(patch_index, k, corner[gl_InvocationID]);
    capture_point(patch_index, corners + 2u * k, edge_plus[gl_InvocationID]);
    capture_point(patch_index, corners + 2u * k + 1u, edge_minus[gl_InvocationID]);
    capture_point(patch_index, 3u * corners + 2u * k, face_plus[gl_InvocationID]);
    capture_point(patch_index, 3u * corners + 2u * k + 1u, face_minus[gl_InvocationID]);
#endif
#endif
}

#endif
