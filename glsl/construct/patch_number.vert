// The stencil and the cached construction have nothing to do for a vertex: one invocation a patch, which says which patch it is. (Or
// which tile of all patches', for glsl/evaluate/strips.geom.)
#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw/draw.glsl"
#include "draw/visible.glsl"

layout(location = 0) out uint patch_number;

void main() {
    patch_number = patch_drawn(uint(gl_InstanceIndex) * draw.patches_per_instance + uint(gl_VertexIndex));
}
