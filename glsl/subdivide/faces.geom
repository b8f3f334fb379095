// A face of the control mesh (a quad), subdivided LEVEL times by Catmull and Clark's rules and drawn as strips. After Antal,
// Szécsi, Premecz, Csonka, Catmull-Clark subdivision for geometry shaders (2007): faces come in as points, and are refined
// level by level with a row of vertices around them.
//
// The face is a grid with corner 0 at (0, 0), corner 1 at (SIDE, 0), corner 2 at (SIDE, SIDE). The row around it is there
// beside each edge; beyond the corners it is only where the grid is regular, and not used: what the rules make of a corner
// and of the vertices next to it along edges comes from the fan around the corner.
//
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#ifndef LEVEL
#define LEVEL 0
#endif

// With constant indices the arrays need not be in memory: four times as fast on lavapipe. Captures would take long to compile.
#ifdef CAPTURE_GRID
#define UNROLL
#else
#define UNROLL [[unroll]]
#endif

#include "draw/draw.glsl"
#include "draw/instance_out.glsl"
#include "evaluate/patch.glsl"
#include "subdivide/subdivision.glsl"

const int SIDE = 1 << LEVEL;
// What is drawn of the grid. Every device has room for 1024 numbers; at level 3 four invocations draw the quarter at corner 0
// of a grid that each turns to another corner. (GLSL lets no constants of its own in here.)
#if LEVEL == 0
#define DRAWN 1
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
#elif LEVEL == 1
#define DRAWN 2
layout(points) in;
layout(triangle_strip, max_vertices = 12) out;
#elif LEVEL == 2
#define DRAWN 4
layout(points) in;
layout(triangle_strip, max_vertices = 40) out;
#else
#define DRAWN 4
layout(points, invocations = 4) in;
layout(triangle_strip, max_vertices = 40) out;
#endif

layout(location = 0) in uint in_patch_number[];

// Within the draw, or its instance.
uint patch_number;

// Without what else is in there, which would count.
out gl_PerVertex {
    invariant vec4 gl_Position;
};

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
#ifdef TEXCOORD
layout(location = 2) out vec2 out_texcoord;
#endif
#ifdef CAPTURE_GRID
#include "capture/capture.glsl"
#endif

const int STRIDE = SIDE + 3;
// The vertices of a level, and of the next.
vec3 coarse[STRIDE * STRIDE];
vec3 grid[STRIDE * STRIDE];

// The corner of the face that is corner k of the grid.
uint turned(int k) {
    return uint(k + gl_InvocationID) & 3u;
}

int at(ivec2 place) {
    return (place.y + 1) * STRIDE + place.x + 1;
}

// Corner k of a grid with sides of one, and the directions of its edges to the next corner and to the one before.
const ivec2 CORNER[4] = { ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 1) };
const ivec2 PLUS[4] = { ivec2(1, 0), ivec2(0, 1), ivec2(-1, 0), ivec2(0, -1) };
const ivec2 MINUS[4] = { ivec2(0, 1), ivec2(-1, 0), ivec2(0, -1), ivec2(1, 0) };

// What the fan around each corner makes of it.
vec3 tangents[4][2];
uint profiles[4];
uint creased[4];
#if LEVEL > 0
vec3 corner_points[4][LEVEL];
// Beyond the face's two edges: the neighbours along the edges there, at level 1.
vec3 ears[4][2];
#endif
#if LEVEL > 1
// The neighbours along the edge before the face's two, along those, and along the one after, at levels 2 and 3.
vec3 spokes[4][LEVEL - 1][4];
#endif

