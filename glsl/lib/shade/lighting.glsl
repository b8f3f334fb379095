// One light and the sky, for a surface that is seen from both sides.
#ifndef LIGHTING_GLSL
#define LIGHTING_GLSL

// Linear colour of a surface point. `normal` may point away from the eye.
vec3 lit(vec3 colour, vec3 position, vec3 normal, vec3 eye, vec3 light) {
    vec3 to_eye = normalize(eye - position);
    vec3 n = normalize(normal);
    // To the side that is seen. The plane of the triangle says which one that is: at a silhouette the normal of a surface
    // that faces the eye may itself face away, and turned round it would make dark specks.
    vec3 plane = cross(dFdx(position), dFdy(position));
    plane = dot(plane, to_eye) < 0.0 ? -plane : plane;
    n = dot(n, plane) < 0.0 ? -n : n;
    float sky = 0.5 + 0.5 * n.y;
    // The sun reaches a little beyond the terminator, as on clay: no hard edge between light and shade.
    float sun = max((dot(n, light) + 0.1) / 1.1, 0.0);
    float shine = pow(max(dot(n, normalize(light + to_eye)), 0.0), 32.0);
    float rim = pow(1.0 - max(dot(n, to_eye), 0.0), 4.0);
    vec3 diffuse = mix(vec3(0.115, 0.10, 0.095), vec3(0.24, 0.265, 0.305), sky) + vec3(0.80, 0.76, 0.70) * sun;
    return colour * diffuse + vec3(0.07 * shine + 0.05 * rim);
}

#endif
