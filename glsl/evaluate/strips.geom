// The geometry shader evaluates: a point is a tile of a patch's lattice, which comes out as strips of triangles, as the indices
// of src/table/lattice.rs have them. In one pass it makes the control points, too, with the weights of the stencil table; with
// CACHED they are there.
// variants: BICUBIC, GREGORY_QUAD, GREGORY_TRIANGLE, ACC, PM_QUAD, PM_TRIANGLE, PM_PENTAGON
// variants: BICUBIC+TEXCOORD, GREGORY_QUAD+TEXCOORD, GREGORY_TRIANGLE+TEXCOORD, ACC+TEXCOORD
// variants: PM_QUAD+TEXCOORD, PM_TRIANGLE+TEXCOORD, PM_PENTAGON+TEXCOORD
// variants: BICUBIC+CAPTURE, GREGORY_QUAD+CAPTURE, GREGORY_TRIANGLE+CAPTURE, ACC+CAPTURE
// variants: PM_QUAD+CAPTURE, PM_TRIANGLE+CAPTURE, PM_PENTAGON+CAPTURE
// variants: BICUBIC+CACHED, GREGORY_QUAD+CACHED, GREGORY_TRIANGLE+CACHED, ACC+CACHED
// variants: PM_QUAD+CACHED, PM_TRIANGLE+CACHED, PM_PENTAGON+CACHED
// variants: BICUBIC+CACHED+TEXCOORD, GREGORY_QUAD+CACHED+TEXCOORD, GREGORY_TRIANGLE+CACHED+TEXCOORD, ACC+CACHED+TEXCOORD
// variants: PM_QUAD+CACHED+TEXCOORD, PM_TRIANGLE+CACHED+TEXCOORD, PM_PENTAGON+CACHED+TEXCOORD
// variants: BICUBIC+CACHED+CAPTURE, GREGORY_QUAD+CACHED+CAPTURE, GREGORY_TRIANGLE+CACHED+CAPTURE, ACC+CACHED+CAPTURE
// variants: PM_QUAD+CACHED+CAPTURE, PM_TRIANGLE+CACHED+CAPTURE, PM_PENTAGON+CACHED+CAPTURE
// variants: BICUBIC+CACHED+SHARED, GREGORY_QUAD+CACHED+SHARED, GREGORY_TRIANGLE+CACHED+SHARED
// variants: BICUBIC+CACHED+SHARED+TEXCOORD, GREGORY_QUAD+CACHED+SHARED+TEXCOORD, GREGORY_TRIANGLE+CACHED+SHARED+TEXCOORD
// variants: BICUBIC+CACHED+DISPLACED, GREGORY_QUAD+CACHED+DISPLACED, GREGORY_TRIANGLE+CACHED+DISPLACED
// variants: BICUBIC+CACHED+SHARED+CAPTURE, GREGORY_QUAD+CACHED+SHARED+CAPTURE, GREGORY_TRIANGLE+CACHED+SHARED+CAPTURE
// variants: BICUBIC+CACHED+DISPLACED+CAPTURE, GREGORY_QUAD+CACHED+DISPLACED+CAPTURE, GREGORY_TRIANGLE+CACHED+DISPLACED+CAPTURE
#version 460
#extension GL_GOOGLE_include_directive : require
#include "evaluate/lattice.glsl"
#include "draw/draw.glsl"
#ifdef CACHED
#include "construct/read_cached.glsl"
#else
#include "construct/stencils.glsl"
#endif
#ifdef DISPLACED
#include "displace/displaced.glsl"
#endif
#ifdef CAPTURE
#include "capture/capture.glsl"
#endif

// Every Vulkan device lets an invocation write 1024 components: 16 a vertex, however they are counted.
// Rust twins: src/table/lattice.rs.
const uint TILE_VERTICES = 64u;

layout(points) in;
layout(triangle_strip, max_vertices = 64) out;

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
    vec3 at = lattice_parameter(row, place, segments, first_corner);
    LatticeSample surface = lattice_sample(at);
#ifdef DISPLACED
    surface.position = displace(surface.position, surface.direction, surface.texcoord, surface.lod);
#endif
#ifdef CAPTURE
    capture_sample(draw.first_patch + patch_number, 0u, 0u, at, surface.position, surface.normal);
#endif
#ifdef TEXCOORD
    out_texcoord = INTERPOLATED(texcoord, at);
#endif
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

void main() {
    segments = uint(draw_factor());
    uvec2 size = tile_size(segments);
    uvec2 tiles = (segments + size - 1u) / size;
    patch_number = tile_number[0] / (tiles.x * tiles.y);
    uint tile = tile_number[0] % (tiles.x * tiles.y);
    uvec2 first = size * uvec2(tile % tiles.x, tile / tiles.x);
    uvec2 end = min(first + size, uvec2(segments));
#ifdef TRIANGLE
    // Row r has r + 1 columns.
    if (first.x >= end.y) {
        return;
    }
#endif
#ifdef CACHED
    read_cached(draw.first_corner + patch_number * CORNERS, segments);
#else
    for (uint k = 0u; k < CORNERS; ++k) {
        stencil_points(draw.first_patch + patch_number, k, CORNERS, owned[k]);
#ifdef TEXCOORD
        texcoord[k] = texcoords[draw.first_corner + patch_number * CORNERS + k];
#endif
    }
#endif
    for (uint row = first.y; row < end.y; ++row) {
#ifdef TRIANGLE
        emit_row(row, first.x, min(end.x, row + 1u));
#else
        emit_row(row, first.x, end.x);
#endif
    }
}