void gather(int k, Fan fan) {
    vec3 centre = vertex_position(fan.vertex);
    ivec2 place = CORNER[k];
    profiles[k] = fan_profile(fan, fan.face);
    creased[k] = table_words[profiles[k] + 11u];
    vec3 a_before = fan_neighbour(fan, fan.face - 1);
    vec3 a_after = fan_neighbour(fan, fan.face + 2);
    coarse[at(place)] = centre;
    coarse[at(place - MINUS[k])] = a_before;
    coarse[at(place - PLUS[k])] = a_after;
    coarse[at(place - MINUS[k] - PLUS[k])] = centre;
#if LEVEL > 0
    vec3 near[2] = { fan_diagonal(fan, fan.face - 1), fan_diagonal(fan, fan.face + 1) };
    vec3 far[2] = { fan_diagonal(fan, fan.face - 2), fan_diagonal(fan, fan.face + 2) };
    vec3 outer[2] = { a_before, a_after };
    vec3 inner[2] = { fan_neighbour(fan, fan.face), fan_neighbour(fan, fan.face + 1) };
    vec3 beyond[2] = { fan_neighbour(fan, fan.face - 2), fan_neighbour(fan, fan.face + 3) };
    UNROLL for (int i = 0; i < 2; ++i) {
        vec3 left = face_point(centre, outer[i], near[i], inner[i]);
        vec3 right = face_point(centre, outer[i], far[i], beyond[i]);
        float sharp = fan_weight(fan_profile(fan, i == 0 ? fan.face - 1 : fan.face + 2));
        ears[k][i] = sharpened(smooth_edge_point(centre, outer[i], left, right), sharp_edge_point(centre, outer[i]), sharp);
    }
    precise vec3 sums[LEVEL];
    UNROLL for (int level = 0; level < LEVEL; ++level) {
        sums[level] = vec3(0.0);
    }
#endif
#if LEVEL > 1
    precise vec3 spoke_sums[LEVEL - 1][4];
    uint rows[4];
    UNROLL for (int i = 0; i < 4; ++i) {
        int row = int(table_words[fan.type]) + int(table_words[fan.type + 1u]) * fan_edge(fan, fan.face - 1 + i);
        rows[i] = fan.type + uint(row);
        UNROLL for (int level = 0; level < LEVEL - 1; ++level) {
            spoke_sums[level][i] = vec3(0.0);
        }
    }
#endif
    uint of_tangents = fan.type + table_words[fan.type + 2u + 2u * LEVEL] + table_words[fan.type + 3u + 2u * LEVEL] * uint(fan.face);
    precise vec3 a = vec3(0.0), b = vec3(0.0);
    for (int i = 0; i < fan.faces + fan.edges; ++i) {
        precise vec3 x = vertex_position(table_words[fan.entries + 3u * uint(i / 2) + uint(i % 2)]) - centre;
        a += fan_weight(of_tangents + 2u * uint(i)) * x;
        b += fan_weight(of_tangents + 2u * uint(i) + 1u) * x;
#if LEVEL > 0
        UNROLL for (int level = 0; level < LEVEL; ++level) {
            sums[level] += fan_weight(fan.type + TYPE_HEAD + 3u * uint(i) + uint(level)) * x;
        }
#endif
#if LEVEL > 1
        UNROLL for (int level = 0; level < LEVEL - 1; ++level) {
            UNROLL for (int spoke = 0; spoke < 4; ++spoke) {
                spoke_sums[level][spoke] += fan_weight(rows[spoke] + 2u * uint(i) + uint(level)) * x;
            }
        }
#endif
    }
    tangents[k][0] = a;
    tangents[k][1] = b;
    // Added to the small sums at the end: what is added to the large one is rounded to it.
#if LEVEL > 0
    UNROLL for (int level = 0; level < LEVEL; ++level) {
        precise vec3 point = centre + sums[level];
        corner_points[k][level] = point;
    }
#endif
#if LEVEL > 1
    UNROLL for (int level = 0; level < LEVEL - 1; ++level) {
        UNROLL for (int spoke = 0; spoke < 4; ++spoke) {
            precise vec3 point = centre + spoke_sums[level][spoke];
            spokes[k][level][spoke] = point;
        }
    }
#endif
}

