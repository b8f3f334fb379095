// One light and the sky, for a surface that is seen from both sides.
#ifndef LIGHTING_GLSL
#define LIGHTING_GLSL

// Linear colour of a surface point. `normal` may point away from the eye.
vec3 lit(vec3 colour, vec3 position, vec3 normal, vec3 eye, vec3 light) {
    vec3 to_eye = normalize(eye - position);
    vec3 n = normalize(normal);
    n = dot(n, to_eye) < 0.0 ? -n : n;
    float sky = 0.5 + 0.5 * n.y;
    float sun = max(dot(n, light), 0.0);
    float shine = pow(max(dot(n, normalize(light + to_eye)), 0.0), 48.0);
    float rim = pow(1.0 - max(dot(n, to_eye), 0.0), 3.0);
    return colour * (mix(0.10, 0.28, sky) + 0.75 * sun) + vec3(0.16 * shine + 0.06 * rim);
}

#endif
