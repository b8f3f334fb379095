// ACC as published (Loop and Schaefer 2008), for the bench: of each corner is kept what the tangents are made of, b at the corner,
// along its plus and minus edge and inside, then t+, t- and the ring's cosine. Otherwise as glsl/compute/control_points.comp, in
// whose place it runs.
#version 460
#extension GL_GOOGLE_include_directive : require
#define KEPT_FRAMES true
#define MAKES_POINTS
#include "construct/cached.glsl"
#include "construct/corner.glsl"
#include "draw/invocation.glsl"

const uint CORNERS = 4u;

void main() {
    uint index = invocation_number();
    if (index >= invocations.count) {
        return;
    }
    for (uint k = 0u; k < CORNERS; ++k) {
        uint number = invocations.first + index * CORNERS + k;
        Corner corner = corner_of_patch(number);
        keep_vector(number, 0u, corner.limit.xyz);
        keep_vector(number, 1u, corner.inner[3]);
        keep_vector(number, 2u, corner.inner[4]);
        keep_vector(number, 3u, corner.inner[0]);
        keep_vector(number, 4u, 3.0 * corner.plus);
        keep_vector(number, 5u, 3.0 * corner.minus);
        keep_number(number, 18u, corner.limit.w);
    }
}
