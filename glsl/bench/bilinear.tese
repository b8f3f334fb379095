// A floor for the bench: the least that an evaluation stage can do and still give a position and a normal.
// variants: TRIANGLE
#version 460
#extension GL_GOOGLE_include_directive : require
#define OWNED 1
#ifdef TRIANGLE
#define CORNERS 3
#else
#define CORNERS 4
#endif
#include "evaluate/evaluation.glsl"

void main() {
    vec3 at = parameter();
#ifdef TRIANGLE
    vec3 du = owned[0][0] - owned[2][0];
    vec3 dv = owned[1][0] - owned[2][0];
    vec3 position = at.x * owned[0][0] + at.y * owned[1][0] + at.z * owned[2][0];
#else
    vec3 low = mix(owned[0][0], owned[1][0], at.x);
    vec3 high = mix(owned[3][0], owned[2][0], at.x);
    vec3 du = mix(owned[1][0] - owned[0][0], owned[2][0] - owned[3][0], at.y);
    vec3 dv = high - low;
    vec3 position = mix(low, high, at.y);
#endif
    emit_sample(Sample(position, normalize(cross(du, dv))), at);
}
