// Where on which patch a fragment is: texture coordinates have a square tile for each patch. Rust twin: `Tiles` in
// src/cli/paint/tiles.rs.
#ifndef TILES_GLSL
#define TILES_GLSL

// The tile of the patch, from 0 on, plus where on the patch: from 0.25 to 0.75 in both directions.
layout(location = 2) centroid in vec2 place;

// The patch, with so many tiles in a row.
uint painted_patch(uint columns) {
    uvec2 tile = uvec2(place);
    return tile.y * columns + tile.x;
}

// (u, v) of a quad; of a triangle the second and the third barycentric coordinate.
vec2 painted_at() {
    return 2.0 * fract(place) - 0.5;
}

// A colour of a legend, with just enough light to see the shape: none is taken away where the surface faces the eye.
vec3 shaded(vec3 colour, vec3 position, vec3 normal, vec3 eye) {
    return colour * mix(0.35, 1.0, abs(dot(normalize(normal), normalize(eye - position))));
}

#endif
