// Where on which patch a fragment is: texture coordinates have a square tile for each patch, or for each face that is cut in wedges.
// To be included where TILE_WORD(i) is word i of the tiles. Rust twin: `Tiles` in src/cli/paint/tiles.rs.
#ifndef TILES_GLSL
#define TILES_GLSL

// The tile, from 0 on, plus where in it: from 0.25 to 0.75 in both directions.
layout(location = 2) centroid in vec2 place;

struct Painted {
    // The patch, among all.
    uint number;
    // (u, v) of a quad; of a triangle the second and the third barycentric coordinate.
    vec2 at;
    // How much of that a pixel has; of wedges how much of the roots.
    vec2 pixel;
};

// With so many tiles in a row.
Painted painted(uint columns) {
    vec2 inside = fract(place), pixel = max(fwidth(place), 1e-6);
    uvec2 tile = uvec2(place);
    uint word = 2u * (tile.y * columns + tile.x);
    uint first = TILE_WORD(word), corners = TILE_WORD(word + 1u);
    if (corners == 0u) {
        return Painted(first, 2.0 * inside - 0.5, 2.0 * pixel);
    }
    // A regular polygon around the middle.
    const float TURN = 6.28318531;
    vec2 at = 4.0 * (inside - 0.5);
    float step = TURN / float(corners), angle = atan(at.y, at.x);
    angle += angle < 0.0 ? TURN : 0.0;
    uint corner = min(uint(angle / step), corners - 1u);
    float turned = angle - float(corner) * step;
    vec2 ends = length(at) * vec2(sin(step - turned), sin(turned)) / sin(step);
    vec2 of_roots = 4.0 * pixel / vec2(sin(0.5 * step), cos(0.5 * step));
    return Painted(TILE_WORD(first + corner), vec2(ends.y, 1.0 - ends.x - ends.y), of_roots);
}

// A colour of a legend, with just enough light to see the shape: none is taken away where the surface faces the eye.
vec3 shaded(vec3 colour, vec3 position, vec3 normal, vec3 eye) {
    return colour * mix(0.35, 1.0, abs(dot(normalize(normal), normalize(eye - position))));
}

#endif
