// The cached construction, once a frame: the control points that each corner of each patch owns. One invocation for each
// corner.
// variants: OWNED=4, OWNED=5, OWNED=6, OWNED=8
#version 460
#extension GL_GOOGLE_include_directive : require
#include "control_points.glsl"

layout(local_size_x = 64) in;

void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint i = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (i < patches.invocations) {
        make_control_points(i);
    }
}
