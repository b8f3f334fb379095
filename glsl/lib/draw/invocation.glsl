// Which of many things an invocation of a compute shader is about.
#ifndef INVOCATION_GLSL
#define INVOCATION_GLSL

#include "constants.glsl"

layout(local_size_x = GROUP_INVOCATIONS) in;

#ifndef OWN_INVOCATIONS
// Rust twin: `Invocations` in src/renderer/construct/cached.rs.
layout(push_constant, std430) uniform Invocations {
    uint count;
    uint first;         // of the corners of the patches, or of the rows
    uint first_vertex;  // that the first of all rows makes
    uint first_block;   // that of the first row
    uint rows_of_block;
} invocations;
#endif

// Those from `count` on have nothing to do; groups are laid out in rows, as there are no more than 65 535 along an axis.
uint invocation_number() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}

#endif
