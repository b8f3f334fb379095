// The geometry shader evaluates: a point is a tile of a patch's uniform grid, which comes out as strips of triangles, as the indices
// of src/table/uniform_grid.rs have them. In one pass it makes the control points, too, with the weights of the stencil table; with
// the cached construction they are there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "constants.glsl"
#include "evaluate/uniform_grid.glsl"
#include "draw/draw.glsl"
#include "draw/instance_out.glsl"
#include "draw/construction.glsl"
#include "construct/read_cached.glsl"
#include "construct/stencils.glsl"
#ifdef DISPLACED
#include "displace/displaced.glsl"
#endif
#ifdef CAPTURE
#include "capture/capture.glsl"
#endif

// Every Vulkan device lets an invocation write 1024 components: 16 a vertex, however they are counted. Rust twins:
// src/table/uniform_grid.rs.

layout(points) in;
layout(triangle_strip, max_vertices = TILE_VERTICES) out;

layout(location = 0) in uint tile_number[];  // among those of all patches of the draw

out gl_PerVertex {
    invariant vec4 gl_Position;
};
layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
#ifdef TEXCOORD
layout(location = 2) out vec2 out_texcoord;
#endif

// Columns and rows of a tile of cells. A row of c cells takes up to 2 c + 6 vertices. Rust twin: `tile_size`.
uvec2 tile_size(uint n) {
    const uint most = (TILE_VERTICES - 6u) / 2u;
    uint across = (n + most - 1u) / most;
    uint columns = (n + across - 1u) / across;
    return uvec2(columns, min(TILE_VERTICES / (2u * columns + 6u), n));
}

// Rust twin: `rises`.
bool rises(uint n, uint column, uint row) {
#ifdef TRIANGLE
    return true;
#else
    uint x = 2u * column + 1u, y = 2u * row + 1u;
    return y != n && (x == n || (x < n) == (y < n));
#endif
}

// The patch whose tile this is, and the segments along its sides.
uint patch_number;
uint segments;

void emit(uint row, uint place) {
    uint first_corner = draw.first_corner + patch_number * CORNERS;
    vec3 at = uniform_grid_parameter(row, place, segments, first_corner);
    UniformGridSample surface = uniform_grid_sample(at);
#ifdef DISPLACED
    surface.position = displace(surface.position, surface.direction, surface.texcoord, surface.lod);
#endif
#ifdef CAPTURE
    capture_sample(draw.first_patch + patch_number, 0u, 0u, at, surface.position, surface.normal);
#endif
#ifdef TEXCOORD
    out_texcoord = INTERPOLATED(texcoord, at);
#endif
    hand_on_instance();
    world_position = to_world(surface.position);
    world_normal = normal_to_world(surface.normal);
    gl_Position = to_clip(world_position);
    EmitVertex();
}

// The cells of a row from column `first` on, up to column `end`.
void emit_row(uint row, uint first, uint end) {
    bool rising;
    for (uint column = first; column < end; ++column) {
        bool rose = rising;
        rising = rises(segments, column, row);
        // A strip goes to and fro between two rows of vertices.
        uint from = row + uint(rising), to = row + uint(!rising);
        if (column == first || rising != rose) {
            EndPrimitive();
#ifdef TRIANGLE
            const bool turned = true;
#else
            bool turned = !rising;
#endif
            emit(from, column);
            if (turned) {
                // The strip would wind the other way, so its first triangle goes before it.
                emit(from, column + 1u);
                emit(to, column);
                EndPrimitive();
            }
            emit(to, column);
        }
        emit(from, column + 1u);
#ifdef TRIANGLE
        // The last cell of a row is one triangle.
        if (column == row) {
            break;
        }
#endif
        emit(to, column + 1u);
    }
    EndPrimitive();
}

// The control points of the patch, by stencils; what corners share is kept by the cached construction alone.
void sum_points() {
#ifdef MAY_BE_ADAPTIVE
    evaluated_patch = draw.first_patch + patch_number;
#endif
    for (uint k = 0u; k < CORNERS; ++k) {
        stencil_points(draw.first_patch + patch_number, k, CORNERS, owned[k]);
#ifdef TEXCOORD
        texcoord[k] = corner_texcoord(draw.first_corner + patch_number * CORNERS + k);
#endif
    }
}

void main() {
    segments = item.segments;
    uvec2 size = tile_size(segments);
    uvec2 tiles = (segments + size - 1u) / size;
    uint tile_of_all = take_instance(tile_number[0]);
    patch_number = tile_of_all / (tiles.x * tiles.y);
    uint tile = tile_of_all % (tiles.x * tiles.y);
    uvec2 first = size * uvec2(tile % tiles.x, tile / tiles.x);
    uvec2 end = min(first + size, uvec2(segments));
#ifdef TRIANGLE
    // Row r has r + 1 columns.
    if (first.x >= end.y) {
        return;
    }
#endif
    if (IS_CACHED) {
        read_cached(draw.first_patch + patch_number, draw.first_corner + patch_number * CORNERS, segments);
    } else {
        sum_points();
    }
    for (uint row = first.y; row < end.y; ++row) {
#ifdef TRIANGLE
        emit_row(row, first.x, min(end.x, row + 1u));
#else
        emit_row(row, first.x, end.x);
#endif
    }
}