#if LEVEL > 0
// One step: `coarse`, with sides of n, becomes `grid`; in the last step as much of it as is drawn.
void refine(int level) {
    int n = 1 << level;
    int last = level + 1 < LEVEL ? n : DRAWN / 2;
    UNROLL for (int y = -1; y <= last; ++y) {
        UNROLL for (int x = -1; x <= last; ++x) {
            ivec2 p = ivec2(x, y);
            grid[at(2 * p + 1)] = face_point(coarse[at(p)], coarse[at(p + ivec2(1, 0))], coarse[at(p + 1)],
                                             coarse[at(p + ivec2(0, 1))]);
        }
    }
    UNROLL for (int y = 0; y <= last; ++y) {
        UNROLL for (int x = -1; x <= last; ++x) {
            ivec2 p = ivec2(x, y);
            grid[at(2 * p + ivec2(1, 0))] = smooth_edge_point(coarse[at(p)], coarse[at(p + ivec2(1, 0))],
                                                              grid[at(2 * p + ivec2(1, 1))],
                                                              grid[at(2 * p + ivec2(1, -1))]);
        }
    }
    UNROLL for (int y = -1; y <= last; ++y) {
        UNROLL for (int x = 0; x <= last; ++x) {
            ivec2 p = ivec2(x, y);
            grid[at(2 * p + ivec2(0, 1))] = smooth_edge_point(coarse[at(p)], coarse[at(p + ivec2(0, 1))],
                                                              grid[at(2 * p + ivec2(1, 1))],
                                                              grid[at(2 * p + ivec2(-1, 1))]);
        }
    }
    UNROLL for (int y = 0; y <= last; ++y) {
        UNROLL for (int x = 0; x <= last; ++x) {
            ivec2 p = ivec2(x, y);
            grid[at(2 * p)] = smooth_vertex_point(
                coarse[at(p)], coarse[at(p + ivec2(1, 0))], coarse[at(p + ivec2(0, 1))], coarse[at(p - ivec2(1, 0))],
                coarse[at(p - ivec2(0, 1))], grid[at(2 * p + ivec2(1, 1))], grid[at(2 * p + ivec2(-1, 1))],
                grid[at(2 * p + ivec2(-1, -1))], grid[at(2 * p + ivec2(1, -1))]);
        }
    }
    UNROLL for (int k = 0; k < 4; ++k) {
        // What is sharp along the edge, piece by piece and point by point.
        uint edges = profiles[k] + uint(n - 1);
        uint vertices = profiles[k] + 7u + uint(n / 2 - 1);
        UNROLL for (int i = 0; i < n; ++i) {
            ivec2 p = n * CORNER[k] + i * PLUS[k];
            vec3 here = coarse[at(p)], next = coarse[at(p + PLUS[k])];
            int edge = at(2 * p + PLUS[k]);
            grid[edge] = sharpened(grid[edge], sharp_edge_point(here, next), fan_weight(edges + uint(i)));
            if (i > 0) {
                vec3 crease = crease_vertex_point(here, coarse[at(p - PLUS[k])], next);
                grid[at(2 * p)] = sharpened(grid[at(2 * p)], crease, fan_weight(vertices + uint(i - 1)));
            }
        }
    }
    UNROLL for (int k = 0; k < 4; ++k) {
        ivec2 corner = 2 * n * CORNER[k];
        grid[at(corner)] = corner_points[k][level];
#if LEVEL > 1
        if (level > 0) {
            grid[at(corner - MINUS[k])] = spokes[k][level - 1][0];
            grid[at(corner + PLUS[k])] = spokes[k][level - 1][1];
            grid[at(corner + MINUS[k])] = spokes[k][level - 1][2];
            grid[at(corner - PLUS[k])] = spokes[k][level - 1][3];
            continue;
        }
#endif
        grid[at(corner - MINUS[k])] = ears[k][0];
        grid[at(corner - PLUS[k])] = ears[k][1];
    }
}
#endif

// The number of a point along edge k, or 0 where it is not on the edge, or a corner.
int along_edge(int k, ivec2 p) {
    ivec2 from = p - SIDE * CORNER[k];
    int i = from.x * PLUS[k].x + from.y * PLUS[k].y;
    return from.x * MINUS[k].x + from.y * MINUS[k].y == 0 && i < SIDE ? i : 0;
}

vec3 normal_at(ivec2 p, vec3 fallback) {
    UNROLL for (int k = 0; k < 4; ++k) {
        if (p == SIDE * CORNER[k]) {
            return unit_normal(tangents[k][0], tangents[k][1], fallback);
        }
    }
    vec3 around[9];
    UNROLL for (int i = 0; i < 9; ++i) {
        around[i] = grid[at(p + ivec2(i % 3 - 1, i / 3 - 1))];
    }
    UNROLL for (int k = 0; k < 4; ++k) {
        int i = along_edge(k, p);
        // Where the surface has a normal on each side of the edge, the row beyond is the mirrored one within.
        if (i > 0 && (creased[k] >> uint(SIDE - 2 - LEVEL + i) & 1u) != 0u) {
            UNROLL for (int side = -1; side <= 1; ++side) {
                ivec2 row = 1 + side * PLUS[k];
                ivec2 outside = row - MINUS[k], inside = row + MINUS[k];
                around[3 * outside.y + outside.x] = 2.0 * around[3 * row.y + row.x] - around[3 * inside.y + inside.x];
            }
        }
    }
    // The limit tangents of a regular vertex (Halstead et al. 1993), in pairs that are opposite.
    precise vec3 rising = around[8] - around[0], falling = around[2] - around[6];
    precise vec3 du = 4.0 * (around[5] - around[3]) + (rising + falling);
    precise vec3 dv = 4.0 * (around[7] - around[1]) + (rising - falling);
    return unit_normal(du, dv, fallback);
}

vec3 normals[(DRAWN + 1) * (DRAWN + 1)];

void emit(ivec2 p) {
    vec3 position = grid[at(p)];
    hand_on_instance();
    world_position = to_world(position);
    world_normal = normal_to_world(normals[p.y * (DRAWN + 1) + p.x]);
    gl_Position = to_clip(world_position);
#ifdef TEXCOORD
    uint corner = draw.first_corner + 4u * patch_number;
    vec2 uv[4] = { corner_texcoord(corner + turned(0)), corner_texcoord(corner + turned(1)),
                   corner_texcoord(corner + turned(2)), corner_texcoord(corner + turned(3)) };
    out_texcoord = INTERPOLATED(uv, (vec2(p) / float(SIDE)));
#endif
    EmitVertex();
}

void main() {
    patch_number = take_instance(in_patch_number[0]);
    uint first = draw.first_corner + 4u * patch_number;
    // No loop here and below: drivers do not unroll those around others, whose indices should be constants.
    gather(0, fan_at(first + turned(0)));
    gather(1, fan_at(first + turned(1)));
    gather(2, fan_at(first + turned(2)));
    gather(3, fan_at(first + turned(3)));
    precise vec3 ac = coarse[at(ivec2(1))] - coarse[at(ivec2(0))], bd = coarse[at(ivec2(0, 1))] - coarse[at(ivec2(1, 0))];
    vec3 fallback = cross(ac, bd);
#if LEVEL == 0
    grid = coarse;
#else
    refine(0);
#endif
#if LEVEL > 1
    coarse = grid;
    refine(1);
#endif
#if LEVEL > 2
    coarse = grid;
    refine(2);
#endif
    UNROLL for (int y = 0; y <= DRAWN; ++y) {
        UNROLL for (int x = 0; x <= DRAWN; ++x) {
            ivec2 p = ivec2(x, y);
            normals[y * (DRAWN + 1) + x] = normal_at(p, fallback);
#ifdef CAPTURE_GRID
            uint k = turned(0);
            ivec2 q = SIDE * CORNER[k] + x * PLUS[k] + y * MINUS[k];
            precise vec2 uv = vec2(q) / float(SIDE);
            capture_sample(draw.first_patch + patch_number, uint(q.y * (SIDE + 1) + q.x),
                           uint((SIDE + 1) * (SIDE + 1)), vec3(uv, 0.0), grid[at(p)],
                           normals[y * (DRAWN + 1) + x]);
#endif
        }
    }
    UNROLL for (int y = 0; y < DRAWN; ++y) {
        UNROLL for (int x = 0; x <= DRAWN; ++x) {
            // Counter-clockwise seen from outside.
            emit(ivec2(x, y + 1));
            emit(ivec2(x, y));
        }
        EndPrimitive();
    }
}
